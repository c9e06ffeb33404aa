#pragma once
// Joins the lanes of a ChainParty to their next segments, draws the successors of these segments, and converts between
// per-lane state and vectors. ChainJoins computes rotations, gaps and offset curves.

#include <array>
#include <cstddef>
#include <cstdint>

#include "run/chain/chain_block.hpp"
#include "run/chain/chain_choice.hpp"
#include "run/chain/chain_joins.hpp"
#include "run/chain/chain_steering.hpp"
#include "run/lanes/columns.hpp"
#include "run/state/moment.hpp"

namespace wisp {

template <class N>
class ChainJoining {
  using Mover = ChainMover<typename N::Real>;
  using Joins = ChainJoins<PartNumbers<N>>;
  using Values = typename Joins::Values;  // values of a party's members
  using Segments = typename Joins::Segments;
  using Played = typename ChainLives<N>::Played;
  using LaneNumbers = typename ChainLives<N>::LaneNumbers;

 public:
  using Real = typename N::Real;
  using Lane = ChainLane<Real>;
  using Party = ChainParty<PartNumbers<N>>;
  static constexpr int kLanes = N::kLanes;
  static constexpr int kMembers = Party::kMax;
  using Drawn = std::array<std::array<std::uint32_t, kMembers>, 4>;  ///< [word][member]

  ChainJoining(ChainLives<N>& lives, const ChainChoice& choice, ChainSteering<Real>& steering)
      : lives_(lives), choice_(choice), steering_(steering) {}

  /// Draws four random words for each member of a party. `moment` is that of block `first`; `group` as in RandomKey.
  static Drawn draw(const Party& party, int first, const Moment<N>& moment, std::uint32_t group) {
    std::array<std::uint64_t, kMembers> stream{}, born{};
    for (std::size_t k = 0; k < party.count; ++k) {
      const int at = (party.block[k] - first) * kLanes + party.lane[k];
      stream[k] = moment.counters.stream[at];
      born[k] = moment.counters.born[at];
    }
    Words<PartNumbers<N>> counters[4], words[4];
    random_counters<PartNumbers<N>>({stream.data(), born.data(), moment.counters.step}, counters);
    random_group<PartNumbers<N>>(*moment.keys, counters, group, words);
    Drawn drawn;
    for (std::size_t k = 0; k < 4; ++k) store(words[k], drawn[k].data());
    return drawn;
  }

  /// Joins lanes whose segment ends to their next segments, and draws the successors of the next segments.
  void follow(const Party& party, int first, const Moment<N>& moment) {
    for (std::size_t k = 0; k < party.count; ++k) {
      const int block = party.block[k], lane = party.lane[k];
      if (Mover::is_prepared(lives_.plan_of(block, lane))) continue;
      // A lane without a prepared join, as after place(), has not faded: the next segment takes the whole difference.
      prepare_one(block, lane, draw(Party::of(block, lane), first, moment, 2));
      ChainGap<Real>& gap = lives_.plan_of(block, lane).ahead.gap;
      each_number(gap, gap, [](Real& half, const Real&) { half = half + half; });
    }
    const ChainAhead<Values> begun = ahead_of(party);
    for (std::size_t k = 0; k < party.count; ++k) join(party.block[k], party.lane[k]);
    const Segments segments = segments_of(party);
    const ChainAhead<Values> ahead = prepare(party, segments, begun.turn, draw(party, first, moment, 0));
    if (program().blend_steps == 0) return;
    add(party, Joins(program()).meeting(segments, heights_of(party), begun.gap, ahead.gap));
  }

  /// Sets the offset curves at the end of long segments, towards the next segments.
  void leave(const Party& party) {
    add(party, Joins(program()).leaving(segments_of(party), heights_of(party), ahead_of(party).gap));
  }

  /// Draws the successor of one lane's segment, and stores the join to this successor.
  void prepare_one(int block, int lane, const Drawn& words) {
    ChainTurn<Values> turn;
    each_number(turn, lives_.played_of(block).turn,
                [&](Values& to, const LaneNumbers& all) { to = wisp::all<Values>(value_of(all[lane])); });
    const Party one = Party::of(block, lane);
    prepare(one, segments_of(one), turn, words);
  }

  /// Sets the offset curve at the beginning of one lane's segment, which fades out its difference `from` to the
  /// previous pose and, in a short segment, fades towards the next segment.
  void meet_one(int block, int lane, const ChainGap<Real>& from) {
    if (program().blend_steps == 0) return;
    const Party one = Party::of(block, lane);
    ChainGap<Values> lacking;
    each_number(lacking, from, [](Values& to, const Real& x) { to = all<Values>(value_of(x)); });
    add(one, Joins(program()).meeting(segments_of(one), heights_of(one), lacking, ahead_of(one).gap));
  }

 private:
  const ChainProgram& program() const { return lives_.program(); }

  // Places the beginning of a lane's next segment at the displayed position, with the rotation prepared for it.
  void join(int block, int lane) {
    Played& played = lives_.played_of(block);
    const ChainPlan<Real>& plan = lives_.plan_of(block, lane);
    const std::uint32_t segment = Mover::index(plan.next, program().segments() + 1) - 1;
    played.segment[lane] = Real(static_cast<float>(segment));
    played.row[lane] = Real(0.0f);
    for (int k = 0; k < 3; ++k)
      played.base[static_cast<std::size_t>(k)][lane] = lives_.newest(block)[k * kLanes + lane];
    each_number(played.turn, plan.ahead.turn, [&](LaneNumbers& all, const Real& one) { all[lane] = one; });
    lives_.note_segment(block, lane);
  }

  // Draws the successors of the lanes' segments, whose rotations are `turn`, and stores the joins to these successors.
  ChainAhead<Values> prepare(const Party& party, const Segments& segments, const ChainTurn<Values>& turn,
                             const Drawn& words) {
    const Segments next = draw_next(party, segments, words);
    const ChainAhead<Values> ahead = Joins(program()).ahead(turn, segments, next);
    put_ahead(party, ahead);
    for (std::size_t k = 0; k < party.count; ++k) {
      lives_.plan_of(party.block[k], party.lane[k]).next = Real(static_cast<float>(next[k] + 1));
    }
    return ahead;
  }

  // Draws successors: first the modes of all members, then segments of these modes, so that memory latencies overlap.
  Segments draw_next(const Party& party, const Segments& segments, const Drawn& words) {
    const Mover mover(program());
    Segments mode{}, next{};
    std::array<bool, kMembers> steered{};
    const auto words_of = [&](std::size_t k) { return ChainWords{words[0][k], words[1][k]}; };
    for (std::size_t k = 0; k < party.count; ++k) {
      const int block = party.block[k], lane = party.lane[k];
      steered[k] = is_steered(mover, block, lane);
      if (steered[k]) {
        next[k] = draw_steered(mover, block, lane, words_of(k));
      } else {
        mode[k] = mover.draw_mode(lives_.plan_of(block, lane).state, choice_, words_of(k));
      }
    }
    for (std::size_t k = 0; k < party.count; ++k) {
      if (steered[k]) continue;
      next[k] = choice_.successor(program(), segments[k], mode[k], words_of(k));
    }
    return next;
  }

  // Returns whether a lane is steered and its segment ends before the target time.
  bool is_steered(const Mover& mover, int block, int lane) {
    const Real& left = lives_.played_of(block).left[lane];
    if (program().lead.empty() || !(left > Real(0.0f))) return false;
    return left > Real(static_cast<float>(mover.steps_left(lives_.lane_of(block, lane))));
  }

  // Draws the successor of a steered lane's segment, given the pose at the end of that segment.
  std::uint32_t draw_steered(const Mover& mover, int block, int lane, const ChainWords& words) {
    Lane end = lives_.lane_of(block, lane);
    end.left = end.left - Real(static_cast<float>(mover.steps_left(end)));
    const std::uint32_t next = steering_.draw(mover, program(), choice_, end, mover.end_of(end), words);
    lives_.plan_of(block, lane).state = end.state;
    return next;
  }

  // ahead_of() and put_ahead() access the first kAheadNumbers numbers of a plan as one row.
  static_assert(offsetof(ChainPlan<float>, near) == (kAheadNumbers - 1) * sizeof(float));

  // Returns the prepared joins of the lanes. A party that is not full is filled up with its first member.
  ChainAhead<Values> ahead_of(const Party& party) {
    const Real* row[kMembers];
    for (std::size_t k = 0; k < kMembers; ++k) {
      const std::size_t member = k < party.count ? k : 0;
      row[k] = reinterpret_cast<const Real*>(&lives_.plan_of(party.block[member], party.lane[member]));
    }
    Values c[kAheadNumbers / 4][4];
    unrolled<kAheadNumbers / 4>([&](auto k) { columns_of<PartNumbers<N>>(row, 4 * k, c[k]); });
    return {{c[0][0], c[0][1], c[0][2], c[0][3], c[1][0], c[1][1]},
            {{c[1][2], c[1][3], c[2][0], c[2][1]}, {c[2][2], c[2][3], c[3][0], c[3][1]}, {c[3][2], c[3][3], c[4][0]}}};
  }

  void put_ahead(const Party& party, const ChainAhead<Values>& ahead) {
    ChainPlan<Real> none;
    Real* row[kMembers];
    for (std::size_t k = 0; k < kMembers; ++k) {
      const bool is_member = k < party.count;
      row[k] = reinterpret_cast<Real*>(is_member ? &lives_.plan_of(party.block[k], party.lane[k]) : &none);
    }
    const auto& [turn, gap] = ahead;
    rows_of<PartNumbers<N>>({turn.half_cos, turn.half_sin, turn.cos_scale, turn.sin_scale}, 0, row);
    rows_of<PartNumbers<N>>({turn.half_cos_scale, turn.half_sin_scale, gap.lean[0], gap.lean[1]}, 4, row);
    rows_of<PartNumbers<N>>({gap.lean[2], gap.lean[3], gap.lean_rate[0], gap.lean_rate[1]}, 8, row);
    rows_of<PartNumbers<N>>({gap.lean_rate[2], gap.lean_rate[3], gap.slip[0], gap.slip[1]}, 12, row);
    Real last[kMembers];  // stored singly: the next three numbers of a plan stay
    store(gap.slip[2], last);
    for (std::size_t k = 0; k < party.count; ++k) row[k][16] = last[k];
  }

  // Returns the heights of the bases of the lanes' segments.
  Values heights_of(const Party& party) {
    Real height[kMembers] = {};
    for (std::size_t k = 0; k < party.count; ++k) {
      height[k] = lives_.played_of(party.block[k]).base[2][party.lane[k]];
    }
    return load<Values>(height);
  }

  // Writes the offset curves of a party to its lanes.
  void add(const Party& party, const typename Joins::Curves& curves) {
    using Numbers = std::array<Real, kMembers>;
    struct {
      std::array<Quaternion<Numbers>, 4> lean;
      std::array<Vector3<Numbers>, 2> slip;
    } added;
    each_added(added, curves, [](Numbers& to, const Values& x) { store(x, to.data()); });
    for (std::size_t k = 0; k < party.count; ++k) {
      const int lane = party.lane[k];
      each_added(lives_.played_of(party.block[k]), added,
                 [&](LaneNumbers& to, const Numbers& all) { to[lane] = all[k]; });
    }
  }

  Segments segments_of(const Party& party) {
    Segments segments{};
    for (std::size_t k = 0; k < party.count; ++k) {
      segments[k] = lives_.segment_of(party.block[k], party.lane[k]);
    }
    return segments;
  }

  ChainLives<N>& lives_;
  const ChainChoice& choice_;
  ChainSteering<Real>& steering_;
};

}  // namespace wisp
