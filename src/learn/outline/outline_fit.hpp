#pragma once
// Learning an outline: from recordings of its control points to a model that moves like it.
//
// Source: L.-M. Reissell and D. K. Pai (2001), section 3.4: every control point its own ARX system of two outputs,
// order 4, driven by the wind, its residual fed back as Gaussian noise. Beyond it: wind from both sides, inputs or
// none, shocks that the control points share (docs/explanation/fidelity.md says why), a part held out for judging.

#include <Eigen/Core>
#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "learn/arx/curve/curve_choice.hpp"
#include "learn/arx/fit/arx_fit.hpp"
#include "learn/fidelity/fidelity.hpp"
#include "learn/outline/outline_alignment.hpp"
#include "learn/outline/outline_figures.hpp"
#include "learn/outline/outline_inputs.hpp"
#include "learn/outline/outline_ridge.hpp"
#include "wisp/base/progress.hpp"
#include "wisp/base/result.hpp"
#include "wisp/learn/outline_recipe.hpp"
#include "wisp/model/model.hpp"
#include "wisp/record/recording.hpp"

namespace wisp {

/// One channel's residual noise, one step ahead, in the model's units.
struct OutlineResidual {
  double sd = 0;
  std::array<double, 2> sd_ci95{};  ///< χ² interval
};

/// What orders and delays are compared by.
enum class OutlineCriterion {
  kGiven,           ///< nothing was compared
  kFpe,             ///< Akaike's final prediction error: where too little is held out
  kHeldOutStep,     ///< the error one step ahead on what is held out: where no input drives the outline
  kHeldOutFreeRun,  ///< the error of free simulation on what is held out
};

/// An order and a delay that were compared.
struct OutlineCandidate {
  int order = 0;
  int delay = 0;
  double fpe = 0;
  double error = 0;  ///< by the criterion: root mean square in the model's units, geometric mean over channels
};

/// Which order and delay, and why.
struct OutlineChoice {
  OutlineCriterion by = OutlineCriterion::kGiven;
  std::vector<OutlineCandidate> candidates;
  std::size_t chosen = 0;  ///< of the candidates: the lowest order within 2 % of the best's error, at its best delay
  std::string reason;

  const OutlineCandidate& taken() const { return candidates[chosen]; }
};

/// How good the model is.
struct OutlineSummary {
  double rate_hz = 0;
  std::vector<OutlineInput> inputs;
  std::size_t points = 0;
  ArxOrders orders;
  OutlineChoice choice;
  CurveChoice curve_choice;               ///< what bends the inputs, and why; without candidates where none was tried
  std::vector<CurveEstimate> curves;      ///< one an input, of the returned model; empty: none
  RidgeChoice ridge;                      ///< where control points hear each other
  std::vector<InputAlignment> alignment;  ///< of every recording's inputs
  std::size_t rows_learned = 0;   ///< complete rows that a judged model was learned from: before the cut, or in a turn
  std::size_t rows_held_out = 0;  ///< and those held out
  bool refitted = false;          ///< whether the returned model was learned from both
  OutlineFigures learned;         ///< on what was learned from
  std::optional<OutlineFigures> held_out;  ///< on what was held out; nothing where that is too short
  Eigen::MatrixXd free_run_parts;          ///< errors of free simulation on it (arx/judge/held_out.hpp)
  std::vector<OutlineResidual> residuals;  ///< of the returned model, one a channel
  double fpe = 0;                          ///< of the returned model, mean over rows of V·(1 + d/n)/(1 − d/n)
  ArxStability stable;
  double unsteadiness = 0;       ///< of what was recorded: 0 moves steadily, 1 is frames in random order
  double held_share = 0;         ///< of steps in which an output is clamped to its range, playing freely with noise
  std::vector<double> sd_ratio;  ///< of every channel: playing freely along the liveliest recording over
                                 ///< what that has; 1 where nothing moves
  std::optional<Bounded> play_distance;  ///< of the same play from that recording; nothing where it is too short
  double shared_variance = 0;            ///< share of the wanted shocks' variance that the shared ones carry, 0 to 1
  bool variance_matched = false;
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
/// that it has not, too few rows for the order, a recipe out of range; kStopped.
Result<OutlineFit> fit_outline(std::span<const Recording> recordings, const OutlineRecipe& recipe = {},
                               const Progress& progress = {});

}  // namespace wisp
