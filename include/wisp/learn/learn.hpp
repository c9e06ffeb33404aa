#pragma once
// The front door of learning: recordings and a recipe in, a model and its report out.

#include <span>
#include <variant>

#include "wisp/base/progress.hpp"
#include "wisp/base/result.hpp"
#include "wisp/learn/arx_recipe.hpp"
#include "wisp/learn/fit.hpp"

namespace wisp {

/// What is to be learned.
using Recipe = std::variant<ArxRecipe, SwitchedRecipe>;

/// Learns a model. One that cannot be trusted, or not even played, is returned too, with a verdict that says so.
/// Errors: recordings that cannot be learned from, settings out of range, kStopped.
Result<Fit> learn(std::span<const Recording> recordings, const Recipe& recipe, const Progress& progress = {});

/// Judges a plain or switched ARX model on a recording. Errors: channels that it has not, too few rows, kStopped.
///
/// Precondition: the model is one of these.
Result<Report> validate(const Model& model, const Recording& recording, const ArxValidation& options = {},
                        const Progress& progress = {});

}  // namespace wisp
