#pragma once
// One instance of a segment chain: its position in a segment, the segment's placement, and the offset by which it meets
// its neighbours (run/chain/chain_joins.hpp).

#include "run/chain/chain_choice.hpp"
#include "run/chain/chain_program.hpp"
#include "run/chain/rigid.hpp"

namespace wisp {

/// Coordinates are clamped to this many metres from the origin, where single precision resolves 6 cm.
inline constexpr float kFarthest = 1e6f;

/// Height, metres, that stands for no ground: below any reachable one.
inline constexpr float kNoGround = -4.0f * kFarthest;

/// Velocity and angular velocity of a body, in world axes.
template <class Real>
struct BodyRates {
  Vector3<Real> velocity{};  ///< metres per second
  Vector3<Real> spin{};      ///< radians per second
};

/// State of a body at one moment, in world axes.
template <class Real>
struct BodyState {
  Vector3<Real> position{};
  Quaternion<Real> orientation{};
  BodyRates<Real> rates{};
};

/// Rotation of a segment about z: cosine and sine of half the angle; of the angle, times the scale of positions; of
/// half the angle, times the scale of quaternions.
template <class Real>
struct ChainTurn {
  Real half_cos{};
  Real half_sin{};
  Real cos_scale{};
  Real sin_scale{};
  Real half_cos_scale{};
  Real half_sin_scale{};
};

/// Half of the difference at a join: end of the previous segment minus beginning of the next, in world axes. lean and
/// lean_rate: orientation and its change per step; slip: displacement per step.
template <class Real>
struct ChainGap {
  Quaternion<Real> lean{};
  Quaternion<Real> lean_rate{};
  Vector3<Real> slip{};
};

/// The join at the end of a segment: the next segment's rotation, and the gap.
template <class Number>
struct ChainAhead {
  ChainTurn<Number> turn{};
  ChainGap<Number> gap{};
};

/// State that every step reads or changes. In a bank, a `Number` holds one number per lane of a block.
template <class Number>
struct ChainPlayed {
  // Position in the chain; whole numbers.
  Number segment{};
  Number row{};
  // Placement of the segment: base + turn(scale · row). Velocity offsets move the base.
  Vector3<Number> base{};
  ChainTurn<Number> turn{};
  // Offsets at joins. lean: offset of the orientation, its first difference, its second difference, and the second
  // difference of the latter half of the curve. slip: distance by which a step moves the base, and its difference.
  std::array<Quaternion<Number>, 4> lean{};
  std::array<Vector3<Number>, 2> slip{};
  // The ground: progress of coming to rest, 0 to 1; below 0: the instance falls.
  Number settled{};
  // Steering: steps left until the target time, 0: not steered.
  Number left{};
};

/// State that only joins, the ground and steering need. Joins read `ahead` of several lanes in parallel, four numbers
/// at a time; so `ahead` (17 numbers) comes first, and three more numbers fill the last four.
template <class Real>
struct ChainPlan {
  ChainAhead<Real> ahead{};
  Real next{};   ///< index of the next segment plus 1; 0: not drawn yet
  Real state{};  ///< state of the Markov chain; a whole number
  Real near{};   ///< steering: tolerance, metres
  // Orientation at touchdown, and the Gibbs vector that rotates it flat.
  Quaternion<Real> touched{};
  Vector3<Real> laid{};
  Vector3<Real> target{};  ///< steering: target position
};

/// Number of values that joins read of a plan: `ahead`, `next`, `state` and `near`.
inline constexpr std::size_t kAheadNumbers = 20;

template <class Real>
struct ChainLane : ChainPlayed<Real>, ChainPlan<Real> {};

/// Calls visit(number of a, number of b) for each number of a turn, a gap or an offset.
template <class A, class B, class Visit>
inline void each_number(ChainTurn<A>& a, B& b, Visit visit) {
  visit(a.half_cos, b.half_cos);
  visit(a.half_sin, b.half_sin);
  visit(a.cos_scale, b.cos_scale);
  visit(a.sin_scale, b.sin_scale);
  visit(a.half_cos_scale, b.half_cos_scale);
  visit(a.half_sin_scale, b.half_sin_scale);
}
template <class A, class B, class Visit>
inline void each_number(ChainGap<A>& a, B& b, Visit visit) {
  for (std::size_t k = 0; k < 4; ++k) visit(a.lean[k], b.lean[k]);
  for (std::size_t k = 0; k < 4; ++k) visit(a.lean_rate[k], b.lean_rate[k]);
  for (std::size_t k = 0; k < 3; ++k) visit(a.slip[k], b.slip[k]);
}
template <class A, class B, class Visit>
inline void each_number(ChainAhead<A>& a, B& b, Visit visit) {
  each_number(a.turn, b.turn, visit);
  each_number(a.gap, b.gap, visit);
}
template <class A, class B, class Visit>
inline void each_added(A& a, B& b, Visit visit) {
  for (std::size_t i = 0; i < a.lean.size(); ++i) {
    for (std::size_t k = 0; k < 4; ++k) visit(a.lean[i][k], b.lean[i][k]);
  }
  for (std::size_t i = 0; i < a.slip.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) visit(a.slip[i][k], b.slip[i][k]);
  }
}

/// Calls visit(number of a, number of b) for each number of the played state.
template <class A, class B, class Visit>
inline void each_played(A& a, B& b, Visit visit) {
  visit(a.segment, b.segment);
  visit(a.row, b.row);
  for (std::size_t k = 0; k < 3; ++k) visit(a.base[k], b.base[k]);
  each_number(a.turn, b.turn, visit);
  each_added(a, b, visit);
  visit(a.settled, b.settled);
  visit(a.left, b.left);
}

/// Minimum of the larger of cosine and sine that long_turn_between() finds; below it, a join makes no rotation.
inline constexpr float kMinTurn = 1e-3f;

/// Magnitude to which differences at joins are clamped.
inline constexpr float kMaxDifference = 1e9f;

/// Returns the ChainTurn of a rotation, given cosine and sine of half its angle. number(x) is x in every lane.
template <class Values, class Number>
inline ChainTurn<Values> turn_of(const Values& half_cos, const Values& half_sin, const ChainProgram& program,
                                 Number number) {
  const Values quaternion_scale = number(program.orientation_scale);
  return {half_cos,
          half_sin,
          (half_cos * half_cos - half_sin * half_sin) * number(program.position_scale),
          half_cos * half_sin * number(2.0f * program.position_scale),
          half_cos * quaternion_scale,
          half_sin * quaternion_scale};
}

/// Places lanes of one program on segments, and reads states from the stored segments.
template <class Real>
class ChainMover {
 public:
  using Lane = ChainLane<Real>;
  using Body = BodyState<Real>;
  using Rates = BodyRates<Real>;

  explicit ChainMover(const ChainProgram& program) : program_(program) {}

  /// Draws the first segment. Sets `of_state`, the state of the Markov chain.
  std::uint32_t draw_first(Real& of_state, const ChainChoice& choice, const ChainWords& words) const {
    const std::uint32_t mode = choice.mode(program_, 0, words);
    of_state = state_after(0, mode);
    return choice.beginning(program_, mode, words);
  }

  /// Draws the next mode. Updates `of_state`, the state of the Markov chain.
  std::uint32_t draw_mode(Real& of_state, const ChainChoice& choice, const ChainWords& words) const {
    const std::uint32_t state = index(of_state, program_.states());
    const std::uint32_t mode = choice.mode(program_, state, words);
    of_state = state_after(state, mode);
    return mode;
  }

  /// Returns the position at which a first segment begins: the origin or, if heights are bounded, its recorded height.
  Vector3<Real> beginning_of(std::uint32_t segment) const {
    if (program_.height.empty()) return {};
    return {Real(0.0f), Real(0.0f), height_of(segment)};
  }

  /// Places a segment's start at a position, rotated about z; half_cos, half_sin: cosine and sine of half the angle.
  void place(Lane& lane, std::uint32_t segment, const Vector3<Real>& position, Real half_cos, Real half_sin) const {
    lane.segment = Real(static_cast<float>(segment));
    lane.row = Real(0.0f);
    lane.next = Real(0.0f);
    lane.settled = Real(-1.0f);
    lane.base = position;
    lane.turn = turn_of(half_cos, half_sin, program_, [](float x) { return Real(x); });
  }

  /// Places a segment's beginning at a body's position and heading. Returns the whole remaining difference, not half.
  ChainGap<Real> place(Lane& lane, std::uint32_t segment, const Body& body) const {
    const HalfTurn<Real> turn = turn_to(segment, body);
    place(lane, segment, body.position, turn.cos, turn.sin);
    ChainGap<Real> gap;
    if (program_.blend_steps == 0) return gap;
    const auto begins = turned_velocity(lane.turn, rates_at(segment, false));
    gap.slip = bounded(scaled(taken(body.rates.velocity, begins), Real(program_.step_seconds)));
    if (program_.channels >= 7) {
      const auto start = oriented(lane.turn, quaternion(row_of(segment, 0)));
      const auto change = scaled(oriented(lane.turn, change_at(segment, false)), Real(2.0f));
      auto shown = body.orientation;
      if (dot(start, shown) < Real(0.0f)) shown = scaled(shown, Real(-1.0f));
      gap.lean = bounded(taken(shown, start));
      gap.lean_rate =
          bounded(taken(scaled(quaternion_rate(body.rates.spin, shown), Real(program_.step_seconds)), change));
    }
    return gap;
  }

  /// Rows of a segment between which its offset fades: whole numbers, −1 for none.
  struct Rows {
    float steps;       ///< the last row
    float quiet_from;  ///< the first row without an offset
    float quiet_to;    ///< the last row without an offset; 0 if the offsets of both joins overlap
    float turn;        ///< the first row of the latter half of the curve that begins with the segment
    float last_turn;   ///< the first row of the latter half of the curve at the end of a long segment
    float curve;       ///< the row after which the curve at the end of a long segment begins
  };
  Rows rows_of(std::uint32_t segment) const {
    const std::uint32_t blend = program_.blend_steps, steps = program_.steps(segment);
    const auto number = [](std::uint32_t row) { return static_cast<float>(row); };
    const float last = number(steps);
    if (blend == 0) return {last, 0, last, -1, -1, -1};
    if (steps < 2 * blend) return {last, last + 1, 0, number(first_half(steps)), -1, -1};
    const float turn = number(first_half(blend));
    return {last, number(blend), number(steps - blend), turn, number(steps - blend) + turn, number(steps - blend)};
  }

  std::uint32_t steps_left(const Lane& lane) const {
    const std::uint32_t steps = program_.steps(index(lane.segment, program_.segments()));
    return steps - index(lane.row, steps + 1);
  }

  /// Returns whether the next segment has been drawn.
  static bool is_prepared(const ChainPlan<Real>& plan) { return plan.next > Real(0.0f); }

  /// Returns the state at the end of a lane's segment, without its offset; for chains of poses without the rates.
  Body end_of(const Lane& lane) const {
    const std::uint32_t segment = index(lane.segment, program_.segments());
    const std::int16_t* row = row_of(segment, program_.steps(segment));
    Body body;
    body.position = placed(lane, vector(row));
    if (program_.channels >= 7) body.orientation = oriented(lane.turn, quaternion(row));
    if (program_.channels < 7) body.rates = rates_of(lane, segment, true);
    return body;
  }

  /// Returns the rates at a segment's beginning or end, with the lane's rotation about z.
  Rates rates_of(const Lane& lane, std::uint32_t segment, bool end) const {
    const std::int16_t* rate = rates_at(segment, end);
    Rates rates;
    rates.velocity = turned_velocity(lane.turn, rate);
    if (program_.channels < 7) return rates;
    const ChainTurn<Real>& turn = lane.turn;
    const Real cos = turn.half_cos * turn.half_cos - turn.half_sin * turn.half_sin;
    const Real product = turn.half_cos * turn.half_sin;
    const Real sin = product + product;
    rates.spin = turned<Real>(cos, sin, scaled(vector(rate + 3), Real(program_.spin_scale)));
    return rates;
  }

  /// Returns the squared distance of a segment's beginning from a body's state: the sum of the squared differences of
  /// attitude (radians; only if heading is free), velocity and spin, the latter two in units of their typical sizes.
  Real misfit(std::uint32_t segment, const Body& body) const {
    Lane lane;
    const HalfTurn<Real> turn = turn_to(segment, body);
    place(lane, segment, Vector3<Real>{}, turn.cos, turn.sin);
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

  /// Returns the rotation about z that aligns a segment's start with a body. Stored units suffice to find an angle.
  HalfTurn<Real> turn_to(std::uint32_t segment, const Body& body) const {
    if (!program_.heading_free) return {Real(1.0f), Real(0.0f), Real(1.0f)};
    if (program_.channels < 7) return turn_between(vector(rates_at(segment, false)), body.rates.velocity);
    return turn_between(quaternion(row_of(segment, 0)), body.orientation);
  }

  /// Returns the position of a row of the lane's segment, moved by share · `more` (stored units).
  Vector3<Real> place_at(const Lane& lane, std::uint32_t row, const std::int16_t* more, Real share) const {
    const std::int16_t* at = row_of(index(lane.segment, program_.segments()), row);
    return placed(lane, added(vector(at), scaled(vector(more), share)));
  }

  /// Converts a whole number that is stored as a Real to an index, at most bound − 1.
  static std::uint32_t index(Real number, std::uint32_t bound) {
    const auto whole = static_cast<std::uint32_t>(value_of(number));
    return whole < bound ? whole : bound - 1;
  }

  /// Clamps numbers to ±bound. Valid models stay within the default bound, whose square fits single precision.
  template <class Numbers>
  static Numbers bounded(Numbers numbers, float bound = kMaxDifference) {
    const Real most(bound), least(-bound);
    for (Real& x : numbers) x = x > most ? most : x > least ? x : least;
    return numbers;
  }

 private:
  Real state_after(std::uint32_t state, std::uint32_t mode) const {
    return Real(static_cast<float>(program_.state_after(state, mode)));
  }

  Real height_of(std::uint32_t segment) const {
    return Real(program_.height_scale) * Real(static_cast<float>(program_.height[segment]));
  }

  static Vector3<Real> vector(const std::int16_t* from) {
    return {Real(static_cast<float>(from[0])), Real(static_cast<float>(from[1])), Real(static_cast<float>(from[2]))};
  }

  // Converts a stored quaternion, or a change of one, to world axes.
  static Quaternion<Real> oriented(const ChainTurn<Real>& turn, const Quaternion<Real>& stored) {
    return turned<Real>(turn.half_cos_scale, turn.half_sin_scale, stored);
  }

  // Converts a stored velocity to world axes, metres per second.
  Vector3<Real> turned_velocity(const ChainTurn<Real>& turn, const std::int16_t* stored) const {
    const Real scale(program_.velocity_scale / program_.position_scale);
    const auto v = vector(stored);
    return {scale * (turn.cos_scale * v[0] - turn.sin_scale * v[1]),
            scale * (turn.sin_scale * v[0] + turn.cos_scale * v[1]), Real(program_.velocity_scale) * v[2]};
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
    return {lane.base[0] + (lane.turn.cos_scale * at[0] - lane.turn.sin_scale * at[1]),
            lane.base[1] + (lane.turn.sin_scale * at[0] + lane.turn.cos_scale * at[1]),
            lane.base[2] + Real(program_.position_scale) * at[2]};
  }

  static Quaternion<Real> quaternion(const std::int16_t* row) {
    const auto axis = vector(row + 4);
    return {Real(static_cast<float>(row[3])), axis[0], axis[1], axis[2]};
  }

  const ChainProgram& program_;
};

}  // namespace wisp
