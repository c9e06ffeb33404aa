#pragma once
// Which mode goes on from where a segment ends. Modes are few, and segments of one mode end in many ways: a mode that
// the history alone draws often has no segment that begins as this one ends. What was recorded nearby knows better.

#include <cstdint>
#include <span>
#include <vector>

#include "learn/chain/segments/segment_moments.hpp"

namespace wisp::chain {

struct SuccessorModes {
  std::vector<std::uint16_t> share;  ///< as ChainSegments::successor_weights
  std::vector<double> chances;       ///< segments × modes: how likely a walk of order one goes on with each mode
};

/// For the `kept` ones of all recorded segments, each of which has a mode and stands for `weight` of them: of the
/// recorded segments that begin most as a kept one ends, how many are of each mode. `transitions`: modes × modes, of
/// the recording.
SuccessorModes successor_modes(const SegmentMoments& recorded, std::span<const std::uint16_t> mode,
                               std::span<const double> weight, std::span<const std::size_t> kept,
                               std::span<const double> transitions, int modes);

}  // namespace wisp::chain
