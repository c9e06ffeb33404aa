#pragma once
// Common part of the ARX steppers: histories of a model's channels (outputs, then regressors), and reading of outputs.

#include <cstdint>

#include "run/state/channels.hpp"
#include "run/state/sample_ring.hpp"

namespace wisp {

/// Base of a stepper, which adds the computation of the newest sample.
template <class N>
class ChannelHistory {
 public:
  using Real = typename N::Real;
  static constexpr int kLanes = N::kLanes;

  /// `program` gives the depth and the number of channels. While the arena measures, histories are empty.
  template <class Program>
  ChannelHistory(const Program& program, const Channels& channels, int blocks, Arena& arena)
      : channels_(channels), ring_(blocks, program.depth, program.outputs + program.regressors, arena) {}

  void turn(int samples = 1) { ring_.turn(samples); }

  /// Returns whether blocks should be prefetched before they are stepped: true if the ring exceeds kNearBytes in total.
  bool is_far() const { return ring_.bytes() > kNearBytes; }
  void fetch(int block) const { ring_.fetch(block); }

  /// Returns the address of the step's regressors: [regressor][lane].
  Real* regressors(int block) { return ring_.sample(block, 0) + channels_.outputs.size() * kLanes; }

  /// Return the outputs of the last step, and of the step before: [output][lane].
  const Real* newest(int block) const { return ring_.sample(block, 0); }
  const Real* previous(int block) const { return ring_.sample(block, 1); }

  /// Reads the outputs of kBlocks consecutive blocks: the newest, or interpolated by `share` from the samples before.
  template <int kBlocks = 1>
  void show(int block, Real* out) const {
    const BlockPlaces<const Real, kBlocks> to(newest(block), ring_.stride());
    show_blocks<N, kBlocks>(channels_.outputs, out,
                            [&](std::size_t after, int i) { return load_part<N>(to, after, i); });
  }
  template <int kBlocks = 1>
  void show_between(int block, float share, Real* out) const {
    const BlockPlaces<const Real, kBlocks> from(previous(block), ring_.stride()), to(newest(block), ring_.stride());
    show_blocks<N, kBlocks>(channels_.outputs, out, [&](std::size_t after, int i) {
      const auto before = load_part<N>(from, after, i);
      return before + all<std::remove_const_t<decltype(before)>>(share) * (load_part<N>(to, after, i) - before);
    });
  }

  /// Reads a frame whose cost is counted: half-way between two steps, since games have frame rates of their own.
  void show_frame(int block, Real* out) const { show_between(block, 0.5f, out); }

 protected:
  static constexpr std::size_t kNearBytes = std::size_t{1} << 20;

  /// Sets one lane's history to the operating point.
  void start_history(int block, int lane) {
    for (int lag = 0; lag < ring_.depth(); ++lag) {
      Real* value = ring_.sample(block, static_cast<std::uint32_t>(lag)) + lane;
      for (const OutputChannel& channel : channels_.outputs) {
        *value = Real(channel.start);
        value += kLanes;
      }
      for (std::size_t k = 0; k < channels_.regressors.size(); ++k) value[k * kLanes] = Real(0);
    }
  }

  /// Returns the number of state variables in one lane's history.
  std::size_t history_values() const {
    return static_cast<std::size_t>(ring_.depth()) * (channels_.outputs.size() + channels_.regressors.size());
  }

  /// Calls visit(value, low, high) for each number of a lane's history, newest first, whatever the ring's position.
  template <class Visit>
  void visit_history(int block, int lane, Visit visit) {
    for (int lag = 0; lag < ring_.depth(); ++lag) {
      Real* value = ring_.sample(block, static_cast<std::uint32_t>(lag)) + lane;
      for (const OutputChannel& channel : channels_.outputs) {
        visit(*value, channel.low, channel.high);
        value += kLanes;
      }
      for (const RegressorChannel& channel : channels_.regressors) {
        visit(*value, channel.least, channel.most);
        value += kLanes;
      }
    }
  }

  Channels channels_;
  SampleRing<N> ring_;
};

}  // namespace wisp
