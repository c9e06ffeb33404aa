#pragma once
// Estimation of Markov-switched ARX models by expectation–maximisation.
//
// Sources: L. E. Baum et al. (1970); J. D. Hamilton, Econometrica 57 (1989). Departures: several starts, of which the
// likeliest is taken; a mode's residuals are at least 1 % of a single ARX model's, so that no mode collapses onto a few
// rows; an unstable mode is stabilised.

#include <span>
#include <string>
#include <vector>

#include "learn/rows/arx_rows.hpp"
#include "wisp/base/progress.hpp"
#include "wisp/base/result.hpp"
#include "wisp/model/model.hpp"
#include "wisp/record/recording.hpp"

namespace wisp::markov {

struct FitOptions {
  ArxOrders orders{};  ///< orders of every mode
  int modes = 0;       ///< 1 to kMaxArxModes; 0: the number, up to 6, with the best held-out likelihood
  std::uint64_t seed = 1;
};

/// A number of modes that was tried. Likelihoods are mean natural logarithms per row, in the outputs' units.
struct Candidate {
  int modes = 1;
  double log_likelihood = 0;           ///< of the training rows
  double held_out_log_likelihood = 0;  ///< of the held-out rows, the last 30 % of every stretch
  double gain_std_error = 0;           ///< standard error of its held-out gain over the candidate before it
  bool determined = true;              ///< false: a mode had too few rows for its coefficients
};

struct Summary {
  std::size_t samples_used = 0;  ///< number of rows of the returned model, which is learned from all rows
  std::size_t held_out = 0;
  std::vector<Candidate> candidates;  ///< begins with a single mode
  std::vector<std::size_t> mode_rows;
  std::vector<bool> mode_changed;            ///< whether each mode was stabilised
  std::vector<double> fit_percent;           ///< 100(1 − ‖y − ŷ‖/‖y − ȳ‖) one step ahead, per output
  std::vector<double> free_run_fit_percent;  ///< simulated from the input alone; empty without inputs
  Usable usable;
};

struct Fitted {
  SwitchedArxModel model;
  Summary summary;
};

/// Fits all episodes of all recordings together. Modes are ordered by the share of rows in which they act, largest
/// first. A fit that is unreliable, or no better than a single ARX model, has `usable.verdict` false and the reason.
/// Errors: no recordings, a missing channel, orders of the wrong shape, rates that differ, infinite samples, too few
/// rows for the modes; kStopped.
Result<Fitted> fit(std::span<const Recording> recordings, const ChannelChoice& channels, const FitOptions& options,
                   const Progress& progress = {});

}  // namespace wisp::markov
