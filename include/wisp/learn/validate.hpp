#pragma once
// Validation of a model on recordings that it was not learned from: one call for every kind of model.

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "wisp/base/progress.hpp"
#include "wisp/base/report.hpp"
#include "wisp/base/result.hpp"
#include "wisp/learn/arx_recipe.hpp"
#include "wisp/model/model.hpp"
#include "wisp/record/recording.hpp"

namespace wisp {

/// Options of validation. A kind of model ignores options that do not concern it.
struct ValidationOptions {
  std::vector<int> steps{1, 5, 15, kFreeRun};      ///< prediction horizons, 1 to 100000 steps, or kFreeRun
  InitialState initial = InitialState::kMeasured;  ///< initial state of an ARX model's free simulation; a switched
                                                   ///< model starts from measured samples
  bool responses = false;  ///< ARX: also series of poles, zeros, responses and errors by horizon; outlines: of poles
  double pixels_per_unit = 0;    ///< outlines: pixels per model unit; 0: the recording's own calm height
  bool own_input_scale = false;  ///< outlines: an input of 1 is this recording's 95th percentile, not the training's,
                                 ///< for another microphone or gain
  bool align = true;             ///< outlines: advance inputs that lag behind the motion they cause
  double play_seconds = 60;      ///< outlines: duration of free play for the fidelity figures, 0.001 to 86400
  bool fidelity = true;          ///< outlines: compute fidelity, which takes a second or two
  std::uint64_t seed = 1;        ///< seed of simulations with noise
};

/// Validates a model on a recording; a plain ARX model also on several, in one table, with warnings that name the badly
/// fitted ones; a chain also on several, or on a windy and a calm recording with one attribute `pair`.
/// The report has the fields of `wisp validate --json` for that kind of model, and the series of its plots.
/// Errors, naming the recording: missing channels, a rate or number of control points that differs from the model's,
/// too few rows, options out of range; kStopped.
Result<Report> validate(const Model& model, std::span<const Recording> recordings,
                        const ValidationOptions& options = {}, const Progress& progress = {});

/// Validates a model on one recording.
Result<Report> validate(const Model& model, const Recording& recording, const ValidationOptions& options = {},
                        const Progress& progress = {});

/// Horizon and initial state of predictions.
struct PredictionOptions {
  int steps = 1;                                   ///< steps ahead, 1 to 100000, or kFreeRun: from the inputs alone
  InitialState initial = InitialState::kMeasured;  ///< of an ARX model's free run; otherwise only kMeasured
};

/// Predicts a recording row by row. Returns the recording's inputs, and for every output the measured channel NAME,
/// NAME.predicted and, except for switched models, NAME.low and NAME.high: the 95 % interval by the model's own noise.
/// NaN where there is no prediction: at the beginning of an episode, and after missing samples. Outlines are in the
/// recording's pixels. Errors, naming the recording: missing channels, another rate than the model's; a segment chain,
/// which predicts no rows; an initial state that the model does not support; steps out of range.
Result<Recording> predict(const Model& model, const Recording& recording, const PredictionOptions& options = {});

/// Returns a recording whose channels `names`, one per input of the model, are converted to the units of those inputs,
/// as in validate() and predict(): to the sensitivity of the training's microphone, if training and recording state the
/// sound level at value 1, then divided by the training's scale. `own_gain`, for another microphone: a model of an
/// outline divides instead by the 95th percentile of the recording's windy rows, another model by 1. Channels in an
/// input's unit already, as played by a model, stay unchanged. Errors, naming the recording: a missing channel; a
/// stated sound level that is not a positive number. Precondition: as many names as inputs.
Result<Recording> in_model_units(const Model& model, Recording recording, std::span<const std::string> names,
                                 bool own_gain = false);

struct NamedModel {
  std::string name;
  Model model;
};

/// Compares several ARX or switched models on one recording: the table `compared` has the fit of every output by every
/// model, over the rows that all models predict; series are the measured outputs and each model's prediction at the
/// last of `options.steps`. Of the options, steps and initial are used. Errors: those of predict(), naming the model; a
/// model of an outline; models learned with different preparation; no model or no steps; kStopped.
Result<Report> compare(std::span<const NamedModel> models, const Recording& recording,
                       const ValidationOptions& options = {}, const Progress& progress = {});

/// Compares the models on several recordings, in one table; series are those of the first recording.
Result<Report> compare(std::span<const NamedModel> models, std::span<const Recording> recordings,
                       const ValidationOptions& options = {}, const Progress& progress = {});

/// Outlines of a recording, row by row: points x, y from the base's left over the tip to the base's right, in the
/// clip's pixels, whose centres are at whole numbers. Empty where a row has no outline.
using OutlineRows = std::vector<std::vector<std::array<double, 2>>>;

/// Returns the outlines of a recording. Errors: it is not a recording of an outline.
Result<OutlineRows> outline_rows(const Recording& recording);

/// Result of validate_outline(): the report, and the outlines for its pictures.
struct ValidatedOutline {
  Report report;
  OutlineRows captured;
  OutlineRows simulated;  ///< simulation from the inputs alone; for a model without inputs the last of the predictions
                          ///< at most five frames ahead, since nothing drives a simulation
  std::string simulated_label;  ///< "simulated from the input alone", "predicted 5 frames ahead"
  OutlineRows played;           ///< play of the model with noise along the recording's inputs
  double pixels_per_unit = 1;   ///< pixels of this clip per unit of the model
};

/// Validates an outline model on a recording of an outline in pixels. The input is converted to the training's scale of
/// sound, unless `own_input_scale`; extinctions are excluded from the judgement of the dynamics, and the rule of
/// extinction is judged separately. A recording with other knots is converted to the model's, with a warning. The
/// report has rows, alignment, J, tip, overlap, fidelity, held_share, crossed_share, gain, extinction, and the series
/// of plots: `tip`, `input`, `flicker`.
/// Errors: no steps; a model that is not an outline or not ARX; naming the recording, a number of control points or a
/// rate that differs from the model's, a missing input, no outline in any row; kStopped.
Result<ValidatedOutline> validate_outline(const Model& model, const Recording& recording,
                                          const ValidationOptions& options = {}, const Progress& progress = {});

/// Checks that a recording has the model's rate, within 0.1 %: at another rate the model is another system.
Result<void> check_rate(const Model& model, const Recording& recording);

}  // namespace wisp
