#pragma once
// From recordings of something that moves to a segment chain: cut at events, described, sorted into modes, counted,
// stored. Source: sections 2.2 and 4 of the paper.
//
// Departs from it where data are stored (as many segments as fit, each with those that join it best) and in the
// chain's order, which may vary.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "wisp/base/result.hpp"
#include "wisp/learn/realisation.hpp"
#include "wisp/learn/segment_features.hpp"
#include "wisp/learn/segment_store.hpp"
#include "wisp/learn/segmentation.hpp"
#include "wisp/model/model.hpp"
#include "wisp/record/recording.hpp"

namespace wisp {

struct ChainOptions {
  std::string name = "chain";
  SegmentationOptions segmentation{};
  FeatureChoice features{};
  int modes = 6;    ///< ≥ 1; 0: as many as tell unseen recordings best, 2 … 12
  int history = 0;  ///< of the chain; 0: variable order with back-off, as long as unseen recordings profit
  Realisation realisation = Realisation::kSegments;
  SegmentStoreOptions store{};
  double blend_share = 0.5;  ///< of a segment that a join may fade over, 0 … 0.5; 0 leaves joins as they are
  double holdout = 0.2;      ///< share of the stretches, the last ones, kept from learning; 0 … 0.9
  int restarts = 10;         ///< of k-means
  int smooth_rows = 0;       ///< as motion_of()
  double half_width = 0;     ///< metres of the body along its first axis, for who draws it; 0: not known
  double half_length = 0;    ///< and along its second
  std::uint64_t seed = 1;
};

struct ChainSummary {
  std::size_t segments = 0;  ///< found in the data that were learned from
  std::size_t stored = 0;
  std::size_t stretches_learned = 0;
  std::size_t stretches_held_out = 0;
  int modes = 0;
  int kinds = 0;  ///< of segment that the chain walks over: the modes, or what they are split into
  std::vector<std::size_t> mode_sizes;
  int history = 0;
  std::vector<double> initial;
  std::vector<double> transitions;  ///< modes × modes
  std::vector<std::size_t> counts;  ///< the same, as seen
  double mean_segment_seconds = 0;
  double silhouette = 0;
  double log_likelihood = 0;    ///< nats a segment, of held-out mode sequences (of the learned ones where
                                ///< nothing was held out)
  double log_likelihood_1 = 0;  ///< the same of orders 1 and 2 without back-off
  double log_likelihood_2 = 0;
  double log_likelihood_0 = 0;  ///< of modes drawn without history
  std::vector<std::string> warnings;
};

struct ChainFit {
  Model model;
  ChainSummary summary;
  std::vector<Recording> learned;     ///< the stretches that were learned from,
  std::vector<Recording> held_out;    ///< and those that were not
  std::vector<std::uint64_t> origin;  ///< per stored segment: its place among all segments, with a gap between
                                      ///< stretches; two in sequence are each other's continuation
};

/// Errors: as motion_of(), segment(), segment_features(), k_means(); modes or an option out of range.
Result<ChainFit> learn_chain(std::span<const Recording> recordings, const ChainOptions& options);

/// The recordings' episodes, each a recording of its own.
std::vector<Recording> single_episodes(std::span<const Recording> recordings);

}  // namespace wisp
