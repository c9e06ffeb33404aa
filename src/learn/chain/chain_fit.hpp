#pragma once
// Learns a segment chain from recorded motion: cuts it into segments at events, clusters them into modes, counts the
// modes' transitions and stores the segments. Source: L.-M. Reissell and D. K. Pai (2001), sections 2.2 and 4.
//
// Departure if orientation is known and no modes are requested: a segment is followed by one of the best-joining ones.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "wisp/base/progress.hpp"
#include "wisp/base/result.hpp"
#include "wisp/learn/chain_recipe.hpp"
#include "wisp/model/model.hpp"
#include "wisp/record/recording.hpp"

namespace wisp::chain {

struct ChainSummary {
  std::size_t segments = 0;  ///< number of segments in the training data
  std::size_t stored = 0;
  std::size_t stretches_learned = 0;
  std::size_t stretches_held_out = 0;
  int modes = 0;
  std::vector<std::size_t> mode_sizes;
  int history = 0;
  std::vector<double> initial;
  std::vector<double> transitions;  ///< modes × modes
  double mean_segment_seconds = 0;
  double silhouette = 0;
  double log_likelihood = 0;  ///< nats per segment, of held-out mode sequences (without any, of the learned ones)
  std::vector<std::string> warnings;
};

struct ChainFit {
  Model model;
  ChainSummary summary;
  std::vector<Recording> learned;     ///< stretches learned from
  std::vector<Recording> held_out;    ///< stretches held out
  std::vector<std::uint64_t> origin;  ///< per stored segment: its index among all segments, with indices
                                      ///< skipped between stretches: n + 1 continues n in the recording
};

/// Fits a chain to falls. Gusts are learned separately. Errors: as check_fields(), motion_of(), segment(), k_means(),
/// system_segments(), half_segments(); fewer segments than modes; kStopped.
Result<ChainFit> fit_chain(std::span<const Recording> recordings, const ChainRecipe& recipe,
                           const Progress& progress = {});

}  // namespace wisp::chain
