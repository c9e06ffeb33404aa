#pragma once
// Segments as a chain stores them: each in its own frame, resampled to whole steps, as scaled 16-bit numbers, with the
// successors that join it best.

#include <cstddef>
#include <vector>

#include "learn/chain/segments/modes.hpp"
#include "wisp/model/chain.hpp"

namespace wisp::chain {

struct SegmentStoreOptions {
  bool heading_free = true;
  std::size_t max_bytes = 4'000'000;  ///< > 0, of all segments: excess segments are dropped, from the most frequent
                                      ///< modes first
  bool bounded_height = false;        ///< segments keep their initial height and join others at a similar one
  int breadth = 0;  ///< 0 … 256: number of best-joining successors per segment and mode; 0: any segment of the mode may
                    ///< follow
};

struct SegmentStore {
  ChainSegments segments;
  std::vector<std::size_t> source;  ///< per stored segment: its index among the given ones
};

/// Stores segments.
///
/// Preconditions: each mode has a segment; orientation where breadth > 0.
SegmentStore store_segments(const SortedSegments& found, const SegmentStoreOptions& options);

}  // namespace wisp::chain
