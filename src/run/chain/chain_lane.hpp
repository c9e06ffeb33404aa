#pragma once
// One instance of a segment chain: where it is in which segment, where that segment lies, and what is left of the last
// join. All arithmetic of a frame is here, on one number of any kind.
//
// Joins by inertialization: the difference between what was shown and what the new segment shows, and of their rates,
// is held at the join and fades along a cubic. D. Bollo, Inertialization: high-performance animation transitions in
// Gears of War, GDC 2018, has the idea (with a quintic; half a segment of a leaf is four frames, too short for one).
// Differences are held as they are stored, in the frame and the numbers of the new segment: of quaternions component by
// component, made unit when shown.
//
// A join is spread over frames, so that none is dear: what follows is drawn, and how it is to be turned, a step before
// the end (prepare), it is placed at the end (join), and its difference of velocities is made in the step after that.

#include "run/chain/chain_choice.hpp"
#include "run/chain/chain_program.hpp"
#include "run/chain/chain_settings.hpp"
#include "run/chain/rigid.hpp"

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
  // What follows: the segment's number and 1, 0: not drawn yet. The half turn by which it is turned against this one,
  // of any length; once it is joined and fades, by which it was turned, of length 1.
  Real next{};
  Real turn_cos{1.0f};
  Real turn_sin{};
  // The join: how much of it has passed, in [0, 1]; 1: all of it. In the segment's frame and in its stored numbers.
  Real passed{1.0f};
  Real share{};             ///< passes in a step
  Vector3<Real> slip{};     ///< until the first step: how fast the body moved, in the frame of the segment before
  Quaternion<Real> lean{};  ///< once it lies: 0 and the Gibbs vector that lays it flat
  Quaternion<Real> lean_slip{};
  // The ground: how much of coming to rest has passed, in [0, 1]; below 0: it falls. The pose in which it touched.
  Real settled{-1.0f};
  Quaternion<Real> touched{};
  // Steering: steps left until it should be there, 0: it is not steered; where; and how near, metres.
  Real left{};
  Vector3<Real> target{};
  Real near{};
};

/// How a segment, or a body, ends: as segments are stored, in a frame of its own.
template <class Real>
struct ChainEnd {
  Vector3<Real> velocity{};
  Quaternion<Real> orientation{};
  Quaternion<Real> change{};  ///< of the orientation, a second
};

/// Stored quaternions of which no turn about z brings one nearer to the other than this, are not turned.
inline constexpr float kLeastTurn = 1e-3f;

/// Differences at joins are held to this many of the numbers that are stored.
inline constexpr float kMostDifference = 1e9f;

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

  /// How a segment ends.
  ChainEnd<Real> end_of(std::uint32_t segment) const {
    ChainEnd<Real> end;
    end.velocity = vector(rates_at(segment, true));
    if (program_.channels < 7) return end;
    end.orientation = quaternion(row_of(segment, program_.steps(segment)));
    end.change = change_at(segment, true);
    return end;
  }

  /// How a body moves, in the world's frame.
  ChainEnd<Real> end_of(const Body& body) const {
    ChainEnd<Real> end;
    end.velocity = scaled(body.rates.velocity, Real(1.0f / program_.velocity_scale));
    if (program_.channels < 7) return end;
    for (std::size_t k = 0; k < 4; ++k) end.orientation[k] = body.orientation[k] / Real(program_.orientation_scale);
    end.change = quaternion_rate(body.rates.spin, end.orientation);
    return end;
  }

  /// Notes what follows what ends so, and how it will be turned.
  void prepare(Lane& lane, std::uint32_t next, const ChainEnd<Real>& end) const {
    lane.next = Real(static_cast<float>(next + 1));
    const LongTurn<Real> turn = turn_after(next, end);
    lane.turn_cos = turn.cos;
    lane.turn_sin = turn.sin;
  }

  /// Places the beginning of what was prepared where a body is: its position, its heading where the chain is free of
  /// it; what else differs fades.
  void join(Lane& lane, const Vector3<Real>& position, const ChainEnd<Real>& end) const {
    const std::uint32_t segment = index(lane.next, program_.segments() + 1) - 1;
    const Real shrinks = turn_on(lane);
    place(lane, segment, position, lane.half_cos, lane.half_sin);
    const ChainFade& fade = program_.fade[segment];
    if (!(fade.share > 0.0f)) return;
    lane.turn_cos = lane.turn_cos * shrinks;
    lane.turn_sin = lane.turn_sin * shrinks;
    lane.passed = Real(0.0f);
    lane.share = Real(fade.share);
    lane.slip = bounded(end.velocity);
    if (program_.channels < 7) return;
    const auto back = [&](const Quaternion<Real>& q) { return turned_back(lane.turn_cos, lane.turn_sin, q); };
    const auto start = quaternion(row_of(segment, 0));
    lane.lean = bounded(taken(back(end.orientation), start));
    lane.lean_slip = bounded(scaled(taken(back(end.change), change_at(segment, false)), Real(fade.seconds)));
  }

  /// Places the beginning of a segment as it is, turned by a half turn.
  void place(Lane& lane, std::uint32_t segment, const Vector3<Real>& position, Real half_cos, Real half_sin) const {
    lane.segment = Real(static_cast<float>(segment));
    lane.row = Real(0.0f);
    lane.next = Real(0.0f);
    lane.base = position;
    lane.half_cos = half_cos;
    lane.half_sin = half_sin;
    const Real scale(program_.position_scale), quaternion_scale(program_.orientation_scale);
    lane.cos_scale = (half_cos * half_cos - half_sin * half_sin) * scale;
    lane.sin_scale = half_cos * half_sin * Real(2.0f * program_.position_scale);
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
    if (!(lane.passed < Real(1.0f))) return row >= program_.steps(segment);
    if (row == 1) make_slip(lane, segment);
    lane.passed = lane.passed + lane.share;
    return row >= program_.steps(segment);
  }

  /// Steps that are left of the lane's segment.
  std::uint32_t steps_left(const Lane& lane) const {
    const std::uint32_t steps = program_.steps(index(lane.segment, program_.segments()));
    return steps - index(lane.row, steps + 1);
  }

  /// Whether it is known what follows.
  static bool is_prepared(const Lane& lane) { return lane.next > Real(0.0f); }

  /// What the lane shows: position, then, for poses, orientation. `out` has a stride, as lanes lie side by side.
  void show(const Lane& lane, Real* out, int stride) const {
    const std::uint32_t segment = index(lane.segment, program_.segments());
    const std::int16_t* row = row_of(segment, index(lane.row, program_.steps(segment) + 1));
    const bool fades = lane.passed < Real(1.0f);
    Real weight(0.0f), slip(0.0f);
    if (fades) weigh(lane.passed, weight, slip);
    Vector3<Real> at = vector(row);
    if (fades) at = added(at, scaled(lane.slip, slip));
    const auto position = placed(lane, at);
    for (int axis = 0; axis < 3; ++axis) out[axis * stride] = held(position[static_cast<std::size_t>(axis)]);
    if (program_.channels < 7) return;
    Quaternion<Real> q = quaternion(row);
    if (fades) q = added(q, added(scaled(lane.lean, weight), scaled(lane.lean_slip, slip)));
    q = turned<Real>(lane.half_cos_scale, lane.half_sin_scale, q);
    if (fades) q = unit(q);
    for (int k = 0; k < 4; ++k) out[(3 + k) * stride] = q[static_cast<std::size_t>(k)];
  }

  /// The rates of a segment's beginning or end, turned as the lane is.
  Rates rates_of(const Lane& lane, std::uint32_t segment, bool end) const {
    const std::int16_t* rate = rates_at(segment, end);
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

  /// The turn about z with which a segment is placed where a body is. As they are stored: scales are no matter of
  /// direction.
  HalfTurn<Real> turn_to(std::uint32_t segment, const Body& body) const {
    if (!program_.heading_free) return {Real(1.0f), Real(0.0f), Real(1.0f)};
    if (program_.channels < 7) return turn_between(vector(rates_at(segment, false)), body.rates.velocity);
    return turn_between(quaternion(row_of(segment, 0)), body.orientation);
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

  /// Held to what no sound model exceeds: squares of it are no trouble to single precision.
  template <class Numbers>
  static Numbers bounded(Numbers numbers, float bound = kMostDifference) {
    const Real most(bound), least(-bound);
    for (Real& x : numbers) x = x > most ? most : x > least ? x : least;
    return numbers;
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

  // The half turn with which a segment follows what ends so. Where heading is kept, a whole turn keeps the quaternion's
  // sign from jumping.
  LongTurn<Real> turn_after(std::uint32_t segment, const ChainEnd<Real>& end) const {
    const LongTurn<Real> none{Real(1.0f), Real(0.0f)};
    if (program_.channels < 7) {
      if (!program_.heading_free) return none;
      const HalfTurn<Real> turn = turn_between(vector(rates_at(segment, false)), end.velocity);
      return {turn.cos, turn.sin};
    }
    const auto start = quaternion(row_of(segment, 0));
    if (!program_.heading_free) {
      return dot(start, end.orientation) < Real(0.0f) ? LongTurn<Real>{Real(-1.0f), Real(0.0f)} : none;
    }
    const LongTurn<Real> turn = long_turn_between(start, end.orientation);
    const auto is_long = [](const Real& x) { return x > Real(kLeastTurn) || x < Real(-kLeastTurn); };
    return is_long(turn.cos) || is_long(turn.sin) ? turn : none;
  }

  // Turns a lane by what was prepared. Returns one over the length of that.
  static Real turn_on(Lane& lane) {
    const Real cos = lane.half_cos * lane.turn_cos - lane.half_sin * lane.turn_sin;
    const Real sin = lane.half_cos * lane.turn_sin + lane.half_sin * lane.turn_cos;
    const Real square = cos * cos + sin * sin;
    if (!(square > Real(1e-12f))) return Real(1.0f);  // a saved bank that was made to harm
    const Real inverse = Real(1.0f) / square_root(square);
    lane.half_cos = cos * inverse;
    lane.half_sin = sin * inverse;
    return inverse;
  }

  // How the velocities at a join differ, from how fast the body moved before it.
  void make_slip(Lane& lane, std::uint32_t segment) const {
    const Real cos = lane.turn_cos * lane.turn_cos - lane.turn_sin * lane.turn_sin;
    const Real product = lane.turn_cos * lane.turn_sin;
    const auto before = turned_back<Real>(cos, product + product, lane.slip);
    lane.slip = bounded(scaled(taken(before, vector(rates_at(segment, false))), Real(program_.fade[segment].slip)));
  }

  const std::int16_t* rates_at(std::uint32_t segment, bool end) const {
    return program_.rates.data() + (std::size_t{2} * segment + (end ? 1 : 0)) * program_.rate_count;
  }

  Quaternion<Real> change_at(std::uint32_t segment, bool end) const {
    const float* change = program_.changes.data() + std::size_t{4} * (std::size_t{2} * segment + (end ? 1 : 0));
    return {Real(change[0]), Real(change[1]), Real(change[2]), Real(change[3])};
  }

  const std::int16_t* row_of(std::uint32_t segment, std::uint32_t row) const {
    return program_.rows.data() + static_cast<std::size_t>(program_.first_row[segment] + row) * program_.channels;
  }

  Vector3<Real> placed(const Lane& lane, const Vector3<Real>& at) const {
    return {lane.base[0] + (lane.cos_scale * at[0] - lane.sin_scale * at[1]),
            lane.base[1] + (lane.sin_scale * at[0] + lane.cos_scale * at[1]),
            lane.base[2] + Real(program_.position_scale) * at[2]};
  }

  static Quaternion<Real> quaternion(const std::int16_t* row) {
    const auto axis = vector(row + 4);
    return {Real(static_cast<float>(row[3])), axis[0], axis[1], axis[2]};
  }

  const ChainProgram& program_;
};

}  // namespace wisp
