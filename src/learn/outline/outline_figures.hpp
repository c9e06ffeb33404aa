#pragma once
// How well a model follows recordings of an outline: per channel, per control point, at the tip, and as a filled shape.

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "learn/outline/outline_dynamics.hpp"
#include "learn/outline/outline_units.hpp"
#include "wisp/base/result.hpp"
#include "wisp/record/recording.hpp"

namespace wisp {

/// Steps ahead that are judged unless said otherwise; kFreeRun is the free simulation.
inline const std::vector<int> kJudgedSteps{1, 5, 15, kFreeRun};

/// One channel.
struct OutlineChannelFigures {
  std::string name;
  std::vector<double> fit_percent;  ///< 100(1 − ‖y − ŷ‖/‖y − ȳ‖), one a number of steps
};

/// Everything one entry a number of steps unless it says otherwise.
struct OutlineFigures {
  std::vector<int> steps;
  std::size_t rows = 0;  ///< that were judged
  std::vector<OutlineChannelFigures> channels;
  std::vector<std::vector<double>> j;                  ///< J_k: mean norm of the error, per control point
  std::vector<std::vector<double>> point_fit_percent;  ///< of x and y together, per control point: above 0, the point
                                                       ///< is followed better than by its mean
  std::vector<double> tip_fit_percent;                 ///< of the tip's x
  std::vector<double> overlap;  ///< mean intersection over union of predicted and captured filled outlines
};

/// Judges dynamics on prepared recordings. Without inputs, simulated freely, they are their mean shape: figures at
/// kFreeRun say how much the outline moves, not how good the dynamics are. Tip and overlap of long recordings are of at
/// most 2000 frames, evenly spread.
/// Errors: as predict_outline(); no row that is measured and predicted.
///
/// Precondition: at least one recording.
Result<OutlineFigures> outline_figures(const OutlineDynamics& dynamics, std::span<const Recording> recordings,
                                       const PreparedOutlines& prepared, const std::vector<int>& steps = kJudgedSteps);

/// 100(1 − ‖y − ŷ‖/‖y − ȳ‖); 0 where y is constant or empty.
///
/// Precondition: the same size.
double fit_percent(std::span<const double> measured, std::span<const double> predicted);

}  // namespace wisp
