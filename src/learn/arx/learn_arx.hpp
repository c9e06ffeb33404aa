#pragma once
// From recordings and a recipe to an ARX model and its report; and a model on a recording.

#include <span>

#include "learn/arx/fit/arx_fit.hpp"
#include "learn/arx/plain_model.hpp"
#include "wisp/base/progress.hpp"
#include "wisp/base/result.hpp"
#include "wisp/learn/arx_recipe.hpp"
#include "wisp/learn/learn.hpp"
#include "wisp/learn/validate.hpp"

namespace wisp {

/// Learns as the recipe says; with `ArxRecipe::search` the best orders first, with open delays those first. A model
/// that cannot be played (an unstable one that was to be kept) is returned too, and its verdict says so. Errors: no
/// recordings, channels that they have not, settings out of range, too few rows, kStopped.
Result<Fit> learn_arx(std::span<const Recording> recordings, const ArxRecipe& recipe, const Progress& progress = {});

/// Predictions, free simulation and residuals of a plain ARX model on a recording, with the shares of rows within its
/// own intervals. Series, I an output: `measured.I`, `simulated.I`, `predicted.I` with `.low` and `.high`, all over
/// seconds; residual tests; and where requested `error.I` and `error.I.model` over steps, `error.I.inf`, and responses.
/// Errors: the recording has not the model's channels or is too short, steps out of range, kStopped.
///
/// Precondition: the model's dynamics are an ArxModel.
Result<Report> validate_arx(const Model& model, const Recording& recording, const ValidationOptions& options = {},
                            const Progress& progress = {});

namespace arx {

/// How the recipe fits.
ArxOptions fit_options(const ArxRecipe& recipe, const ArxOrders& orders);

/// Model, training and the fit's part of the report.
Fit finish(const ArxFit& fit, const ArxRecipe& recipe, const ChannelChoice& channels, const Sources& sources);

/// The error that stopped work ends with, unless it is to go on.
Result<void> check_progress(const Progress& progress, std::string_view stage, double share);

}  // namespace arx
}  // namespace wisp
