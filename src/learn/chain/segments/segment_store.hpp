#pragma once
// Segments as a chain stores them: each in its own frame, resampled to whole steps, as scaled 16-bit numbers; and which
// segments join which.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "learn/chain/motion/motion.hpp"
#include "learn/chain/motion/segmentation.hpp"
#include "wisp/model/chain.hpp"

namespace wisp::chain {

struct SegmentStoreOptions {
  bool heading_free = true;
  std::size_t max_bytes = 4'000'000;  ///< > 0, of all segments: what is over it is left out, as many of each mode as
                                      ///< the rarer ones allow
  bool bounded_height = false;        ///< segments keep the height at which they begin, and join what ends near it
  int breadth = 0;  ///< 0 … 256: best-joining successors kept for each segment and mode; 0: any segment of the mode
                    ///< follows
};

struct SegmentStore {
  ChainSegments segments;
  std::vector<std::size_t> source;  ///< per stored segment: its index among those given
};

/// `cluster` gives each segment's mode.
///
/// Precondition: as many clusters as segments, all below `modes`, each mode with a segment; with best-joining
/// successors orientation.
SegmentStore store_segments(const Motion& motion, std::span<const Segment> segments,
                            std::span<const std::uint16_t> cluster, int modes, const SegmentStoreOptions& options);

}  // namespace wisp::chain
