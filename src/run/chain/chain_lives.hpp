#pragma once
// The lanes of all blocks of a chain: played and displayed state, [block][number][lane], and the state of joins, ground
// and steering, lane by lane.

#include <array>
#include <cstdint>
#include <span>
#include <utility>

#include "run/chain/chain_block.hpp"
#include "run/chain/chain_lane.hpp"
#include "run/chain/chain_program.hpp"
#include "run/state/arena.hpp"

namespace wisp {

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

  /// Returns the outputs of the last step, and of the one before: [output][lane].
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

  /// Gathers the state of one lane from its block, or scatters it back.
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
