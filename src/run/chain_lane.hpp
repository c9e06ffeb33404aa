#pragma once
// One instance of a segment chain: where it is in which segment, where that segment lies, and what is left of the last
// join. All arithmetic of a frame is here, on one number of any kind.
//
// Joins by inertialization: the difference between what was shown and what the new segment shows, and of their rates,
// is held at the join and fades along a cubic. D. Bollo, Inertialization: high-performance animation transitions in
// Gears of War, GDC 2018, has the idea (with a quintic; half a segment of a leaf is four frames, too short for one).

#include "run/chain_choice.hpp"
#include "run/chain_program.hpp"
#include "run/chain_settings.hpp"
#include "run/rigid.hpp"

namespace wisp {

/// How fast a body moves and turns, in the world.
template <class Real>
struct BodyRates {
  Vector3<Real> velocity{};  ///< a second
  Vector3<Real> spin{};      ///< radians a second
};

/// A body at one moment, in the world.
template <class Real>
struct BodyState {
  Vector3<Real> position{};
  Quaternion<Real> orientation{};
  BodyRates<Real> rates{};
};

template <class Real>
struct ChainLane {
  // Where it is in the chain; whole numbers.
  Real segment{};
  Real row{};
  Real state{};
  // Where the segment lies: base + turn(scale · row).
  Vector3<Real> base{};
  Real half_cos{1.0f};
  Real half_sin{};
  // The same turn times the scales of what it turns.
  Real cos_scale{};
  Real sin_scale{};
  Real half_cos_scale{};
  Real half_sin_scale{};
  // The join: how much of it has passed, in [0, 1]; 1: all of it.
  Real passed{1.0f};
  Real share{};  ///< passes in a step
  Vector3<Real> slip{};
  Vector3<Real> lean{};
  Vector3<Real> lean_slip{};
  // The ground: how much of coming to rest has passed, in [0, 1]; below 0: it falls. The pose in which it touched.
  Real settled{-1.0f};
  Quaternion<Real> touched{};
  // Steering: steps left until it should be there, 0: it is not steered; where; and how near, metres.
  Real left{};
  Vector3<Real> target{};
  Real near{};
};

/// What moves lanes of one program.
template <class Real>
class ChainMover {
 public:
  using Lane = ChainLane<Real>;
  using Body = BodyState<Real>;
  using Rates = BodyRates<Real>;

  explicit ChainMover(const ChainProgram& program) : program_(program) {}

  /// Draws the segment that begins, or that follows the lane's, and moves its history on.
  std::uint32_t draw(Lane& lane, const ChainChoice& choice, const ChainWords& words, bool begins) const {
    const std::uint32_t state = begins ? 0 : index(lane.state, program_.states());
    const std::uint32_t before = index(lane.segment, program_.segments());
    const std::uint32_t mode =
        begins ? choice.mode(program_, state, words) : choice.mode_after(program_, state, before, words);
    lane.state = Real(static_cast<float>(program_.next[state * static_cast<std::uint32_t>(program_.modes) + mode]));
    return begins ? choice.beginning(program_, mode, words) : choice.follower(program_, before, mode, words);
  }

  /// Whether joining a segment leaves something to fade: what must be known of the rates then.
  bool fades(std::uint32_t segment) const { return fading_steps(segment) > 1.0f; }

  /// Places the beginning of a segment where a body is: its position, its heading where the chain is free of it; what
  /// else differs fades. The body's rates are only looked at where fades(segment) says so, or no orientation tells the
  /// heading.
  void join(Lane& lane, std::uint32_t segment, const Body& body) const {
    const HalfTurn<Real> turn = turn_to(segment, body);
    place(lane, segment, body.position, turn.cos, turn.sin);
    const float length = fading_steps(segment);
    if (!(length > 1.0f)) return;
    const Rates start = rates_of(lane, segment, false);
    const Real seconds = Real(length * program_.step_seconds);
    lane.passed = Real(0.0f);
    lane.share = Real(1.0f / length);
    lane.slip = scaled(taken(body.rates.velocity, start.velocity), seconds);
    if (program_.channels < 7) return;
    lane.lean = gibbs_between(oriented(lane, row_of(segment, 0)), body.orientation);
    const auto spin = taken(body.rates.spin, rotated(lane.lean, start.spin));
    lane.lean_slip = scaled(gibbs_rate(lane.lean, spin), seconds);
  }

  /// Places the beginning of a segment as it is, turned by a half turn.
  void place(Lane& lane, std::uint32_t segment, const Vector3<Real>& position, Real half_cos, Real half_sin) const {
    lane.segment = Real(static_cast<float>(segment));
    lane.row = Real(0.0f);
    lane.base = position;
    lane.half_cos = half_cos;
    lane.half_sin = half_sin;
    const Real scale(program_.position_scale), quaternion_scale(program_.orientation_scale);
    const Real product = half_cos * half_sin;
    lane.cos_scale = (half_cos * half_cos - half_sin * half_sin) * scale;
    lane.sin_scale = (product + product) * scale;
    lane.half_cos_scale = half_cos * quaternion_scale;
    lane.half_sin_scale = half_sin * quaternion_scale;
    lane.passed = Real(1.0f);
  }

  /// Moves a lane on by one step, within its segment. Returns whether it has come to the segment's end, where the next
  /// one is to be joined.
  bool advance(Lane& lane) const {
    const std::uint32_t segment = index(lane.segment, program_.segments());
    const std::uint32_t row = index(lane.row, program_.steps(segment)) + 1;
    lane.row = Real(static_cast<float>(row));
    if (lane.left > Real(0.0f)) lane.left = lane.left - Real(1.0f);
    if (lane.passed < Real(1.0f)) lane.passed = lane.passed + lane.share;
    return row >= program_.steps(segment);
  }

  /// What the lane shows: position, then, for poses, orientation. `out` has a stride, as lanes lie side by side.
  void show(const Lane& lane, Real* out, int stride) const {
    const std::uint32_t segment = index(lane.segment, program_.segments());
    const std::int16_t* row = row_of(segment, index(lane.row, program_.steps(segment) + 1));
    const bool fades = lane.passed < Real(1.0f);
    Real weight(0.0f), slip(0.0f);
    if (fades) weigh(lane.passed, weight, slip);
    Vector3<Real> position = placed(lane, row);
    if (fades) position = added(position, scaled(lane.slip, slip));
    for (int axis = 0; axis < 3; ++axis) out[axis * stride] = held(position[static_cast<std::size_t>(axis)]);
    if (program_.channels < 7) return;
    Quaternion<Real> q = oriented(lane, row);
    if (fades) q = rotated(added(scaled(lane.lean, weight), scaled(lane.lean_slip, slip)), q);
    for (int k = 0; k < 4; ++k) out[(3 + k) * stride] = q[static_cast<std::size_t>(k)];
  }

  /// The rates of a segment's beginning or end, turned as the lane is.
  Rates rates_of(const Lane& lane, std::uint32_t segment, bool end) const {
    const std::int16_t* rate = program_.rates.data() + (std::size_t{2} * segment + (end ? 1 : 0)) * program_.rate_count;
    const Real cos = lane.half_cos * lane.half_cos - lane.half_sin * lane.half_sin;
    const Real product = lane.half_cos * lane.half_sin;
    const Real sin = product + product;
    Rates rates;
    rates.velocity = turned<Real>(cos, sin, scaled(vector(rate), Real(program_.velocity_scale)));
    if (program_.channels < 7) return rates;
    rates.spin = turned<Real>(cos, sin, scaled(vector(rate + 3), Real(program_.spin_scale)));
    return rates;
  }

  /// How badly the beginning of a segment fits a body: differences of attitude, velocity and spin in the body's own
  /// axes, in units of what is usual.
  Real misfit(std::uint32_t segment, const Body& body) const {
    Lane lane;
    const HalfTurn<Real> turn = turn_to(segment, body);
    place(lane, segment, {}, turn.cos, turn.sin);
    const Rates start = rates_of(lane, segment, false);
    const auto slip = taken(start.velocity, body.rates.velocity);
    const Real unit = Real(1.0f / program_.speed_unit);
    const Real sum = dot(slip, slip) * unit * unit;
    if (program_.channels < 7) return sum;
    const auto twist = taken(start.spin, body.rates.spin);
    const Real spin_unit = Real(1.0f / program_.spin_unit);
    const Real nearness = program_.heading_free ? turn.nearness * Real(program_.orientation_scale) : Real(1.0f);
    return sum + dot(twist, twist) * spin_unit * spin_unit + Real(8.0f) * (Real(1.0f) - nearness);
  }

  /// The turn about z with which a segment is placed where a body is.
  HalfTurn<Real> turn_to(std::uint32_t segment, const Body& body) const {
    if (!program_.heading_free) return {Real(1.0f), Real(0.0f), Real(1.0f)};
    if (program_.channels < 7) {
      const std::int16_t* rate = program_.rates.data() + std::size_t{2} * segment * program_.rate_count;
      return turn_between(vector(rate), body.rates.velocity);
    }
    // As it is stored: its scale is no matter of direction.
    Quaternion<Real> start;
    const std::int16_t* row = row_of(segment, 0);
    for (std::size_t k = 0; k < 4; ++k) start[k] = Real(static_cast<float>(row[3 + k]));
    return turn_between(start, body.orientation);
  }

  /// Where a segment leads from its beginning to its end, as it is stored but in metres.
  Vector3<Real> way_of(std::uint32_t segment) const {
    return scaled(vector(row_of(segment, program_.steps(segment))), Real(program_.position_scale));
  }

  /// A whole number that is stored as a real one, below a bound.
  static std::uint32_t index(Real number, std::uint32_t bound) {
    const auto whole = static_cast<std::uint32_t>(value_of(number));
    return whole < bound ? whole : bound - 1;
  }

 private:
  static Vector3<Real> vector(const std::int16_t* from) {
    return {Real(static_cast<float>(from[0])), Real(static_cast<float>(from[1])), Real(static_cast<float>(from[2]))};
  }

  static Real held(Real coordinate) {
    const Real most(kFarthest), least(-kFarthest);
    if (coordinate > most) return most;
    return coordinate < least ? least : coordinate;
  }

  // Weights of what differs and of the rates that differ, along the fading cubic.
  static void weigh(Real passed, Real& weight, Real& slip) {
    const Real rest = Real(1.0f) - passed;
    const Real rest_squared = rest * rest;
    slip = passed * rest_squared;
    weight = rest_squared + (slip + slip);
  }

  float fading_steps(std::uint32_t segment) const {
    const float most = program_.blend_share * static_cast<float>(program_.steps(segment));
    return most < program_.blend_longest ? most : program_.blend_longest;
  }

  const std::int16_t* row_of(std::uint32_t segment, std::uint32_t row) const {
    return program_.rows.data() + static_cast<std::size_t>(program_.first_row[segment] + row) * program_.channels;
  }

  Vector3<Real> placed(const Lane& lane, const std::int16_t* row) const {
    const auto at = vector(row);
    return {lane.base[0] + (lane.cos_scale * at[0] - lane.sin_scale * at[1]),
            lane.base[1] + (lane.sin_scale * at[0] + lane.cos_scale * at[1]),
            lane.base[2] + Real(program_.position_scale) * at[2]};
  }

  Quaternion<Real> oriented(const Lane& lane, const std::int16_t* row) const {
    const auto axis = vector(row + 4);
    return turned<Real>(lane.half_cos_scale, lane.half_sin_scale,
                        {Real(static_cast<float>(row[3])), axis[0], axis[1], axis[2]});
  }

  const ChainProgram& program_;
};

}  // namespace wisp
