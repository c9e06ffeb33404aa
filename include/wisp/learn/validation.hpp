#pragma once
// A model held against a recording: what it predicts, what it does from its inputs alone, and how like the real thing
// it is when it plays freely.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "wisp/base/result.hpp"
#include "wisp/learn/fidelity.hpp"
#include "wisp/learn/outline_alignment.hpp"
#include "wisp/learn/outline_figures.hpp"
#include "wisp/model/model.hpp"
#include "wisp/record/recording.hpp"

namespace wisp {

/// How to validate an outline.
struct OutlineValidationOptions {
  std::vector<int> steps = kJudgedSteps;  ///< steps ahead, or kFreeRun
  double pixels_per_unit = 0;        ///< 0: the recording's own mean calm height is the model's 1, whatever the camera
  bool own_input_scale = false;      ///< input 1 is this recording's 95th percentile instead of the training's: another
                                     ///< microphone, another gain
  bool align = true;                 ///< move inputs that come after the motion that they cause, as in learning
  const Recording* truth = nullptr;  ///< the inputs as they truly were, row by row: what of the error is the sensor's
  double play_seconds = 60;          ///< > 0: how long the model plays freely for the fidelity figures
  bool fidelity = true;              ///< off: it costs a second or two
  FidelityOptions fidelity_options;  ///< its channels are set to the outline's
  std::uint64_t seed = 1;
};

/// What a model said a number of steps ahead, frame by frame.
struct PredictedOutlines {
  int steps = 1;        ///< or kFreeRun: the simulation without noise
  Recording recording;  ///< like the validated one, its outputs replaced by predictions in pixels and the model's
                        ///< knots (attribute `knots`); NaN where none
};

/// The best that no dynamics can do: tip x = gain · input(t − delay) + constant, fitted to the very recording.
struct StaticGain {
  double delay_seconds = 0;
  double fit_percent = 0;  ///< of the tip's x
};

/// The free simulation driven by the inputs as they truly were, in their own 95th percentile's units.
struct TrueInputFigures {
  double tip_fit_percent = 0;
  double overlap = 0;
};

/// The outcome.
struct OutlineValidation {
  OutlineFigures figures;
  std::optional<TrueInputFigures> true_input;  ///< where the truth was given
  std::vector<InputAlignment> alignment;       ///< of the inputs
  std::vector<PredictedOutlines> predicted;    ///< one a number of steps
  Recording played;                            ///< the model with noise along the recording's inputs, over the
                                               ///< recording's rows, in pixels at its base
  std::optional<StaticGain> static_gain;       ///< for models with inputs
  std::optional<Fidelity> fidelity;            ///< of free play with noise; nothing where the recording is too short
  double held_share = 0;                       ///< of steps of that play in which an output was held at its range
  double crossed_share = 0;  ///< of its frames in which the outline crosses itself, which no real one does
  double pixels_per_unit = 0;
  std::vector<std::string> warnings;
};

/// What of a recording's input was 1 when the model was learned.
/// Errors: the model has no input of that name, or was not learned from recordings.
Result<double> trained_scale(const Model& model, const std::string& input);

/// Validates an outline model against a recording of an outline in pixels.
/// A recording with other knots is expressed in the model's, with a warning.
/// Errors, naming the recording: the model is not an outline or its dynamics are not ARX; another number of control
/// points than the model's; another rate; an input that the recording has not; no outline in any row.
Result<OutlineValidation> validate_outline(const Model& model, const Recording& recording,
                                           const OutlineValidationOptions& options = {});

}  // namespace wisp
