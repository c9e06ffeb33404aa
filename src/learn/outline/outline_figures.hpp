#pragma once
// Accuracy of a model on recordings of an outline: per channel, per control point, at the tip, and as a filled shape.

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "learn/outline/outline_dynamics.hpp"
#include "learn/outline/outline_units.hpp"
#include "wisp/base/result.hpp"
#include "wisp/record/recording.hpp"

namespace wisp {

/// Default numbers of steps that are judged; kFreeRun is the free simulation.
inline const std::vector<int> kJudgedSteps{1, 5, 15, kFreeRun};

struct OutlineChannelFigures {
  std::string name;
  std::vector<double> fit_percent;  ///< 100(1 − ‖y − ŷ‖/‖y − ȳ‖), per number of steps
};

/// Figures per number of steps, unless stated otherwise.
struct OutlineFigures {
  std::vector<int> steps;
  std::size_t rows = 0;  ///< number of rows judged
  std::vector<OutlineChannelFigures> channels;
  std::vector<double> j;                ///< J_k: mean norm of the error of a control point
  std::vector<double> tip_fit_percent;  ///< fit of the tip's x
  std::vector<double> overlap;          ///< mean intersection over union of predicted and captured filled outlines
};

/// Judges dynamics on prepared recordings. Without inputs a free simulation stays at the mean shape, and the figures
/// for kFreeRun measure how much the outline moves. Tip and overlap use at most 2000 equally spaced frames. Errors: as
/// predict_outline(); no row that is both measured and predicted. Precondition: at least one recording.
Result<OutlineFigures> outline_figures(const OutlineDynamics& dynamics, std::span<const Recording> recordings,
                                       const PreparedOutlines& prepared, const std::vector<int>& steps = kJudgedSteps);

/// The value for a number of steps; NaN where that number was not judged.
double at_steps(const std::vector<int>& steps, const std::vector<double>& values, int wanted);

/// 100(1 − ‖y − ŷ‖/‖y − ȳ‖); 0 where y is constant or empty. Precondition: both have the same size.
double fit_percent(std::span<const double> measured, std::span<const double> predicted);

}  // namespace wisp
