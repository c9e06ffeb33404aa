#pragma once
// Modes of a chain: clusters of segments, transition probabilities given the one or two modes before, realisations
// (realisations.cpp), and segments as a chain stores them (segment_store.cpp).
//
// Source: L.-M. Reissell and D. K. Pai (2001), sections 2.2 and 4.1.3. Section 2.2 names splines, linear systems,
// differential equations and chains besides segments as realisations. Learning converts each into segments, so that a
// model stores and plays segments only: each in its own frame, cut at whole rows, as scaled 16-bit numbers, with the
// successors that join it best.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "learn/chain/motion/motion.hpp"
#include "learn/chain/motion/segmentation.hpp"
#include "wisp/base/result.hpp"
#include "wisp/model/chain.hpp"

namespace wisp::chain {

struct FeatureTable {
  std::size_t features = 0;
  std::vector<double> values;  ///< segments × features, row-major, each feature standardised: mean 0, deviation 1

  std::size_t rows() const { return features == 0 ? 0 : values.size() / features; }
};

/// One segment's whole rows as a piece of motion that begins at the origin and, where heading is free, leads along x.
MotionPiece cut_out(const Motion& motion, const Segment& segment, bool heading_free);

/// Features of segments. Where heading is free, vectors are relative to the direction over ground. Constant ones are 0.
FeatureTable segment_features(const Motion& motion, std::span<const Segment> segments, bool heading_free);

struct Modes {
  int count = 1;
  std::vector<std::uint16_t> of;   ///< mode of each segment
  std::vector<std::size_t> sizes;  ///< number of training segments per mode
  double silhouette = 0;           ///< −1 … 1, high for compact, well-separated modes
};

/// Clusters the first `learned` segments by k-means; the others go to the nearest centroid. Errors: as k_means().
Result<Modes> sorted_into_modes(const FeatureTable& table, std::size_t learned, int modes, std::uint64_t seed);

/// Sequences of modes, one per stretch of consecutive segments.
using ModeSequences = std::vector<std::vector<std::uint16_t>>;

struct ModeChain {
  int history = 1;
  std::vector<double> initial;        ///< as in ChainModel::initial
  std::vector<double> probabilities;  ///< as in ChainModel::probabilities
};

/// Counts transitions from each mode, or each pair of modes. A pair that was never followed takes the probabilities of
/// its last mode, and a mode that was never followed the overall frequencies, so every walk can continue. Precondition:
/// modes >= 1, every mode of the sequences is below `modes`; history is 1 or 2.
ModeChain counted_chain(const ModeSequences& sequences, int modes, int history);

/// Mean natural log probability of the sequences' transitions under the chain: −ln(modes) for a uniform chain. A
/// probability of 0 counts as 1e-6. NaN without transitions.
double log_likelihood(const ModeChain& chain, const ModeSequences& sequences);

struct SortedSegments {
  const Motion& motion;
  std::span<const Segment> segments;
  std::span<const std::uint16_t> mode;
  int modes;
};

/// Segments, modes and motion after a realisation replaced the recorded segments.
struct RealisedSegments {
  Motion motion;
  std::vector<Segment> segments;
  std::vector<std::uint16_t> mode;
  int modes = 0;
};

/// Each segment as a cubic B-spline: its mode's mean plus its projection on the mode's 12 largest principal components.
RealisedSegments spline_segments(const SortedSegments& from, bool heading_free);

/// Segments simulated by a system of each mode, from the recorded initial states and for the recorded durations:
/// velocities in body axes follow a linear system with noise (degree 1) or a quadratic one without (degree 2).
/// Errors: motion without orientation, a mode with fewer rows than a fit needs.
Result<RealisedSegments> system_segments(const SortedSegments& from, int degree, std::uint64_t seed);

/// Splits segments into halves, and clusters the first and the second halves of each mode into two modes each: a mode
/// becomes a chain of four. Errors: more than 64 modes in total; as k_means().
Result<RealisedSegments> half_segments(const SortedSegments& from, bool heading_free, std::uint64_t seed);

struct SegmentStoreOptions {
  bool heading_free = true;
  std::size_t max_bytes = 4'000'000;  ///< > 0, maximum size of all segments: excess is dropped from the largest modes
  bool bounded_height = false;        ///< segments keep their initial height and join others at a similar one
  int breadth = 0;  ///< 0 … 256: number of best-joining successors per segment and mode; 0: any segment of the mode may
                    ///< follow
};

struct SegmentStore {
  ChainSegments segments;
  std::vector<std::size_t> source;  ///< per stored segment: its index among the given ones
};

/// Stores segments as 16-bit numbers. Precondition: each mode has a segment.
SegmentStore store_segments(const SortedSegments& found, const SegmentStoreOptions& options);

}  // namespace wisp::chain
