#pragma once
// From recordings of something that moves to a segment chain: cut at events, described, sorted into modes, counted,
// stored. Source: sections 2.2 and 4 of the paper.
//
// Departs from it where orientation is known and no modes are asked for: a segment is then followed by one of those
// that join it best.

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
  std::size_t segments = 0;  ///< found in the data that were learned from
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
  double log_likelihood = 0;  ///< nats a segment, of held-out mode sequences (of the learned ones where nothing was
                              ///< held out)
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

/// Fits a chain to falls, gusts apart.
/// Errors: as check_fields(), motion_of(), segment(), segment_features(), k_means(), system_segments(); stopped by
/// `progress`.
Result<ChainFit> fit_chain(std::span<const Recording> recordings, const ChainRecipe& recipe,
                           const Progress& progress = {});

}  // namespace wisp::chain
