#pragma once
// Switched ARX estimation: several ARX modes and what decides between them.
//
// Sources. By regions: G. Ferrari-Trecate, M. Muselli, D. Liberati & M. Morari, A clustering technique for the
// identification of piecewise affine systems, Automatica 39 (2003), for the start: local models on near regressors,
// clustered by their coefficients and places; then the modes and the regions between them are refined together, as a
// mixture of experts (M. I. Jordan & R. A. Jacobs, Neural Computation 6, 1994): rows are shared out among the modes by
// their residuals and by a multinomial logistic function of the regressors, whose largest term is the region. By a
// Markov chain: expectation–maximisation with forward and backward passes (L. E. Baum et al. 1970; J. D. Hamilton,
// Econometrica 57, 1989). Departures: several starts of both kinds, of which the likeliest is taken; a mode's residuals
// are never taken for smaller than a hundredth of a single ARX model's, so that no mode shrinks onto a few rows; an
// unstable mode is made stable.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "learn/channel_choice.hpp"
#include "learn/switched/mode_difference.hpp"
#include "wisp/base/progress.hpp"
#include "wisp/base/result.hpp"
#include "wisp/model/model.hpp"
#include "wisp/model/switched.hpp"
#include "wisp/record/recording.hpp"

namespace wisp {

struct SwitchedOptions {
  ArxOrders orders;  ///< of every mode; see make_orders
  Switching switching = Switching::kRegions;
  int modes = 0;               ///< 1 … max_modes; 0: the number that does best on rows held out
  int max_modes = 6;           ///< 1 … kMaxArxModes: the largest number that is tried
  bool subtract_means = true;  ///< the operating point is each channel's mean, else 0. Modes have constants either way
  double holdout = 0.3;        ///< in (0, 0.9]: share of every stretch, its end, that judges the number of modes
  int starts = 12;             ///< ≥ 1
  int max_iterations = 300;    ///< ≥ 1, of the best start
  int neighbours = 0;          ///< rows of a local model; 0: three times its coefficients
  double stability_margin = 1e-3;  ///< in (0, 1): a repaired mode's spectral radius is at most 1 − this
  std::uint64_t seed = 1;
};

/// A number of modes that was tried. Likelihoods are mean natural logarithms a row, in the outputs' units.
struct SwitchedCandidate {
  int modes = 1;
  double log_likelihood = 0;           ///< of the rows learned from
  double held_out_log_likelihood = 0;  ///< of the rows held out, as the model would play: one region, one mode
  double gain_std_error = 0;           ///< of its held-out gain over the candidate before it, from row to row
  bool determined = true;              ///< false: a mode had fewer rows than it needs
};

struct SwitchedSummary {
  std::size_t samples_used = 0;  ///< by the model that is returned, which is learned from all rows
  std::size_t held_out = 0;
  std::vector<SwitchedCandidate> candidates;            ///< 1 mode, a single ARX model, and those that were tried
  std::vector<std::size_t> mode_rows;                   ///< rows in which each mode acted
  std::vector<double> mode_radius;                      ///< spectral radii
  std::vector<bool> mode_changed;                       ///< whether a mode was made stable
  std::vector<std::vector<double>> constant_std_error;  ///< per mode and output
  std::vector<ModeDifference> differences;              ///< of every pair of modes
  std::vector<double> fit_percent;                      ///< one step ahead, per output
  std::vector<double> free_run_fit_percent;             ///< from the input alone
  std::vector<std::string> warnings;
  Usable usable;
};

struct SwitchedFit {
  SwitchedArxModel model;
  SwitchedSummary summary;
  std::vector<std::vector<int>> modes;  ///< per recording and row, the likeliest mode; −1 where there is none
};

/// Fits a switched model to all episodes of all recordings together. Modes are ordered by how often they act, most
/// often first. A fit that cannot be trusted, or that a single ARX model equals, is returned with `usable.verdict`
/// false and the reason. Errors: no recordings, a channel that a recording has not, orders of the wrong shape, rates
/// that differ, infinite samples, options out of range, too few rows for the modes; kStopped.
Result<SwitchedFit> fit_switched(std::span<const Recording> recordings, const ChannelChoice& channels,
                                 const SwitchedOptions& options, const Progress& progress = {});

}  // namespace wisp
