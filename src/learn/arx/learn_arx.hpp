#pragma once
// Learns an ARX model and its report from recordings and a recipe, and validates a model on a recording.

#include <optional>
#include <span>

#include "learn/arx/plain_model.hpp"
#include "learn/fit/arx_fit.hpp"
#include "wisp/base/progress.hpp"
#include "wisp/base/result.hpp"
#include "wisp/learn/advice.hpp"
#include "wisp/learn/arx_recipe.hpp"
#include "wisp/learn/learn.hpp"
#include "wisp/learn/validate.hpp"

namespace wisp {

/// Learns by the recipe, after a search of orders if `search` is set, or an estimate of delays if `nk` is unset. A
/// model that cannot be played (unstable, with stabilisation off) is returned too, with a verdict that says so. Errors:
/// no recordings, channels missing from them, settings out of range, too few rows, kStopped.
Result<Fit> learn_arx(std::span<const Recording> recordings, const ArxRecipe& recipe, const Progress& progress = {});

/// Reports predictions, free simulation and residuals of a plain ARX model on a recording, and shares of rows in its
/// 95 % intervals. Series of output I: `measured.I`, `simulated.I`, `predicted.I` (at most 15 steps ahead) with `.low`
/// and `.high`, over seconds; residual tests; if requested `error.I` and `error.I.model` over steps, `error.I.inf` and
/// responses. Errors: the recording lacks the model's channels or is too short, steps out of range, kStopped.
///
/// Precondition: the model's dynamics are an ArxModel.
Result<Report> validate_arx(const Model& model, const Recording& recording, const ValidationOptions& options = {},
                            const Progress& progress = {});

namespace arx {

ArxOptions fit_options(const ArxRecipe& recipe, const ArxOrders& orders);

/// Returns the number of poles at 1 per output, 0 to 2; empty where no output has any. Coupled outputs have none. A
/// pole counts if fixing it at 1 raises the squared error by no more than the Dickey–Fuller test allows (5 %), or
/// leaves a one-step fit above 99.9 %, and if it improves the fit of free simulation by over 2 percentage points.
/// `plain`: fit_arx() with the same options.
std::vector<int> find_integrators(std::span<const Recording> recordings, const ChannelChoice& channels,
                                  const ArxOptions& options, const ArxFit& plain);

/// Fits with an estimated constant and with poles fixed at 1 − d: the smallest d of 1e-5 to 1e-3 that leaves the model
/// stable in single precision. `options` receives these settings. Errors: as fit_arx.
Result<ArxFit> fit_integrators(std::span<const Recording> recordings, const ChannelChoice& channels,
                               const std::vector<int>& integrators, ArxOptions& options);

/// Number of poles at 1 of one output under a model with these inputs and orders 4; 0 where it cannot be fitted.
int integrators_in(std::span<const Recording> recordings, const std::vector<std::string>& inputs,
                   const std::string& output);

/// Sums of squares of one output over the same `rows`: `size` about its mean, `own` of what its own past leaves, `both`
/// of what its own past and each set of the inputs' lags leave. percent(): share of `own` that the first set explains.
struct PastEffect {
  double rows = 0, size = 0, own = 0;
  std::vector<double> both{};

  double percent() const { return own > 0 ? 100 * (1 - both.front() / own) : 0; }
};

/// Regressions of channels.outputs[0]. Channel 1 + k of a set is input k. Empty where a channel is missing or has no
/// sample, and where there are too few rows.
std::optional<PastEffect> effect_of_past(std::span<const Recording> recordings, const ChannelChoice& channels,
                                         const std::vector<std::vector<LaggedChannel>>& sets, int own_lags = 20);

/// A remark on the first output that its inputs explain, beside its own past, no better than the same inputs shifted
/// far into the past do. A ramp or a sine looks alike at every shift, so no recording shows whether it drives anything.
std::optional<Remark> coincidence(std::span<const Recording> recordings, const ChannelChoice& channels,
                                  const ArxOrders& orders);

/// Assembles the model, its training record and the fit's part of the report.
Fit finish(const ArxFit& fit, const ArxRecipe& recipe, const ChannelChoice& channels, const Sources& sources);

/// Reports progress. Error: kStopped where the caller stops the work.
Result<void> check_progress(const Progress& progress, std::string_view stage, double share);

}  // namespace arx
}  // namespace wisp
