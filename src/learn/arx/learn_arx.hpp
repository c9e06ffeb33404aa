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

/// Learns an ARX model: searches orders if recipe.search is set, otherwise estimates delays if recipe.nk is unset. An
/// unstable model (stabilisation off) is returned too, with a verdict that says so. Errors: no recordings, channels
/// missing from them, settings out of range, a kernel with another focus than prediction, too few rows, kStopped.
Result<Fit> learn_arx(std::span<const Recording> recordings, const ArxRecipe& recipe, const Progress& progress = {});

/// Reports accuracy of predictions and free simulation, shares of rows in 95 % intervals and residual tests of a plain
/// ARX model. Series of output I over seconds: `measured.I`, `simulated.I`, `predicted.I` (at most 15 steps ahead) with
/// `.low` and `.high`. options.responses adds errors over steps (`error.I`, `error.I.model`, `error.I.inf`) and
/// responses. Errors: the recording lacks channels or is too short, steps out of range, kStopped.
///
/// Precondition: the model's dynamics are an ArxModel.
Result<Report> validate_arx(const Model& model, const Recording& recording, const ValidationOptions& options = {},
                            const Progress& progress = {});

namespace arx {

ArxOptions fit_options(const ArxRecipe& recipe, const ArxOrders& orders);

/// Number of poles at 1 per output, 0 to 2; empty where no output has any, or without inputs. Outputs coupled to others
/// have none. A pole counts if it improves the free-run fit by over 2 percentage points and fixing it at 1 either
/// passes the Dickey–Fuller test (5 %) or leaves a one-step fit above 99.9 %. `plain`: fit_arx(), same options.
std::vector<int> find_integrators(std::span<const Recording> recordings, const ChannelChoice& channels,
                                  const ArxOptions& options, const ArxFit& plain);

/// Fits with an estimated constant and with poles fixed at 1 − d. Of d = 1e-5, 1e-4, 2⁻¹² takes the first whose model
/// is stable in single precision, otherwise 1e-3. `options` receives these settings. Errors: as fit_arx.
Result<ArxFit> fit_integrators(std::span<const Recording> recordings, const ChannelChoice& channels,
                               const std::vector<int>& integrators, ArxOptions& options);

/// Returns find_integrators() of one output, for na = nb = 4 and nk = 1; 0 where that model cannot be fitted.
int integrators_in(std::span<const Recording> recordings, const std::vector<std::string>& inputs,
                   const std::string& output);

/// Sums of squared residuals of one output over `rows` rows: `size` after regression on a constant, `own` also on its
/// own past, `both` also on one set of lagged inputs. percent(): percentage of `own` that the first set explains.
struct PastEffect {
  double rows = 0, size = 0, own = 0;
  std::vector<double> both{};

  double percent() const { return own > 0 ? 100 * (1 - both.front() / own) : 0; }
};

/// Regresses channels.outputs[0] on its last `own_lags` samples, alone and with each set of lagged inputs, in which
/// input 0 is channel 1. Empty where gather_signals() fails, and where there are too few rows.
std::optional<PastEffect> effect_of_past(std::span<const Recording> recordings, const ChannelChoice& channels,
                                         const std::vector<std::vector<LaggedChannel>>& sets, int own_lags = 20);

/// Returns a remark on the first output that at least 3 of 10 far delayed copies of the inputs explain about as well as
/// the inputs do. Ramps and sines fit at every delay, so the recording does not show whether the inputs are the cause.
std::optional<Remark> coincidence(std::span<const Recording> recordings, const ChannelChoice& channels,
                                  const ArxOrders& orders);

/// Assembles the model, its training record and the fit's part of the report.
Fit finish(const ArxFit& fit, const ArxRecipe& recipe, const ChannelChoice& channels, const Sources& sources);

/// Reports progress. Error: kStopped where the caller stops the work.
Result<void> check_progress(const Progress& progress, std::string_view stage, double share);

}  // namespace arx
}  // namespace wisp
