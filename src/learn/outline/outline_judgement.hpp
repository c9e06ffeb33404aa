#pragma once
// Results of validating an outline on a recording: predictions, simulation from inputs alone, fidelity of free play.

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

/// Predictions of a model for one number of steps, per frame.
struct PredictedOutlines {
  int steps = 1;        ///< steps ahead; kFreeRun: simulation without noise
  Recording recording;  ///< the validated recording with outputs replaced by predictions in pixels, in the model's
                        ///< knots (attribute `knots`); NaN where none
};

struct OutlineJudgement {
  OutlineFigures figures;
  bool driven = false;                       ///< whether the model has inputs
  std::vector<InputAlignment> alignment;     ///< one per input
  std::vector<PredictedOutlines> predicted;  ///< one per number of steps
  Recording played;                          ///< play with noise along the recording's inputs, a frame per row, in
                                             ///< pixels, at the recorded base
  std::optional<Fidelity> fidelity;          ///< fidelity of a play of `play_seconds`; empty if not wanted or too short
  double held_share = 0;                     ///< share of that play's steps with an output clamped to its range
  double self_intersection_rate = 0;         ///< share of that play's frames whose outline intersects itself
  double pixels_per_unit = 0;
  std::vector<std::string> warnings;
};

/// Validates an outline model against a recording of an outline in pixels.
/// A recording with other knots is converted to the model's, with a warning.
/// Errors, naming the recording: the model is not an outline or its dynamics are not ARX; a different number of control
/// points; a different rate; a missing input; no outline in any row; kStopped.
Result<OutlineJudgement> judge_outline(const Model& model, const Recording& recording,
                                       const ValidationOptions& options = {}, const Progress& progress = {});

}  // namespace wisp
