#pragma once
// Histories whose samples are a model's channels: outputs, then regressors.

#include "run/channels.hpp"
#include "run/sample_ring.hpp"

namespace wisp {

/// Puts one lane's history to the operating point.
template <class N>
void start_history(SampleRing<N>& ring, const Channels& channels, int block, int lane) {
  using Real = typename N::Real;
  for (int lag = 0; lag < ring.depth(); ++lag) {
    Real* value = ring.sample(block, static_cast<std::uint32_t>(lag)) + lane;
    for (const OutputChannel& channel : channels.outputs) {
      *value = Real(channel.start);
      value += N::kLanes;
    }
    for (std::size_t k = 0; k < channels.regressors.size(); ++k) value[k * N::kLanes] = Real(0);
  }
}

/// Calls visit(value, low, high) for each number of one lane's history, newest first, in an order that does not depend
/// on where in the ring it lies.
template <class N, class Visit>
void visit_history(SampleRing<N>& ring, const Channels& channels, int block, int lane, Visit visit) {
  for (int lag = 0; lag < ring.depth(); ++lag) {
    auto* value = ring.sample(block, static_cast<std::uint32_t>(lag)) + lane;
    for (const OutputChannel& channel : channels.outputs) {
      visit(*value, channel.low, channel.high);
      value += N::kLanes;
    }
    for (const RegressorChannel& channel : channels.regressors) {
      visit(*value, channel.least, channel.most);
      value += N::kLanes;
    }
  }
}

}  // namespace wisp
