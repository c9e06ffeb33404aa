#pragma once
// What is found when an outline model is validated on a recording: its predictions, its simulation from the inputs
// alone, and the fidelity of its free play.

#include <optional>
#include <string>
#include <vector>

#include "learn/fidelity/fidelity.hpp"
#include "learn/outline/outline_alignment.hpp"
#include "learn/outline/outline_figures.hpp"
#include "wisp/base/progress.hpp"
#include "wisp/base/result.hpp"
#include "wisp/learn/validate.hpp"
#include "wisp/model/model.hpp"
#include "wisp/record/recording.hpp"

namespace wisp {

/// What a model said a number of steps ahead, frame by frame.
struct PredictedOutlines {
  int steps = 1;        ///< or kFreeRun: the simulation without noise
  Recording recording;  ///< like the validated one, its outputs replaced by predictions in pixels and the model's
                        ///< knots (attribute `knots`); NaN where none
};

/// The outcome.
struct OutlineJudgement {
  OutlineFigures figures;
  bool driven = false;                       ///< whether the model has inputs
  std::vector<InputAlignment> alignment;     ///< of the inputs
  std::vector<PredictedOutlines> predicted;  ///< one a number of steps
  Recording played;                          ///< the model with noise along the recording's inputs, over the
                                             ///< recording's rows, in pixels at its base
  std::optional<Fidelity> fidelity;          ///< of free play with noise; nothing where the recording is too short
  double held_share = 0;                     ///< of steps of that play in which an output was clamped to its range
  double self_intersection_rate = 0;         ///< of its frames in which the outline intersects itself
  double pixels_per_unit = 0;
  std::vector<std::string> warnings;
};

/// Validates an outline model against a recording of an outline in pixels.
/// A recording with other knots is expressed in the model's, with a warning.
/// Errors, naming the recording: the model is not an outline or its dynamics are not ARX; another number of control
/// points than the model's; another rate; an input that the recording has not; no outline in any row.
Result<OutlineJudgement> judge_outline(const Model& model, const Recording& recording,
                                       const ValidationOptions& options = {}, const Progress& progress = {});

}  // namespace wisp
