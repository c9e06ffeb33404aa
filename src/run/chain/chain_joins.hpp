#pragma once
// Joins of consecutive segments: the rotation of the next segment, and the offsets by which both segments meet in one
// state. Joins are rare, so lanes of several blocks are computed in parallel.
//
// At a join, attitude, attitude rate and velocity are the means of one segment's end and the next one's beginning. Each
// segment takes half of the difference (the gap) as an offset that fades: along a smooth curve for each number of the
// quaternion (world axes, normalised for display), linearly for velocity. Segments of less than 2 · blend_steps fade
// over their whole length, longer ones over blend_steps at each end. To fade half of the difference over a whole
// segment takes an eighth of the curvature of fading all of it over half a segment (a one-sided fade: D. Bollo,
// Inertialization, GDC 2018); recorded motion has little curvature. A segment fades towards its successor, so the
// successor is drawn when the segment begins.
//
// The curve of each number is two parabolas, stored as differences from row to row: a step takes two additions.

#include <algorithm>
#include <array>
#include <cstdint>

#include "run/chain/chain_lane.hpp"
#include "run/lanes/columns.hpp"

namespace wisp {

/// Lanes, from several blocks, that join or begin to fade in this step: at most kMax, computed in parallel.
template <class N>
struct ChainParty {
  static constexpr int kMax = N::kLanes;

  std::size_t count = 0;
  std::array<int, N::kLanes> block{};
  std::array<int, N::kLanes> lane{};

  static ChainParty of(int block, int lane) {
    ChainParty party;
    party.add(block, lane);
    return party;
  }

  bool is_full() const { return count == kMax; }

  /// Precondition: !is_full().
  void add(int of_block, int of_lane) {
    block[count] = of_block;
    lane[count] = of_lane;
    ++count;
  }
};

template <class N>
class ChainJoins {
 public:
  using Real = typename N::Real;
  using Values = Reals<N>;
  static constexpr int kLanes = N::kLanes;
  using Segments = std::array<std::uint32_t, kLanes>;

  explicit ChainJoins(const ChainProgram& program) : program_(program) {}

  /// Returns the rotations of segments `next` after segments `before` of rotations `turn`, and the gaps at the joins.
  ChainAhead<Values> ahead(const ChainTurn<Values>& turn, const Segments& before, const Segments& next) const {
    const Edge end = edge_of(before, true), start = edge_of(next, false);
    const ChainTurn<Values> next_turn = turn_after(turn, end, start);
    if (program_.blend_steps == 0) return {next_turn, {}};
    const auto slip = taken(turned_velocity(turn, end.velocity), turned_velocity(next_turn, start.velocity));
    const float half_step = 0.5f * program_.step_seconds * program_.velocity_scale;
    const auto over_ground = number(half_step / program_.position_scale);
    const auto slipped =
        bounded(Vector3<Values>{over_ground * slip[0], over_ground * slip[1], number(half_step) * slip[2]});
    if (program_.channels < 7) return {next_turn, {{}, {}, slipped}};
    const auto ended = oriented(turn, end.attitude), started = oriented(next_turn, start.attitude);
    return {next_turn,
            {bounded(scaled(taken(ended, started), number(0.5f))),
             bounded(taken(oriented(turn, end.change), oriented(next_turn, start.change))), slipped}};
  }

  /// Offset curves of segments; members as in ChainPlayed.
  struct Curves {
    std::array<Quaternion<Values>, 4> lean;
    std::array<Vector3<Values>, 2> slip;
  };

  /// Computes the offset curves at the beginning of segments, from the gap `from` to the previous segments down to 0,
  /// or in segments of less than 2 · blend_steps to minus `to`, the gap to the next. `height`: z of the bases, metres.
  Curves meeting(const Segments& segments, const Values& height, const ChainGap<Values>& from,
                 const ChainGap<Values>& to) const {
    Segments over{}, led{};
    Real is_short[kLanes] = {};
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const std::uint32_t steps = program_.steps(segments[lane]), blend = program_.blend_steps;
      is_short[lane] = Real(steps < 2 * blend ? 1.0f : 0.0f);
      over[lane] = steps < 2 * blend ? steps : blend;
      led[lane] = std::min(steps, 2 * blend);
    }
    const auto mask = load<Values>(is_short), none = number(0.0f);
    ChainGap<Values> met;
    each_number(met, to, [&](Values& out, const Values& gap) { out = chosen(mask, gap, none); });
    Curves curves = spread(over, from, met);
    lead_back(segments, height, led, curves);
    return curves;
  }

  /// Computes the offset curves at the end of longer segments, from 0 to minus the gap `to`.
  Curves leaving(const Segments& segments, const Values& height, const ChainGap<Values>& to) const {
    Segments over;
    over.fill(program_.blend_steps);
    ChainGap<Values> none;
    each_number(none, to, [&](Values& out, const Values&) { out = number(0.0f); });
    Curves curves = spread(over, none, to);
    lead_back(segments, height, over, curves);
    return curves;
  }

 private:
  // Stored states at the beginnings or the ends of segments, in stored units.
  struct Edge {
    Quaternion<Values> attitude;
    Quaternion<Values> change;
    Vector3<Values> velocity;
  };

  // Cosine and sine of half an angle about z, both times a common factor.
  using Turn = LongTurn<Values>;

  static Values number(float value) { return all<Values>(value); }

  static Values above(const Values& x, const Values& bound, const Values& yes, const Values& no) {
    return each([](const auto& a, const auto& b, const auto& y, const auto& n) { return a > b ? y : n; }, x, bound, yes,
                no);
  }

  template <class Numbers>
  static Numbers bounded(Numbers numbers) {
    for (Values& x : numbers) x = hold(x, number(-kMaxDifference), number(kMaxDifference));
    return numbers;
  }

  Edge edge_of(const Segments& segments, bool end) const {
    const std::int16_t *row[kLanes], *rate[kLanes];
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const std::size_t at = program_.first_row[segments[lane]] + (end ? program_.steps(segments[lane]) : 0);
      row[lane] = program_.rows.data() + at * static_cast<std::size_t>(program_.channels);
      rate[lane] =
          program_.rates.data() + edge_number(segments[lane], end) * static_cast<std::size_t>(program_.rate_count);
    }
    Values rates[kRowReach];
    columns_of<N>(rate, rates);
    if (program_.channels < 7) return {{}, {}, {rates[0], rates[1], rates[2]}};
    const float* change[kLanes];
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      change[lane] = program_.changes.data() + 4 * edge_number(segments[lane], end);
    }
    Values attitude[kRowReach], changes[4];
    columns_of<N>(row, attitude);
    columns_of<N>(change, 0, changes);
    return {{attitude[3], attitude[4], attitude[5], attitude[6]},
            {changes[0], changes[1], changes[2], changes[3]},
            {rates[0], rates[1], rates[2]}};
  }

  static std::size_t edge_number(std::uint32_t segment, bool end) { return std::size_t{2} * segment + (end ? 1 : 0); }

  // Returns the rotation of a successor. If heading is not free, the rotation changes by 0, or by 360° where a
  // quaternion's sign demands it.
  ChainTurn<Values> turn_after(const ChainTurn<Values>& turn, const Edge& end, const Edge& start) const {
    const Turn more = turn_between_edges(start, end);
    const auto cos = turn.half_cos * more.cos - turn.half_sin * more.sin;
    const auto sin = turn.half_cos * more.sin + turn.half_sin * more.cos;
    const auto square = cos * cos + sin * sin;
    const auto inverse = number(1.0f) / square_root(square);
    ChainTurn<Values> out = turn_of(cos * inverse, sin * inverse, program_, number);
    const auto least = number(1e-12f);  // below it, only in a manipulated saved bank, the rotation stays
    each_number(out, turn, [&](Values& x, const Values& as_before) { x = above(square, least, x, as_before); });
    return out;
  }

  // Returns cosine and sine of half the angle about z that aligns `start` with `end`, both times a common factor.
  Turn turn_between_edges(const Edge& start, const Edge& end) const {
    const auto zero = number(0.0f), one = number(1.0f);
    if (program_.channels < 7) {
      if (!program_.heading_free) return {one, zero};
      return turn_between_velocities(start.velocity, end.velocity);
    }
    if (!program_.heading_free) return {above(zero, dot(start.attitude, end.attitude), number(-1.0f), one), zero};
    const Turn turn = long_turn_between(start.attitude, end.attitude);
    const auto least = number(kMinTurn);
    const auto is_long = above(magnitude(turn.cos), least, one, above(magnitude(turn.sin), least, one, zero));
    return {chosen(is_long, turn.cos, one), chosen(is_long, turn.sin, zero)};
  }

  // Returns the rotation between horizontal velocities, as turn_between() in rigid.hpp does: of cosine and sine of half
  // the angle, the larger is computed first, for accuracy.
  static Turn turn_between_velocities(const Vector3<Values>& from, const Vector3<Values>& to) {
    const auto zero = number(0.0f), half = number(0.5f);
    const auto along = to[0] * from[0] + to[1] * from[1];
    const auto across = to[1] * from[0] - to[0] * from[1];
    const auto size = square_root(along * along + across * across);
    const auto cos = along / size, sin = across / size;
    const auto larger = square_root(half + half * magnitude(cos)), other = half * sin / larger;
    const auto least = number(1e-12f);
    return {above(size, least, above(cos, zero, larger, other), number(1.0f)),
            above(size, least, above(cos, zero, other, larger), zero)};
  }

  // Converts stored quaternions, or changes of them, to world axes.
  static Quaternion<Values> oriented(const ChainTurn<Values>& turn, const Quaternion<Values>& stored) {
    return turned<Values>(turn.half_cos_scale, turn.half_sin_scale, stored);
  }

  // Rotates a stored velocity to world axes. Multiplies x and y by the scale of positions, but not z.
  static Vector3<Values> turned_velocity(const ChainTurn<Values>& turn, const Vector3<Values>& stored) {
    return turned<Values>(turn.cos_scale, turn.sin_scale, stored);
  }

  // Returns offset curves of `steps` steps, from the gap `from` to minus the gap `to`.
  Curves spread(const Segments& steps, const ChainGap<Values>& from, const ChainGap<Values>& to) const {
    Real slope[kLanes], count[kLanes];
    const float* row[kLanes];
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const ChainSpread& spread = program_.spread[steps[lane]];
      row[lane] = spread.way.data();
      slope[lane] = Real(spread.slope);
      count[lane] = Real(static_cast<float>(steps[lane]));
    }
    Curves out;
    out.slip[1] = scaled(added(to.slip, from.slip), load<Values>(slope));
    out.slip[0] = from.slip;
    if (program_.channels < 7) return {{}, out.slip};  // zeros, since save() writes lean for positions too
    Values shares[4];
    columns_of<N>(row, 0, shares);
    for (std::size_t k = 0; k < 4; ++k) {
      const auto way = to.lean[k] + from.lean[k] + load<Values>(count) * from.lean_rate[k];
      const auto change = to.lean_rate[k] + from.lean_rate[k];
      out.lean[2][k] = shares[0] * way + shares[2] * change;
      out.lean[3][k] = shares[1] * way + shares[3] * change;
      out.lean[1][k] = from.lean_rate[k] + number(0.5f) * out.lean[2][k];
    }
    out.lean[0] = from.lean;
    return out;
  }

  // Adds to each step 1/`steps` of the difference from the segment's recorded height, clamped to ±max_return. Without
  // this return, the velocity offsets of joins would add up to an unbounded random walk of the height.
  void lead_back(const Segments& segments, const Values& height, const Segments& steps, Curves& curves) const {
    if (program_.height.empty()) return;
    Real recorded[kLanes], share[kLanes];
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      recorded[lane] = Real(static_cast<float>(program_.height[segments[lane]]));
      share[lane] = Real(1.0f / static_cast<float>(steps[lane]));
    }
    const auto below = number(program_.height_scale) * load<Values>(recorded) - height;
    const auto way = hold(below * load<Values>(share), number(-program_.max_return), number(program_.max_return));
    curves.slip[0][2] = curves.slip[0][2] + way;
  }

  const ChainProgram& program_;
};

}  // namespace wisp
