#pragma once
// The plots of `wisp validate --figures` for outlines.

#include <filesystem>

#include "command.hpp"
#include "terminal.hpp"
#include "wisp/learn/outline_units.hpp"
#include "wisp/learn/validation.hpp"
#include "wisp/model/model.hpp"

namespace wisp::cli {

/// An outline's validation and the layout of the recording that it is of.
struct Judged {
  OutlineLayout layout;
  OutlineValidation found;

  /// The prediction that pictures show: free simulation where an input drives it, else the longest look ahead up to
  /// five frames, since an outline without inputs has nothing to follow.
  const PredictedOutlines& shown() const;
};

/// What a prediction is called in a legend.
std::string shown_as(const PredictedOutlines& predicted);

/// Writes residual standard deviations per control point with their 95 % intervals, spectra of the tip, the tip over
/// time, and the input where there is one, into a folder (made where it is missing), each as PNG and SVG.
/// Errors: a file cannot be written.
Result<void> write_validation_figures(const std::filesystem::path& folder, const Model& model,
                                      const Recording& recording, const Judged& judged);

}  // namespace wisp::cli
