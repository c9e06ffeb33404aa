#pragma once
// Steps blocks of instances of a segment chain. Source: section 4.3 of the paper (the walk over the modes, each
// realised by one of its segments); section 2.2 for histories longer than one. Lanes of a block are in different places
// of different segments, but advance and are displayed by the same operations in parallel. Rarer events follow: joins
// in parallel for lanes of several blocks, others for one lane at a time.

#include <array>
#include <cstdint>
#include <span>

#include "run/chain/chain_block.hpp"
#include "run/chain/chain_joining.hpp"
#include "run/chain/chain_lane.hpp"
#include "run/chain/chain_steering.hpp"
#include "run/chain/ground_lane.hpp"
#include "run/chain/gust_lane.hpp"
#include "run/state/channels.hpp"
#include "run/state/moment.hpp"
#include "wisp/run/chain_facet.hpp"
#include "wisp/run/random.hpp"

namespace wisp {

template <class N>
class ChainStepper : private ChainLives<N> {
 public:
  using Real = typename N::Real;
  using Lane = ChainLane<Real>;
  using Body = BodyState<Real>;
  static constexpr int kLanes = N::kLanes;
  using typename ChainLives<N>::LaneNumbers;
  using typename ChainLives<N>::Played;
  using ChainLives<N>::newest;
  using ChainLives<N>::previous;
  /// Number of frames over which a cost is averaged: joins are rare.
  static constexpr int kCountedFrames = 8192;

  /// Returns zeros: a chain has no operating point; its outputs are not deviations, but in their own units.
  static OperatingPoint operating_point(const ChainModel& chain) {
    static constexpr std::array<double, 7> kOrigin{};
    return {std::span(kOrigin).first(static_cast<std::size_t>(channel_count(chain.motion))),
            std::span(kOrigin).first(chain.gust ? 3 : 0)};
  }

  static Result<void> check(const Model&, const ChainModel& chain) { return check_chain_program(chain); }

  ChainStepper(const Model& model, const ChainModel& chain, const Channels&, int blocks, Arena& arena)
      : ChainLives<N>(made_program(model, chain, arena), blocks, arena),
        steering_(program_, chain.drift.has_value(), arena) {
    const auto lanes = static_cast<std::size_t>(blocks) * kLanes;
    stirred_ = arena.take<std::uint8_t>(static_cast<std::size_t>(blocks));
    if (program_.gust.present) gusts_ = arena.take<GustLane<Real>>(lanes);
    regressor_row_ = regressor_count(model.inputs) * kLanes;
    regressors_ = arena.take<Real>(static_cast<std::size_t>(blocks) * regressor_row_);
  }

  /// Sets whether modes and segments are chosen at random (scale above 0); a chain has no residual noise.
  void set_noise(float scale) { choice_.set_chance(scale > 0); }

  void set_ground(float height) { ground_ = height; }

  void turn(int = 1) {}

  /// Returns the address for the step's regressors: [regressor][lane].
  Real* regressors(int block) { return regressors_.data() + static_cast<std::size_t>(block) * regressor_row_; }

  /// Largest number of blocks that step() takes at once: enough that the lanes that join in one step fill vectors.
  static constexpr int kGroup = 32;
  static constexpr bool kGroupsVary = true;

  /// Returns this stepper, which can step some blocks ahead of others, since blocks share no ring position.
  ChainStepper& ahead() { return *this; }

  void step(int block, const Moment<N>& moment) { step(block, 1, moment); }

  /// Computes the newest samples of `count` <= kGroup consecutive blocks; `moment` is that of the first block.
  void step(int first, int count, const Moment<N>& moment) {
    ChainCourse<N> courses[kGroup];
    for (int b = 0; b < count; ++b) set_out(first + b, moment.later(b), courses[b]);
    Gathering gathering(*this, first, moment);
    for (int b = 0; b < count; ++b) gathering.take(first + b, courses[b].begins, &ChainStepper::leave);
    gathering.end(&ChainStepper::leave);
    for (int b = 0; b < count; ++b) {
      arrive(first + b, moment.later(b), courses[b]);
      gathering.take(first + b, courses[b].ends, &ChainStepper::go_on);
    }
    gathering.end(&ChainStepper::go_on);
  }

  /// Reads the outputs of a block: the newest sample.
  template <int kBlocks = 1>
  void show(int block, Real* out) const {
    copy_sample(newest(block), sample_size(), out);
  }

  /// Reads outputs interpolated by `share` from the sample before: linearly, orientations then normalised.
  template <int kBlocks = 1>
  void show_between(int block, float share, Real* out) const {
    const Real *from = previous(block), *to = newest(block);
    for (std::size_t k = 0; k < sample_size(); ++k) out[k] = from[k] + Real(share) * (to[k] - from[k]);
    if (program_.channels < 7) return;
    for (int lane = 0; lane < kLanes; ++lane) {
      Quaternion<Real> q;
      for (int k = 0; k < 4; ++k) q[static_cast<std::size_t>(k)] = out[(3 + k) * kLanes + lane];
      q = unit(q);
      for (int k = 0; k < 4; ++k) out[(3 + k) * kLanes + lane] = q[static_cast<std::size_t>(k)];
    }
  }

  /// Reads the outputs of a frame at the model's own rate.
  void show_frame(int block, Real* out) const { show(block, out); }

  /// Starts one lane at the origin, or above it at its segment's recorded height if heights are bounded, with a random
  /// heading and a segment of a mode drawn from those that begin recordings.
  void start(int block, int lane, const Moment<N>& moment) {
    const Party party = Party::of(block, lane);
    const Drawn words = Joining::draw(party, block, moment, 1);
    const Mover mover(program_);
    Lane life;
    if (program_.gust.present) gust_of(block, lane) = {};
    const std::uint32_t segment = mover.draw_first(life.state, choice_, {words[0][0], words[1][0]});
    const HalfTurn<Real> turn = random_turn(words[2][0], words[3][0]);
    mover.place(life, segment, mover.beginning_of(segment), turn.cos, turn.sin);
    put(block, lane, life);
    lanes_of(block).show_only(lane);
    joining().prepare_one(block, lane, Joining::draw(party, block, moment, 2));
    joining().meet_one(block, lane, {});
    begin_at(block, lane);
  }

  /// Returns a lane's mean velocity and angular velocity between its last two samples.
  BodyRates<Real> rates(int block, int lane) const {
    const Real *from = previous(block) + lane, *to = newest(block) + lane, rate(1.0f / program_.step_seconds);
    BodyRates<Real> moves;
    for (int k = 0; k < 3; ++k) {
      moves.velocity[static_cast<std::size_t>(k)] = (to[k * kLanes] - from[k * kLanes]) * rate;
    }
    if (program_.channels < 7) return moves;
    // The vector part of the rotation between the samples is the sine of half its angle, approximately half the angle.
    const auto q = [](const Real* at) { return Quaternion<Real>{at[0], at[kLanes], at[2 * kLanes], at[3 * kLanes]}; };
    const auto a = q(from + 3 * kLanes), b = q(to + 3 * kLanes);
    const Vector3<Real> u{a[1], a[2], a[3]}, v{b[1], b[2], b[3]};
    const auto half = added(taken(scaled(v, a[0]), scaled(u, b[0])), cross(u, v));
    moves.spin = scaled(half, (dot(a, b) < Real(0.0f) ? Real(-2.0f) : Real(2.0f)) * rate);
    return moves;
  }

  /// Returns a lane's progress of coming to rest on the ground: it falls below 0, and lies from 1 on.
  Real settled(int block, int lane) const { return played_of(block).settled[lane]; }

  ChainPlace place_of(int block, int lane) const {
    const Played& played = played_of(block);
    const std::uint32_t segment = Mover::index(played.segment[lane], program_.segments());
    const std::uint32_t row = Mover::index(played.row[lane], program_.steps(segment));
    return {segment, row, program_.mode[segment]};
  }

  /// Returns whether threads may step blocks in parallel: not once a lane was steered, as steering has only one buffer.
  bool can_be_shared() const { return !steered_; }

  bool can_steer() const { return !program_.lead.empty(); }

  /// Steers a lane towards a target to be reached in `steps` steps; 0: cancels steering. Precondition: can_steer().
  void steer(int block, int lane, const Vector3<Real>& target, float steps, float near) {
    plan_of(block, lane).target = target;
    plan_of(block, lane).near = Real(near);
    played_of(block).left[lane] = Real(steps);
    steered_ |= steps > 0;
  }

  /// Places a lane at a body's position and heading, on the segment whose initial motion is nearest to the body's.
  void place(int block, int lane, const Body& body) {
    const Mover mover(program_);
    std::uint32_t best = 0;
    Real least(3e38f);
    for (std::uint32_t segment = 0; segment < program_.segments(); ++segment) {
      // A segment of one step is too short for the remaining difference to decay.
      if (program_.steps(segment) == 1) continue;
      const Real misfit = mover.misfit(segment, body);
      if (!(misfit < least)) continue;
      best = segment;
      least = misfit;
    }
    Lane life;
    const ChainGap<Real> gap = mover.place(life, best, body);
    life.state = Real(static_cast<float>(program_.state_after(0, program_.mode[best])));
    put(block, lane, life);
    if (program_.gust.present) gust_of(block, lane) = {};
    joining().meet_one(block, lane, gap);
    lanes_of(block).show_only(lane);
    begin_at(block, lane);
  }

  /// Returns 0: a chain has no coefficients of A and B.
  std::int64_t multiply_adds() const { return 0; }

  std::size_t lane_values() const {
    return kLaneNumbers + 2 * static_cast<std::size_t>(program_.channels) + (program_.gust.present ? 9 : 0);
  }

  /// Calls visit(value, low, high) for each state variable of one lane, with a step of 1 for whole numbers.
  template <class Visit>
  void visit_lane(int block, int lane, Visit visit) {
    Lane life = lane_of(block, lane);
    const auto segments = static_cast<float>(program_.segments() - 1);
    visit(life.segment, 0.0f, segments, 1.0f);
    visit(life.row, 0.0f, static_cast<float>(kMaxSegmentSteps), 1.0f);
    visit(life.state, 0.0f, static_cast<float>(program_.states() - 1), 1.0f);
    for (Real& x : life.base) visit(x, -2 * kFarthest, 2 * kFarthest);
    visit_turn(life.turn, visit);
    visit(life.next, 0.0f, static_cast<float>(program_.segments()), 1.0f);
    visit_turn(life.ahead.turn, visit);
    for (auto* numbers :
         {&life.ahead.gap.lean, &life.ahead.gap.lean_rate, &life.lean[0], &life.lean[1], &life.lean[2], &life.lean[3]})
      visit_difference(*numbers, visit);
    for (auto* numbers : {&life.ahead.gap.slip, &life.slip[0], &life.slip[1], &life.laid})
      visit_difference(*numbers, visit);
    visit(life.settled, -1.0f, kMaxSlip);
    visit(life.left, 0.0f, kMaxSlip, 1.0f);
    steered_ |= can_steer() && life.left > Real(0.0f);
    for (Real& x : life.target) visit(x, -kFarthest, kFarthest);
    visit(life.near, 0.0f, kFarthest);
    for (Real& x : life.touched) visit(x, -kLongest, kLongest);
    put(block, lane, life);
    stirred_[static_cast<std::size_t>(block)] = 1;
    if (program_.gust.present) {
      GustLane<Real>& gust = gust_of(block, lane);
      gust.press = scaled(gust.press, Real(4.0f));  // saves the whole normal wind
      for (auto* vector : {&gust.change, &gust.wind, &gust.press}) {
        for (Real& x : *vector) visit(x, -kMaxSlip, kMaxSlip);
      }
      gust.press = scaled(gust.press, Real(0.25f));
    }
    for (Real* sample : {newest_of(block), previous_of(block)}) {
      for (int k = 0; k < program_.channels; ++k) {
        const float most = k < 3 ? 2 * kFarthest : kLongest;
        visit(sample[k * kLanes + lane], -most, most);
      }
    }
  }

  std::uint64_t hash(std::uint64_t before) const { return hash_of(program_, before); }

 private:
  using Mover = ChainMover<Real>;
  using Joining = ChainJoining<N>;
  using Party = typename Joining::Party;
  using Drawn = typename Joining::Drawn;
  using ChainLives<N>::falls;
  using ChainLives<N>::lane_of;
  using ChainLives<N>::lanes_of;
  using ChainLives<N>::newest_of;
  using ChainLives<N>::plan_of;
  using ChainLives<N>::played_of;
  using ChainLives<N>::previous_of;
  using ChainLives<N>::program_;
  using ChainLives<N>::put;
  using ChainLives<N>::sample_size;
  static constexpr std::size_t kLaneNumbers = 3 + 3 + 2 * 6 + 1 + 6 * 4 + 4 * 3 + 1 + 5 + 4;
  static constexpr float kMaxSlip = 1e12f;
  static constexpr float kCarrySeconds = 1.0f;
  static constexpr float kLongest = 1.01f;  // bound on an orientation's numbers: stored norms are 1 up to rounding

  template <class Visit>
  void visit_turn(ChainTurn<Real>& turn, Visit visit) {
    for (Real* x : {&turn.half_cos, &turn.half_sin}) visit(*x, -1.01f, 1.01f);
    const float most = 1.01f * (program_.position_scale + program_.orientation_scale);
    for (Real* x : {&turn.cos_scale, &turn.sin_scale, &turn.half_cos_scale, &turn.half_sin_scale})
      visit(*x, -most, most);
  }

  // Clamps offsets: after restoring a manipulated bank they could grow beyond the range that restore() accepts.
  template <class Numbers, class Visit>
  static void visit_difference(Numbers& numbers, Visit visit) {
    numbers = Mover::bounded(numbers);
    for (Real& x : numbers) visit(x, -kMaxDifference, kMaxDifference);
  }

  GustLane<Real>& gust_of(int block, int lane) { return gusts_[static_cast<std::size_t>(block) * kLanes + lane]; }

  static ChainProgram made_program(const Model& model, const ChainModel& chain, Arena& arena) {
    ChainProgram program = make_chain_program(chain, model.rate_hz, wind_unit(model), arena);
    take_size(model.view, program);
    return program;
  }

  // Returns the channel unit common to the wind's x, y and z: that of the smallest range that includes their ranges.
  static double wind_unit(const Model& model) {
    if (model.inputs.empty()) return 1;
    double lowest = 0, highest = 0;
    for (const Input& input : model.inputs) {
      lowest = input.lowest < lowest ? input.lowest : lowest;
      highest = input.highest > highest ? input.highest : highest;
    }
    return channel_scale(lowest, highest);
  }

  // Collects lanes of several blocks that have the same event, and processes as many at once as fit in a vector.
  class Gathering {
   public:
    using Happen = void (ChainStepper::*)(const Party& party, int first, const Moment<N>& moment);

    Gathering(ChainStepper& stepper, int first, const Moment<N>& moment)
        : stepper_(stepper), first_(first), moment_(moment) {}

    void take(int block, const typename ChainCourse<N>::Mask& mask, Happen happen) {
      if (!any_lane<N>(mask)) return;
      for (int lane = 0; lane < kLanes; ++lane) {
        if (!(mask[lane] > Real(0.0f))) continue;
        party_.add(block, lane);
        if (party_.is_full()) end(happen);
      }
    }

    void end(Happen happen) {
      if (party_.count == 0) return;
      (stepper_.*happen)(party_, first_, moment_);
      party_.count = 0;
    }

   private:
    ChainStepper& stepper_;
    Party party_;
    int first_;
    const Moment<N>& moment_;
  };

  // Advances the lanes of a block by one step.
  void set_out(int block, const Moment<N>& moment, ChainCourse<N>& course) {
    copy_sample(newest(block), sample_size(), previous_of(block));
    std::fill_n(moment.clamped, kLanes, 0U);
    const int lanes = moment.lanes();
    if (program_.gust.present) drift(block, lanes);
    for (int lane = 0; steered_ && lane < lanes; ++lane) carry(block, lane);
    course.use(lanes);
    lanes_of(block).go(course);
  }

  // Displays the advanced lanes, and settles those on the ground, whose segments then do not end in a join.
  void arrive(int block, const Moment<N>& moment, ChainCourse<N>& course) {
    ChainBlock<N> lanes = lanes_of(block);
    lanes.move(course);
    lanes.show(course);
    Real eventful[kLanes];
    if (!find_events(block, course, eventful)) return;
    for (int lane = 0; lane < kLanes; ++lane) {
      if (!(eventful[lane] > Real(0.0f))) continue;
      if (!falls(block, lane)) {
        settle(block, lane);
        course.ends[lane] = Real(0.0f);
        continue;
      }
      hold_position(block, lane, moment);
      if (const auto reach = reach_touching(program_, newest_of(block) + lane, kLanes, ground_)) {
        land(block, lane, *reach);
        course.ends[lane] = Real(0.0f);
      }
    }
  }

  // Finds lanes that come to rest, are too far away or near the ground, and so need more work. Returns whether any do.
  bool find_events(int block, const ChainCourse<N>& course, Real (&eventful)[kLanes]) {
    const auto zero = all<Reals<N>>(0.0f), one = all<Reals<N>>(1.0f), used = load<Reals<N>>(course.used);
    const auto inside = [](const auto& x, const auto& low, const auto& high, const auto& yes, const auto& no) {
      return x < low ? no : x < high ? yes : no;
    };
    const auto beyond = [](const auto& x, const auto& low, const auto& high, const auto& yes, const auto& no) {
      return x > low ? (x < high ? no : yes) : yes;
    };
    auto found = each(inside, load<Reals<N>>(played_of(block).settled.data()), zero, one, used, zero);
    const float nearest[3] = {-kFarthest, -kFarthest,
                              std::max(-kFarthest, ground_ + (program_.half_width + program_.half_length))};
    for (int axis = 0; axis < 3; ++axis) {
      const auto at = load<Reals<N>>(newest(block) + axis * kLanes);
      found = each(beyond, at, all<Reals<N>>(nearest[axis]), all<Reals<N>>(kFarthest), used, found);
    }
    store(found, eventful);
    return any_lane<N>(eventful);
  }

  // Makes one step of a lane that settles on the ground; a lane at rest stays.
  void settle(int block, int lane) {
    if (!(played_of(block).settled[lane] < Real(1.0f))) return;
    Lane life = lane_of(block, lane);
    settle_step(life, program_, newest_of(block) + lane, kLanes);
    put(block, lane, life);
  }

  // If the displayed position of a lane is clamped, marks the lane and clamps the base of its segment.
  void hold_position(int block, int lane, const Moment<N>& moment) {
    if (!is_far(newest_of(block) + lane)) return;
    moment.clamped[lane] = 1;
    for (LaneNumbers& base : played_of(block).base) {
      const Real& x = base[lane];
      const Real most(2 * kFarthest), least(-2 * kFarthest);
      base[lane] = x > most ? most : x > least ? x : least;
    }
  }

  // In the last second of steering, moves a lane's segment towards the target, by such a share of the expected miss
  // that the miss decreases as the square of the time left.
  void carry(int block, int lane) {
    const Real left = played_of(block).left[lane], all(kCarrySeconds / program_.step_seconds), one(1.0f);
    if (!falls(block, lane) || !(left > Real(0.0f)) || !(left < all)) return;
    const Real share = (one - left / all) * Real(2.0f) / left, gain = left > one && share < one ? share : one;
    const Lane life = lane_of(block, lane);
    const auto miss = taken(life.target, ChainSteering<Real>::expected(Mover(program_), program_, life));
    const auto way = Mover::bounded(scaled(miss, gain), program_.speed_unit * program_.step_seconds);
    for (std::size_t k = 0; k < 3; ++k) played_of(block).base[k][lane] = played_of(block).base[k][lane] + way[k];
  }

  // Moves the segments of a block by the velocity changes due to wind.
  void drift(int block, int lanes) {
    std::uint8_t& stirred = stirred_[static_cast<std::size_t>(block)];
    if (stirred == 0 && is_calm(block)) return;
    stirred = 0;
    for (int lane = 0; lane < lanes; ++lane) {
      if (!falls(block, lane)) {
        stirred = 1;  // on the ground the response is kept
        continue;
      }
      if (drift_lane(block, lane)) stirred = 1;
    }
  }

  bool is_calm(int block) {
    const Real* wind = regressors(block);
    auto most = magnitude(load<Reals<N>>(wind));
    for (int axis : {1, 2}) most = larger(magnitude(load<Reals<N>>(wind + axis * kLanes)), most);
    const auto least = all<Reals<N>>(kMinGust);
    return !any(differ(larger(most, least), least));
  }

  // Moves the segment of one lane. Returns whether its response to the wind lasts.
  bool drift_lane(int block, int lane) {
    const Real* at = regressors(block) + lane;
    const Vector3<Real> wind{at[0], at[kLanes], at[2 * kLanes]};
    GustLane<Real>& gust = gust_of(block, lane);
    if (!gust_lasts(gust, wind)) {
      gust = {};
      return false;
    }
    Vector3<Real> press{};
    if (program_.channels >= 7) press = quarter_press(shown_orientation(block, lane), taken(wind, gust.change));
    const auto change = blow(program_.gust, gust, wind, press);
    const auto way = scaled(change, Real(program_.step_seconds));
    for (int k = 0; k < 3; ++k) {
      const auto axis = static_cast<std::size_t>(k);
      Real& at_axis = played_of(block).base[axis][lane];
      at_axis = at_axis + way[axis];
    }
    return true;
  }

  Quaternion<Real> shown_orientation(int block, int lane) const {
    Quaternion<Real> q;
    for (std::size_t k = 0; k < 4; ++k) q[k] = newest(block)[(3 + k) * kLanes + static_cast<std::size_t>(lane)];
    return q;
  }

  // Starts settling a lane whose displayed body has reached the ground; `reach`: the body's extent below its centre.
  void land(int block, int lane, Real reach) {
    Lane life = lane_of(block, lane);
    Body body;
    for (std::size_t k = 0; k < 3; ++k) body.position[k] = newest(block)[k * kLanes + static_cast<std::size_t>(lane)];
    if (program_.channels >= 7) body.orientation = shown_orientation(block, lane);
    body.rates = rates(block, lane);
    newest_of(block)[2 * kLanes + lane] = Real(ground_) + reach;
    touch(life, body, ground_);
    put(block, lane, life);
  }

  static bool is_far(const Real* shown) {
    for (int axis = 0; axis < 3; ++axis) {
      const Real& at = shown[axis * kLanes];
      if (!(at < Real(kFarthest)) || !(at > Real(-kFarthest))) return true;
    }
    return false;
  }

  Joining joining() { return {*this, choice_, steering_}; }

  void leave(const Party& party, int, const Moment<N>&) { joining().leave(party); }

  void go_on(const Party& party, int first, const Moment<N>& moment) { joining().follow(party, first, moment); }

  // Stores a new lane's first sample as its previous one, too.
  void begin_at(int block, int lane) {
    for (int k = 0; k < program_.channels; ++k) {
      previous_of(block)[k * kLanes + lane] = newest_of(block)[k * kLanes + lane];
    }
  }

  // Copies a sample by vectors, since a memcpy call would take longer.
  static void copy_sample(const Real* from, std::size_t count, Real* to) {
    for (std::size_t k = 0; k < count; k += kLanes) store(load<Reals<N>>(from + k), to + k);
  }

  // Returns a uniformly random heading: two normal deviates, normalised; no rotation if the heading is not free.
  HalfTurn<Real> random_turn(std::uint32_t a, std::uint32_t b) const {
    if (!program_.heading_free) return {Real(1.0f), Real(0.0f), Real(1.0f)};
    const Real x(normal_pair(a)[0]), y(normal_pair(b)[0]);
    const Real size = square_root(x * x + y * y);
    if (!(size > Real(1e-6f))) return {Real(1.0f), Real(0.0f), Real(1.0f)};
    return {x / size, y / size, Real(1.0f)};
  }

  ChainChoice choice_;
  ChainSteering<Real> steering_;
  std::span<std::uint8_t> stirred_;  // per block: whether a velocity change due to wind may remain
  std::span<GustLane<Real>> gusts_;
  bool steered_ = false;  // an instance is or was steered
  std::span<Real> regressors_;
  std::size_t regressor_row_ = 0;
  float ground_ = kNoGround;
};

}  // namespace wisp
