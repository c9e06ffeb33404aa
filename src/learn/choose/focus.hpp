#pragma once
// Chooses the ARX model that simulates best: least squares at the given orders, or 15 or 30 lags under a kernel, judged
// by free simulation of held-out rows.
//
// Source: G. Pillonetto et al., Automatica 50 (2014), for the kernel as a choice without orders; forward chaining as
// in C. Bergmeir and J. Benítez, Information Sciences 191 (2012).

#include <span>
#include <string>
#include <vector>

#include "learn/fit/arx_fit.hpp"
#include "wisp/base/progress.hpp"
#include "wisp/base/result.hpp"
#include "wisp/learn/arx_recipe.hpp"

namespace wisp::arx {

/// Numbers of lags of every channel under the kernel; larger orders are kept. 15 lags cover two damped resonances per
/// output, 30 cover slow responses.
inline constexpr int kKernelLags[] = {15, 30};

/// One candidate for a block of coupled outputs, with its errors over held-out free runs.
struct FocusCandidate {
  int kernel_lags = 0;         ///< number of lags under the TC kernel; 0: least squares at the given orders
  bool decoupled = false;      ///< without feedback between outputs
  double estimated_error = 0;  ///< RMS error / standard deviation of the outputs, from fitted initial states
  double measured_error = 0;   ///< RMS error / standard deviation, from measured initial samples
};

struct FocusChoice {
  std::vector<int> outputs;
  std::size_t chosen = 0;
  std::vector<FocusCandidate> candidates{};  ///< first: least squares at the given orders; empty: too few rows to judge
};

struct FocusOutcome {
  bool changed = false;  ///< whether the model differs from least squares at the given orders
  std::string reason{};  ///< one sentence
  std::vector<FocusChoice> choices{};
};

struct FocusedFit {
  ArxFit fit;
  ArxOptions options;  ///< options with which fit_arx() gives `fit`
  FocusOutcome outcome{};
};

/// Chooses, for each block of coupled outputs, between least squares at the given orders and each of kKernelLags under
/// the TC kernel, with the given coupling or decoupled outputs, by the sum of squared errors of held-out free runs from
/// fitted and from measured initial states. A candidate must lower the sum by 2 %. With kAuto it must also be
/// surely_better() than least squares, from fitted states and in the sum; 30 lags are tried only where a kernel is
/// already chosen. Returns `plain` with the reason for kPrediction, without inputs or feedback, without stabilisation,
/// where the data do not determine all coefficients, or where too few rows can be held out. Errors: as fit_arx,
/// kStopped. Precondition: `plain` is fit_arx() of the same arguments.
Result<FocusedFit> focus_fit(std::span<const Recording> recordings, const ChannelChoice& channels,
                             const ArxOptions& options, ArxFit plain, ArxFocus focus, const Progress& progress);

}  // namespace wisp::arx
