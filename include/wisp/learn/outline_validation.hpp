#pragma once
// A model of an outline held against a recording that it may or may not have learned from.

#include <cstdint>
#include <string>
#include <vector>

#include "wisp/base/result.hpp"
#include "wisp/learn/fidelity.hpp"
#include "wisp/learn/outline_figures.hpp"
#include "wisp/learn/outline_units.hpp"
#include "wisp/model/model.hpp"
#include "wisp/record/recording.hpp"

namespace wisp {

/// How to validate.
struct OutlineValidationOptions {
  std::vector<int> steps = kJudgedSteps;  ///< steps ahead that are judged; kFreeRun among them
  int shown_steps = 5;                    ///< of the predicted outlines of a model without inputs; 1 … 100000
  std::uint64_t seed = 1;                 ///< of the synthesized life
};

/// What a model makes of a recording.
struct OutlineValidation {
  OutlineLayout layout;              ///< of the recording
  OutlineLayout synthesized_layout;  ///< of `synthesized`
  double pixels_per_unit = 0;        ///< the recording's own mean calm height
  OutlineFigures figures;
  Fidelity fidelity;               ///< of the synthesized life against the recording
  int predicted_steps = kFreeRun;  ///< of `predicted`: free simulation from the inputs, or so many steps ahead
  std::vector<std::vector<double>>
      predicted;          ///< control points x0, y0, … a row, in pixels; empty where there are none
  Recording synthesized;  ///< the model at play with its noise, driven by the recording's inputs; model units
  double held_share = 0;  ///< of the synthesized steps in which an output was held at its range
};

/// Holds a model of an outline against a recording in pixels.
/// A model with inputs is simulated from them alone; one without has nothing to follow, so its predicted outlines are
/// `shown_steps` ahead of measured ones, and its figures at kFreeRun are those of its mean shape.
/// An input's scale is the model's where the recording's unit is the one that the model learned from, and otherwise the
/// recording's own 95th percentile while it blows.
/// Errors: the model is no outline; the recording is none, has other control points, knots or rate than the model, or
/// has not an input that the model takes; too few rows.
Result<OutlineValidation> validate_outline(const Model& model, const Recording& recording,
                                           const OutlineValidationOptions& options = {});

}  // namespace wisp
