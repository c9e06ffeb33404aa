#pragma once
// A model held against recordings that it was not learned from: one call for every kind of model.

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

/// How to validate. Each kind of model takes what concerns it.
struct ValidationOptions {
  std::vector<int> steps{1, 5, 15, kFreeRun};      ///< steps ahead, 1 to 100000, or kFreeRun
  InitialState initial = InitialState::kMeasured;  ///< of an ARX model's free simulation; a switched model starts from
                                                   ///< measured samples
  bool responses = false;                          ///< also the series of poles; ARX: zeros, responses, errors by steps
  double pixels_per_unit = 0;    ///< outlines: 0: the recording's own mean calm height is the model's 1
  bool own_input_scale = false;  ///< outlines: input 1 is this recording's 95th percentile instead of the
                                 ///< training's: another microphone, another gain
  bool align = true;             ///< outlines: move inputs that come after the motion that they cause
  double play_seconds = 60;      ///< outlines: > 0: how long the model plays freely for the fidelity figures
  bool fidelity = true;          ///< outlines: off: it costs a second or two
  std::uint64_t seed = 1;        ///< of what plays with noise
};

/// Validates a model on a recording; a plain ARX model also on several, in one table that names what is fitted badly; a
/// chain also on several, or on a windy recording and its calm twin.
/// The report has the fields of `wisp validate --json` for that kind of model, and the series of its plots.
/// Errors, naming the recording: channels that it has not, another rate or number of control points than the model's,
/// too few rows, options out of range; kStopped.
Result<Report> validate(const Model& model, std::span<const Recording> recordings,
                        const ValidationOptions& options = {}, const Progress& progress = {});

/// The same on one recording.
Result<Report> validate(const Model& model, const Recording& recording, const ValidationOptions& options = {},
                        const Progress& progress = {});

/// Which predictions.
struct PredictionOptions {
  int steps = 1;                                   ///< ahead, 1 to 100000, or kFreeRun: from the inputs alone
  InitialState initial = InitialState::kMeasured;  ///< of an ARX model's free run; others start from measured samples
};

/// What a model says of a recording, row by row, as a recording: its inputs, and for every output the measured channel
/// NAME, NAME.predicted and, but for switched models, NAME.low and NAME.high: the 95 % interval by the model's own
/// noise. NaN where there is no prediction: at the beginning of an episode, and after missing samples. Of an outline in
/// the recording's pixels.
/// Errors, naming the recording: channels that it has not, another rate than the model's; a segment chain, which
/// predicts no rows; a start that the model cannot have; steps out of range.
Result<Recording> predict(const Model& model, const Recording& recording, const PredictionOptions& options = {});

/// A recording whose channels `names`, one an input of the model, are in the units of those inputs, as validate() and
/// predict() hear them: as loud as the microphone of the training heard them, where both say how loud 1 was, over what
/// was 1 when the model was learned. `own_gain`: over the recording's own 95th percentile while it blows, where the
/// model is one of an outline: another microphone heard it. What already has an input's unit stays as it is: a model
/// played it. Errors, naming the recording: a channel that it has not; what it says of its loudness is not a positive
/// number.
///
/// Precondition: as many names as inputs.
Result<Recording> in_model_units(const Model& model, Recording recording, std::span<const std::string> names,
                                 bool own_gain = false);

/// A model and what it is called among others.
struct NamedModel {
  std::string name;
  Model model;
};

/// Holds several ARX or switched models against one recording: the table `compared` has the fit of every output by
/// every model, over the rows that all models predict; series are what was measured and what each model said in the
/// last of `options.steps`. Of the options, steps and initial count. Errors: as predict(), naming the model; a model of
/// an outline; kStopped.
Result<Report> compare(std::span<const NamedModel> models, const Recording& recording,
                       const ValidationOptions& options = {}, const Progress& progress = {});

/// The same against several recordings, in one table; series are of the first.
Result<Report> compare(std::span<const NamedModel> models, std::span<const Recording> recordings,
                       const ValidationOptions& options = {}, const Progress& progress = {});

/// Outlines of a recording, row by row: points x, y from the base's left over the tip to the base's right, in the
/// clip's pixels, whose centres are at whole numbers. Empty where a row has no outline.
using OutlineRows = std::vector<std::vector<std::array<double, 2>>>;

/// The report, and what pictures of it show.
struct ValidatedOutline {
  Report report;
  OutlineRows captured;
  OutlineRows simulated;        ///< from the inputs alone; of a model without inputs the longest prediction up to five
                                ///< frames ahead, since it has nothing to follow
  std::string simulated_label;  ///< "simulated from the input alone", "predicted 5 frames ahead"
  OutlineRows played;           ///< the model with noise along the recording's inputs
  double pixels_per_unit = 1;   ///< of the model's unit, in this clip
};

/// Validates an outline model on a recording of an outline in pixels. What the training's microphone heard is put on
/// the training's scale, unless `own_input_scale`; extinctions are left out of what the dynamics are judged by, and the
/// rule of extinction is judged apart. A recording with other knots is expressed in the model's, with a warning. The
/// report has gain, rows, channels, points, J, tip, overlap, fidelity, extinction, and the
/// series of plots: `tip`, the inputs, `flicker`.
/// Errors, naming the recording: the model is not an outline or its dynamics are not ARX; another number of control
/// points than the model's; another rate; an input that the recording has not; no outline in any row; kStopped.
Result<ValidatedOutline> validate_outline(const Model& model, const Recording& recording,
                                          const ValidationOptions& options = {}, const Progress& progress = {});

}  // namespace wisp
