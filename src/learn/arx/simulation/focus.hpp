#pragma once
// Whether an ARX model is refined for free simulation, how far, and the refined model.

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "learn/arx/fit/arx_fit.hpp"
#include "wisp/base/progress.hpp"
#include "wisp/base/result.hpp"
#include "wisp/learn/arx_recipe.hpp"

namespace wisp::arx {

/// One way to choose a block's coefficients, and its errors over held-out free runs.
struct FocusCandidate {
  std::optional<double> one_step_weight{};  ///< of refined ones; none: least squares
  bool at_zero = false;                     ///< … about zero: no input at rest means no output
  int kernel_lags = 0;                      ///< of many lags under a kernel (kKernelLags); 0: no kernel
  int states = 0;                           ///< of a subspace estimate in its ARX form (state_space.hpp)
  bool decoupled = false;                   ///< every output remembers itself only
  double estimated_error = 0;  ///< root mean square, shares of the outputs' own, from the best initial state
  double measured_error = 0;   ///< … from measured samples
};

/// Lags of every channel under a kernel, where the orders have fewer: two damped resonances and what lies between, and
/// for what answers slowly twice as many.
inline constexpr int kKernelLags[] = {15, 30};

/// What was chosen for outputs that feed each other.
struct FocusChoice {
  std::vector<int> outputs;
  std::size_t chosen = 0;
  std::vector<FocusCandidate> candidates{};  ///< least squares first; empty where none could be judged
};

/// What a focus made of a model, and why.
struct FocusOutcome {
  bool refined = false;
  std::string reason{};  ///< one sentence
  std::vector<FocusChoice> choices{};
};

struct FocusedFit {
  ArxFit fit;
  FocusOutcome outcome{};
};

/// The request.
struct FocusOptions {
  ArxFocus focus = ArxFocus::kAuto;
  bool keep_orders = false;  ///< refined only: neither kernels nor states, and no output on its own
};

/// `plain` refined as the focus says: with kSimulation in any case, as far as held-out free runs say; with kAuto where
/// they are surely better for it, and with kKernelLags lags under a kernel or from a subspace estimate where they are
/// surely better still. Where means are subtracted a constant is estimated with what is refined. `plain` itself where
/// nothing is to be simulated (no inputs, no feedback), where the data cannot tell all coefficients, or where too few
/// rows are there to hold some out. Errors: as fit_arx, kStopped. Precondition: `plain` is fit_arx() of the same
/// arguments.
Result<FocusedFit> focus_fit(std::span<const Recording> recordings, const ChannelChoice& channels,
                             const ArxOptions& options, ArxFit plain, const FocusOptions& focus,
                             const Progress& progress);

}  // namespace wisp::arx
