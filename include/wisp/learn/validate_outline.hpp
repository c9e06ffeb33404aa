#pragma once
// An outline model validated on a recording that it was not learned from: what it predicts, what it does from its
// inputs alone, and how like the recording it is when it plays freely.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "wisp/base/progress.hpp"
#include "wisp/base/report.hpp"
#include "wisp/base/result.hpp"
#include "wisp/learn/validate.hpp"
#include "wisp/model/model.hpp"
#include "wisp/record/recording.hpp"

namespace wisp {

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
/// report has gain, rows, channels, points, J, tip, overlap, fidelity, static_gain, true_input, extinction, and the
/// series of plots: `tip`, the inputs, `flicker`.
/// Errors, naming the recording: the model is not an outline or its dynamics are not ARX; another number of control
/// points than the model's; another rate; an input that the recording has not; no outline in any row; kStopped.
Result<ValidatedOutline> validate_outline(const Model& model, const Recording& recording,
                                          const ValidationOptions& options = {}, const Progress& progress = {});

}  // namespace wisp
