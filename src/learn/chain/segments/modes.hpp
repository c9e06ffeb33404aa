#pragma once
// The modes of the paper: segments in clusters, and how often each mode follows the one or two before it.
//
// Source: sections 2.2 and 4.1.3 of the paper.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "learn/chain/motion/motion.hpp"
#include "learn/chain/motion/segmentation.hpp"
#include "wisp/base/result.hpp"

namespace wisp::chain {

struct FeatureTable {
  std::size_t features = 0;
  std::vector<double> values;  ///< segments × features, row-major, each feature standardised: mean 0, deviation 1

  std::size_t rows() const { return features == 0 ? 0 : values.size() / features; }
};

/// Direction over ground of the line between a segment's ends, as an angle from x; 0 where it has none.
double heading_of(const Motion& motion, const Segment& segment);

/// The rows of one segment, from whole row to whole row, as a piece of motion of its own, which begins at the origin
/// and, where heading is free, leads along x.
MotionPiece cut_out(const Motion& motion, const Segment& segment, bool heading_free);

/// Vectors are seen along the segment's own direction over ground where heading is free. A feature that does not vary
/// is 0.
FeatureTable segment_features(const Motion& motion, std::span<const Segment> segments, bool heading_free);

struct Modes {
  int count = 1;
  std::vector<std::uint16_t> of;   ///< per segment
  std::vector<std::size_t> sizes;  ///< per mode, of the segments that were learned from
  double silhouette = 0;           ///< −1 … 1, high where modes are tight and apart
};

/// Sorts segments into modes by k-means of the first `learned` of them; the others join the nearest centroid.
/// Errors: as k_means().
Result<Modes> sorted_into_modes(const FeatureTable& table, std::size_t learned, int modes, std::uint64_t seed);

/// Sequences of modes, one a stretch of segments that follow each other.
using ModeSequences = std::vector<std::vector<std::uint16_t>>;

struct ModeChain {
  int history = 1;
  std::vector<double> initial;        ///< as ChainModel::initial
  std::vector<double> probabilities;  ///< as ChainModel::probabilities
};

/// Counts what follows each mode, or each two. What was never followed goes on as the last mode of it, or as modes do
/// on the whole, so that no walk is stranded.
///
/// Precondition: all modes are below `modes`, and there is at least one; history is 1 or 2.
ModeChain counted_chain(const ModeSequences& sequences, int modes, int history);

/// Mean natural logarithm of the probability that the chain gives each mode of the sequences that has one before it:
/// −ln(modes) for a chain that knows nothing. A probability of 0 counts as 1e-6. NaN where there is no transition.
double log_likelihood(const ModeChain& chain, const ModeSequences& sequences);

}  // namespace wisp::chain
