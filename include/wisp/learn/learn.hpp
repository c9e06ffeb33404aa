#pragma once
// Learning of a model from recordings: one call for every kind of model.

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

/// Recipe for learning a model: one plain struct of settings for each kind of model.
using Recipe =
    std::variant<ArxRecipe, SwitchedRecipe, FlickerRecipe, OutlineRecipe, FlameRecipe, ChainRecipe, LeafRecipe>;

/// A model and its assessment. The model's `training` has the verdict and the figures stored with the model; the report
/// has all findings.
struct Fit {
  Model model;
  Report report;
};

/// Learns a model from recordings according to the recipe. Settings left open by the recipe are chosen from the
/// recordings; the report states the choices, the quality of the model, and whether it may be used. Returns a model
/// that has passed check() and documents its origin in `training`, or, if the recordings yield no playable model, one
/// whose verdict says so. Errors, naming the recording: missing or invalid content, settings out of range, too few
/// rows; kStopped where `progress` returned false.
Result<Fit> learn(std::span<const Recording> recordings, const Recipe& recipe, const Progress& progress = {});

/// Learns from one recording.
Result<Fit> learn(const Recording& recording, const Recipe& recipe, const Progress& progress = {});

}  // namespace wisp
