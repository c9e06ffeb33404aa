#pragma once
// Segments sorted into modes, by their features; as many modes as a recipe says, or as many as make held-out segments
// likeliest.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "learn/chain/segments/segment_features.hpp"
#include "learn/chain/segments/segmentation.hpp"
#include "learn/numeric/clustering.hpp"
#include "wisp/base/progress.hpp"

namespace wisp::chain {

struct SortedSegments {
  KMeans found;                        ///< of those that were learned from
  std::vector<std::uint16_t> cluster;  ///< of all segments: the nearest mode
};

/// The first `learned` segments are learned from, the others only sorted.
/// Errors: as k_means(); stopped by `progress`.
Result<SortedSegments> sorted_segments(const FeatureTable& table, std::size_t learned,
                                       std::span<const Segment> segments, const ChainRecipe& recipe,
                                       const Progress& progress);

}  // namespace wisp::chain
