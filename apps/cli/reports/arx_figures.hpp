#pragma once
// Plots of an identification, drawn from the series of a report: poles and zeros, step and frequency responses with
// their bands, residual correlations, predictions.

#include <filesystem>

#include "terminal.hpp"
#include "wisp/base/report.hpp"
#include "wisp/base/result.hpp"
#include "wisp/model/model.hpp"

namespace wisp::cli {

/// Writes plots of the report's series into a folder (created if missing), each as PNG and SVG: `poles-zeros`, per
/// output `step` and `frequency`, `residuals`, and for a validation `simulation`, `prediction` and `prediction-error`.
/// For models of more than four outputs, only those of the first four, with a note.
/// Errors: a file cannot be written.
Result<void> write_arx_figures(const std::filesystem::path& folder, const Model& model, const Report& report,
                               Terminal& terminal);

}  // namespace wisp::cli
