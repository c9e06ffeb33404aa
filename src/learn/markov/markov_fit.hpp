#pragma once
// Estimation of Markov-switched ARX models by expectation–maximisation.
//
// Sources: L. E. Baum et al. (1970); J. D. Hamilton, Econometrica 57 (1989). Departures: several starts, of which the
// likeliest is taken; a mode's residuals are at least a hundredth of a single ARX model's, so that no mode shrinks onto
// a few rows; an unstable mode is made stable.

#include <span>
#include <string>
#include <vector>

#include "learn/arx/rows/arx_rows.hpp"
#include "wisp/base/progress.hpp"
#include "wisp/base/result.hpp"
#include "wisp/model/model.hpp"
#include "wisp/record/recording.hpp"

namespace wisp::markov {

struct FitOptions {
  ArxOrders orders{};  ///< of every mode
  int modes = 0;       ///< 1 to kMaxArxModes; 0: the number, up to 6, that does best on held-out rows
  std::uint64_t seed = 1;
};

/// A number of modes that was tried. Likelihoods are mean natural logarithms a row, in the outputs' units.
struct Candidate {
  int modes = 1;
  double log_likelihood = 0;           ///< of the rows learned from
  double held_out_log_likelihood = 0;  ///< of the held-out rows: the last 30 % of every stretch
  double gain_std_error = 0;           ///< of its held-out gain over the candidate before it, from row to row
  bool determined = true;              ///< false: a mode had fewer rows than it needs
};

struct Summary {
  std::size_t samples_used = 0;  ///< by the model that is returned, which is learned from all rows
  std::size_t held_out = 0;
  std::vector<Candidate> candidates;  ///< a single mode first
  std::vector<std::size_t> mode_rows;
  std::vector<bool> mode_changed;            ///< whether a mode was made stable
  std::vector<double> fit_percent;           ///< one step ahead, per output
  std::vector<double> free_run_fit_percent;  ///< from the input alone; empty without inputs
  Usable usable;
};

struct Fitted {
  SwitchedArxModel model;
  Summary summary;
};

/// Fits all episodes of all recordings together. Modes are ordered by how often they act, most often first. A fit that
/// cannot be trusted, or that a single ARX model equals, has `usable.verdict` false and the reason.
/// Errors: no recordings, a channel that a recording does not have, orders of the wrong shape, rates that differ,
/// infinite samples, too few rows for the modes; kStopped.
Result<Fitted> fit(std::span<const Recording> recordings, const ChannelChoice& channels, const FitOptions& options,
                   const Progress& progress = {});

}  // namespace wisp::markov
