#pragma once
// `wisp validate` for models whose outputs are plain channels, and plots of an identification, drawn from the series of
// a report: poles and zeros, step and frequency responses with their bands, residual correlations, predictions.

#include <filesystem>
#include <vector>

#include "command.hpp"
#include "terminal.hpp"
#include "wisp/base/report.hpp"
#include "wisp/base/result.hpp"
#include "wisp/model/model.hpp"
#include "wisp/record/recording.hpp"

namespace wisp::cli {

/// Writes plots of the report's series into a folder (created if missing), each as PNG and SVG: `poles-zeros`, per
/// output `step` and `frequency`, `residuals`, and for a validation `simulation`, `prediction` and `prediction-error`.
/// Of more than 4 outputs or 16 inputs only the first 4 or 16 are drawn, with a warning.
/// Errors: a file cannot be written.
Result<void> write_arx_figures(const std::filesystem::path& folder, const Model& model, const Report& report,
                               Terminal& terminal);

/// Validates a model on one or more tables: fit, mean absolute (J) and RMS errors per number of steps, coverage of the
/// model's own intervals, and residual tests; with --figures also their plots.
/// Errors: the table cannot be read or lacks the model's channels; a flag that draws nothing for this kind of model.
Result<void> validate_plain(const Model& model, const std::vector<int>& steps, const Arguments& arguments,
                            Terminal& terminal);

/// Returns the rate that a table without one takes, Hz: the model's. 0, none, if the model resamples its recordings:
/// the rate before is not in the model.
double usual_rate(const Model& model);

/// Reads the recording on which a model with plain outputs is validated, within --range. --inputs and --outputs, if
/// given, name the columns of the model's channels, in the model's order; a table without a rate takes usual_rate().
/// Errors: as read_table() and in_range(); a number of names other than the model's number of channels.
Result<Recording> table_for(const Model& model, const std::string& path, const Arguments& arguments);

}  // namespace wisp::cli
