#pragma once
// From recordings to a model: one call for every kind of model.

#include <span>
#include <variant>

#include "wisp/base/progress.hpp"
#include "wisp/base/report.hpp"
#include "wisp/base/result.hpp"
#include "wisp/learn/arx_recipe.hpp"
#include "wisp/learn/chain_recipe.hpp"
#include "wisp/learn/outline_recipe.hpp"
#include "wisp/model/model.hpp"
#include "wisp/record/recording.hpp"

namespace wisp {

/// How a model is learned: one plain struct of settings for each kind of model.
using Recipe =
    std::variant<ArxRecipe, SwitchedRecipe, FlickerRecipe, OutlineRecipe, FlameRecipe, ChainRecipe, LeafRecipe>;

/// A model and what to think of it. The model's `training` has the verdict and the figures that stay with it; the
/// report has everything that was found.
struct Fit {
  Model model;
  Report report;
};

/// Learns a model from recordings as the recipe says. What the recipe leaves open is decided by held-out data; the
/// report says what was decided, how good the model is, and whether it may be used.
/// Returns a model that has passed check() and says in `training` what it was made from, or, where the recordings yield
/// none that can be played, one whose verdict says so.
/// Errors, naming the recording: what it has not or has wrong, settings out of range, too few rows; kStopped where
/// `progress` says not to go on.
Result<Fit> learn(std::span<const Recording> recordings, const Recipe& recipe, const Progress& progress = {});

/// The same from one recording.
Result<Fit> learn(const Recording& recording, const Recipe& recipe, const Progress& progress = {});

}  // namespace wisp
