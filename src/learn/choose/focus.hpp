#pragma once
// Which ARX model simulates best: least squares at the given orders, or 15 or 30 lags under a kernel, by free
// simulation of rows that were not learned from.
//
// Source: G. Pillonetto et al., Automatica 50 (2014), for the kernel as a choice without orders; forward chaining as
// in C. Bergmeir and J. Benítez, Information Sciences 191 (2012).

#include <span>
#include <string>
#include <vector>

#include "learn/arx/fit/arx_fit.hpp"
#include "wisp/base/progress.hpp"
#include "wisp/base/result.hpp"
#include "wisp/learn/arx_recipe.hpp"

namespace wisp::arx {

/// Numbers of lags of every channel under the kernel, where the orders have fewer: two damped resonances and what lies
/// between, and slow responses.
inline constexpr int kKernelLags[] = {15, 30};

/// One candidate for outputs that feed each other, and its errors over held-out free runs.
struct FocusCandidate {
  int kernel_lags = 0;         ///< under the TC kernel; 0: least squares at the given orders
  bool decoupled = false;      ///< every output has feedback from itself alone
  double estimated_error = 0;  ///< root mean square as a share of the outputs' deviation, from the best initial state
  double measured_error = 0;   ///< the same from measured samples
};

/// The choice for outputs that feed each other.
struct FocusChoice {
  std::vector<int> outputs;
  std::size_t chosen = 0;
  std::vector<FocusCandidate> candidates{};  ///< least squares at the given orders first; empty: none could be judged
};

/// What was chosen, and why.
struct FocusOutcome {
  bool changed = false;  ///< whether the model is another than least squares at the given orders
  std::string reason{};  ///< one sentence
  std::vector<FocusChoice> choices{};
};

struct FocusedFit {
  ArxFit fit;
  ArxOptions options;  ///< `fit` is fit_arx() with these
  FocusOutcome outcome{};
};

/// Judges least squares at the given orders and either of kKernelLags under the TC kernel, both with the given coupling
/// and with every output on its own, by free simulation of held-out rows, for each set of coupled outputs. With kAuto a
/// candidate replaces least squares at the given orders where it is surely_better(), from measured samples and from
/// fitted initial states; with kSimulation the one of the least error is taken. Returns `plain` with the reason where
/// nothing is to be simulated (no inputs, no feedback), where the data do not determine all coefficients, or where
/// there are too few rows to hold some out. Errors: as fit_arx, kStopped.
///
/// Precondition: `plain` is fit_arx() of the same arguments.
Result<FocusedFit> focus_fit(std::span<const Recording> recordings, const ChannelChoice& channels,
                             const ArxOptions& options, ArxFit plain, ArxFocus focus, const Progress& progress);

}  // namespace wisp::arx
