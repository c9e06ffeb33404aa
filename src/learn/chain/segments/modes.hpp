#pragma once
// The modes of the paper: segments in clusters, and how often each mode follows the one or two before it.
//
// Source: sections 2.2 and 4.1.3 of the paper.

#include <cstdint>
#include <span>
#include <vector>

#include "learn/chain/segments/segment_features.hpp"
#include "wisp/base/result.hpp"

namespace wisp::chain {

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
