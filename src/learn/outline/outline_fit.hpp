#pragma once
// Learning an outline: from recordings of its control points to a model that moves like it, and what to think of it.

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "learn/outline/outline_alignment.hpp"
#include "learn/outline/outline_figures.hpp"
#include "learn/outline/outline_trial.hpp"
#include "wisp/base/progress.hpp"
#include "wisp/base/result.hpp"
#include "wisp/learn/outline_recipe.hpp"
#include "wisp/model/model.hpp"
#include "wisp/record/recording.hpp"

namespace wisp {

/// How good the model is.
struct OutlineSummary {
  double rate_hz = 0;
  std::vector<OutlineInput> inputs;
  std::size_t points = 0;
  OutlineDynamics dynamics;                ///< of the returned model, without its noise's rows
  double radius = 0;                       ///< spectral
  std::vector<InputAlignment> alignment;   ///< of every recording's inputs
  std::size_t rows_learned = 0;            ///< complete rows that the judged dynamics were learned from,
  std::size_t rows_held_out = 0;           ///< and those held out; the returned model is learned from both
  OutlineFigures learned;                  ///< on what was learned from
  std::optional<OutlineFigures> held_out;  ///< on what was held out; nothing where that is too short
  std::vector<double> residual_sd;         ///< one step ahead, one an output
  std::size_t resampled_rows = 0;          ///< of residuals; 0: Gaussian noise
  OutlineTrial trial;
  double pixels_per_unit = 0;  ///< of the first recording
  std::vector<std::string> warnings;
  Usable usable;
};

/// A model of an outline and what to think of it.
struct OutlineFit {
  Model model;
  OutlineSummary summary;
};

/// Learns a model from recordings of an outline in pixels (outline_units.hpp), without a rule of extinction and with
/// every recording's inputs on the scale that it has. The model has the knots of the first recording; recordings with
/// others are expressed in those, with a warning.
/// Errors, naming the recording: not an outline, another number of points than the first, rates that differ, inputs
/// that it has not, too few rows, a recipe out of range; kStopped.
Result<OutlineFit> fit_outline(std::span<const Recording> recordings, const OutlineRecipe& recipe = {},
                               const Progress& progress = {});

}  // namespace wisp
