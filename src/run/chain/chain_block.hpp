#pragma once
// ChainBlock: the part of a step that is the same for all falling lanes of a block, computed in parallel: it advances
// each lane in its segment, updates its offset and displays its pose. ChainLives: the state of all blocks. Numbers that
// every step needs are stored as [block][number][lane]; those of joins, ground and steering (ChainPlan) lane by lane.

#include <array>
#include <cstdint>
#include <span>
#include <utility>

#include "run/chain/chain_lane.hpp"
#include "run/chain/chain_program.hpp"
#include "run/lanes/columns.hpp"
#include "run/state/arena.hpp"

namespace wisp {

/// Effects of a step on each lane of a block, as masks of 1 or 0. Uninitialised, since a step has kGroup of them.
template <class N>
struct ChainCourse {
  using Real = typename N::Real;
  using Mask = Real[N::kLanes];

  void use(int lanes) {
    for (int lane = 0; lane < N::kLanes; ++lane) used[lane] = Real(lane < lanes ? 1.0f : 0.0f);
  }

  Mask used;
  Mask shown;   ///< the lane falls: its displayed pose is recomputed
  Mask ends;    ///< the lane's segment ends
  Mask begins;  ///< the offset curve towards the next segment begins
  Mask moved;   ///< the lane has an offset, which changes
  Mask turned;  ///< the latter half of the offset curve begins
  Mask faded;   ///< the displayed pose has an offset
  const std::int16_t* row[N::kLanes];
};

template <class N>
inline bool any_lane(const typename N::Real (&mask)[N::kLanes]) {
  return any(bits_of(load<Reals<N>>(mask)));
}

/// Rows of the lanes' segments at which offsets change (ChainMover::Rows), derived from the played state.
template <class N>
struct ChainSegmentRows {
  using Real = typename N::Real;
  using LaneNumbers = std::array<Real, N::kLanes>;

  std::array<std::uint32_t, N::kLanes> first_row{};
  LaneNumbers steps{}, quiet_from{}, quiet_to{}, turn{}, last_turn{}, curve{};

  void note(int lane, const ChainProgram& program, std::uint32_t segment) {
    const auto rows = ChainMover<Real>(program).rows_of(segment);
    first_row[lane] = program.first_row[segment];
    steps[lane] = Real(rows.steps);
    quiet_from[lane] = Real(rows.quiet_from);
    quiet_to[lane] = Real(rows.quiet_to);
    turn[lane] = Real(rows.turn);
    last_turn[lane] = Real(rows.last_turn);
    curve[lane] = Real(rows.curve);
  }
};

/// Advances and displays one block. `newest`: the block's displayed poses, [channel][lane].
template <class N>
class ChainBlock {
 public:
  using Real = typename N::Real;
  static constexpr int kLanes = N::kLanes;
  using LaneNumbers = std::array<Real, kLanes>;

  ChainBlock(const ChainProgram& program, ChainPlayed<LaneNumbers>& played, const ChainSegmentRows<N>& segments,
             Real* newest)
      : program_(program), played_(played), segments_(segments), newest_(newest) {}

  /// Advances the falling lanes of a block by one row; resting and empty lanes stay.
  void go(ChainCourse<N>& course) {
    const auto zero = all<Reals<N>>(0.0f), row = number(played_.row);
    const auto next = smaller(next_of(row), number(segments_.steps));
    const auto below = [](const auto& x, const auto& y, const auto& yes, const auto& no) { return x < y ? yes : no; };
    const auto outside = [](const auto& x, const auto& low, const auto& high, const auto& yes, const auto& no) {
      return x < low ? yes : x > high ? yes : no;
    };
    const auto same = [](const auto& x, const auto& y, const auto& yes, const auto& no) { return x == y ? yes : no; };
    const auto shown = each(below, number(played_.settled), zero, load<Reals<N>>(course.used), zero);
    const auto quiet_from = number(segments_.quiet_from), quiet_to = number(segments_.quiet_to);
    const auto faded = each(outside, next, quiet_from, quiet_to, shown, zero);
    const auto moved = chosen(faded, shown, each(outside, row, quiet_from, quiet_to, shown, zero));
    const auto turned =
        each(same, next, number(segments_.turn), moved, each(same, next, number(segments_.last_turn), moved, zero));
    store(shown, course.shown);
    store(faded, course.faded);
    store(moved, course.moved);
    store(turned, course.turned);
    store(each(below, next, number(segments_.steps), zero, shown), course.ends);
    store(each(same, row, number(segments_.curve), shown, zero), course.begins);
    const auto at = chosen(shown, next, row);
    store(at, played_.row.data());
    find_rows(at, course);
    const auto left = number(played_.left), steered = chosen(left, shown, zero);
    if (!any(bits_of(steered))) return;
    store(chosen(steered, left - all<Reals<N>>(1.0f), left), played_.left.data());
  }

  /// Advances the offsets of the lanes by one step.
  void move(const ChainCourse<N>& course) {
    if (!any_lane<N>(course.moved)) return;
    const auto moved = load<Reals<N>>(course.moved), turned = load<Reals<N>>(course.turned);
    const auto add = [&](LaneNumbers& to, const LaneNumbers& more) {
      const auto before = load<Reals<N>>(to.data());
      store(chosen(moved, before + load<Reals<N>>(more.data()), before), to.data());
    };
    for (std::size_t axis = 0; axis < 3; ++axis) {
      add(played_.base[axis], played_.slip[0][axis]);
      add(played_.slip[0][axis], played_.slip[1][axis]);
    }
    if (program_.channels < 7) return;
    for (std::size_t k = 0; k < 4; ++k) {
      add(played_.lean[0][k], played_.lean[1][k]);
      const auto bend = load<Reals<N>>(played_.lean[2][k].data());
      store(chosen(turned, load<Reals<N>>(played_.lean[3][k].data()), bend), played_.lean[2][k].data());
      add(played_.lean[1][k], played_.lean[2][k]);
    }
  }

  void show_only(int lane) {
    const float row = value_of(played_.row[lane]);
    const bool faded = row < value_of(segments_.quiet_from[lane]) || row > value_of(segments_.quiet_to[lane]);
    ChainCourse<N> course{};
    course.shown[lane] = Real(1.0f);
    course.faded[lane] = Real(faded ? 1.0f : 0.0f);
    find_rows(number(played_.row), course);
    show(course);
  }

  /// Displays the falling lanes: position, then, for poses, orientation.
  void show(const ChainCourse<N>& course) {
    Reals<N> stored[kRowReach];
    columns_of<N>(course.row, stored);
    const auto shown = load<Reals<N>>(course.shown);
    const auto put = [&](int channel, const Reals<N>& value) {
      Real* out = newest_ + channel * kLanes;
      store(chosen(shown, value, load<Reals<N>>(out)), out);
    };
    const auto cos = number(played_.turn.cos_scale), sin = number(played_.turn.sin_scale);
    const auto scale = all<Reals<N>>(program_.position_scale);
    const auto most = all<Reals<N>>(kFarthest), least = all<Reals<N>>(-kFarthest);
    put(0, hold(number(played_.base[0]) + (cos * stored[0] - sin * stored[1]), least, most));
    put(1, hold(number(played_.base[1]) + (sin * stored[0] + cos * stored[1]), least, most));
    put(2, hold(number(played_.base[2]) + scale * stored[2], least, most));
    if (program_.channels < 7) return;
    auto q = turned<Reals<N>>(number(played_.turn.half_cos_scale), number(played_.turn.half_sin_scale),
                              {stored[3], stored[4], stored[5], stored[6]});
    if (any_lane<N>(course.faded)) {
      const auto faded = load<Reals<N>>(course.faded);
      const auto& lean = played_.lean[0];
      const auto met =
          unit_lanes(added<Reals<N>>(q, {number(lean[0]), number(lean[1]), number(lean[2]), number(lean[3])}));
      for (std::size_t k = 0; k < 4; ++k) q[k] = chosen(faded, met[k], q[k]);
    }
    for (int k = 0; k < 4; ++k) put(3 + k, q[static_cast<std::size_t>(k)]);
  }

 private:
  static Reals<N> number(const LaneNumbers& numbers) { return load<Reals<N>>(numbers.data()); }

  // Finds the stored rows of the lanes. Row numbers of a manipulated saved bank may be too large, so they are clamped.
  void find_rows(const Reals<N>& at, ChainCourse<N>& course) const {
    typename N::Word own[kLanes];
    store(whole(smaller(at, number(segments_.steps))), own);
    for (int lane = 0; lane < kLanes; ++lane) {
      const std::size_t row = segments_.first_row[lane] + value_of(own[lane]);
      course.row[lane] = program_.rows.data() + row * static_cast<std::uint32_t>(program_.channels);
    }
  }

  // Normalises one quaternion per lane, as unit() in rigid.hpp does.
  static Quaternion<Reals<N>> unit_lanes(const Quaternion<Reals<N>>& q) {
    const auto square = dot(q, q), one = all<Reals<N>>(1.0f);
    const auto inverse = one / square_root(square), least = all<Reals<N>>(1e-30f);
    const auto factor =
        each([](const auto& x, const auto& bound, const auto& yes, const auto& no) { return x > bound ? yes : no; },
             square, least, inverse, one);
    return scaled(q, factor);
  }

  const ChainProgram& program_;
  ChainPlayed<LaneNumbers>& played_;
  const ChainSegmentRows<N>& segments_;
  Real* newest_;
};

template <class N>
class ChainLives {
 public:
  using Real = typename N::Real;
  using Lane = ChainLane<Real>;
  static constexpr int kLanes = N::kLanes;
  using LaneNumbers = std::array<Real, kLanes>;
  using Played = ChainPlayed<LaneNumbers>;

  ChainLives(ChainProgram program, int blocks, Arena& arena) : program_(std::move(program)) {
    const auto lanes = static_cast<std::size_t>(blocks) * kLanes;
    played_ = arena.take<Played>(static_cast<std::size_t>(blocks));
    segments_ = arena.take<ChainSegmentRows<N>>(static_cast<std::size_t>(blocks));
    plans_ = arena.take<ChainPlan<Real>>(lanes);
    newest_ = arena.take<Real>(lanes * static_cast<std::size_t>(program_.channels));
    previous_ = arena.take<Real>(lanes * static_cast<std::size_t>(program_.channels));
  }

  const ChainProgram& program() const { return program_; }

  /// Return the outputs of the last step, and of the step before: [output][lane].
  const Real* newest(int block) const { return newest_.data() + block * sample_size(); }
  const Real* previous(int block) const { return previous_.data() + block * sample_size(); }

  Real* newest_of(int block) { return newest_.data() + block * sample_size(); }
  Real* previous_of(int block) { return previous_.data() + block * sample_size(); }
  std::size_t sample_size() const { return static_cast<std::size_t>(program_.channels) * kLanes; }

  Played& played_of(int block) { return played_[static_cast<std::size_t>(block)]; }
  const Played& played_of(int block) const { return played_[static_cast<std::size_t>(block)]; }
  ChainPlan<Real>& plan_of(int block, int lane) { return plans_[static_cast<std::size_t>(block) * kLanes + lane]; }
  ChainBlock<N> lanes_of(int block) {
    return {program_, played_of(block), segments_[static_cast<std::size_t>(block)], newest_of(block)};
  }

  /// Read the state of one lane from its block, and write it back.
  Lane lane_of(int block, int lane) {
    Lane life;
    static_cast<ChainPlan<Real>&>(life) = plan_of(block, lane);
    each_played(life, played_of(block), [&](Real& one, const LaneNumbers& all) { one = all[lane]; });
    return life;
  }
  void put(int block, int lane, const Lane& life) {
    plan_of(block, lane) = life;
    each_played(played_of(block), life, [&](LaneNumbers& all, const Real& one) { all[lane] = one; });
    note_segment(block, lane);
  }

  bool falls(int block, int lane) const { return played_of(block).settled[lane] < Real(0.0f); }
  std::uint32_t segment_of(int block, int lane) const {
    return ChainMover<Real>::index(played_of(block).segment[lane], program_.segments());
  }

  /// Records the rows at which the offset of a lane's segment changes.
  void note_segment(int block, int lane) {
    segments_[static_cast<std::size_t>(block)].note(lane, program_, segment_of(block, lane));
  }

 protected:
  ChainProgram program_;

 private:
  std::span<Played> played_;                 // per block
  std::span<ChainSegmentRows<N>> segments_;  // per block
  std::span<ChainPlan<Real>> plans_;         // per lane
  std::span<Real> newest_;
  std::span<Real> previous_;
};

}  // namespace wisp
