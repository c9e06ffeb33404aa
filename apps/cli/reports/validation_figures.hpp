#pragma once
// The plots of `wisp validate --figures` for outlines.

#include <filesystem>

#include "wisp/base/report.hpp"
#include "wisp/base/result.hpp"
#include "wisp/model/model.hpp"

namespace wisp::cli {

/// Writes residual standard deviations per control point with their 95 % intervals, and the series of the report of
/// validate_outline(): the tip and the inputs over time, spectra of the tip. Into a folder (made where it is missing),
/// each as PNG and SVG.
/// Errors: a file cannot be written.
Result<void> write_validation_figures(const std::filesystem::path& folder, const Model& model, const Report& report);

}  // namespace wisp::cli
