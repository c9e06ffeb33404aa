#pragma once
// Recordings of outlines as the estimator wants them.

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "learn/arx/rows/arx_design.hpp"
#include "learn/outline/outline_inputs.hpp"
#include "learn/outline/outline_units.hpp"
#include "wisp/record/recording.hpp"

namespace wisp {

/// A recording in other knots.
struct Reknotted {
  Recording recording;  ///< its outputs changed, its attribute `knots` set
  double rms = 0;       ///< root mean square distance between old and new curves at the same parameters, in the
                        ///< outputs' unit; 0 where no row has an outline
};

/// Expresses a recording's outlines in other knots: in every row the control points, the same number, whose curve is
/// nearest to the old one by least squares at 200 even parameters, ends kept.
///
/// Precondition: layout is the recording's; `knots` has as many values as its own and is valid (valid_knots).
Reknotted with_knots(const Recording& recording, const OutlineLayout& layout, std::span<const double> knots);

/// What decides how a recording is prepared.
struct PreparationOptions {
  std::optional<std::vector<std::string>> inputs;  ///< unset: all inputs of the first recording
  RegressorShape shape{.powers = true};
  double pixels_per_unit = 0;  ///< 0: each recording's own mean calm height is 1
};

/// Recordings in the model's units and knots, with its regressors as inputs.
struct PreparedOutlines {
  OutlineLayout layout;  ///< of the prepared recordings: their outputs come first
  std::vector<OutlineInput> inputs;
  RegressorShape shape;  ///< of nothing where there are no inputs
  ChannelChoice channels;
  std::vector<double> pixels_per_unit;  ///< one a recording
  std::vector<Recording> recordings;
  std::vector<std::vector<double>> rest;  ///< of each recording its mean calm shape; empty where it is never calm
  std::vector<std::string> warnings;      ///< of recordings that came with other knots
};

/// Errors: as common_layout() and scaled_input(); a recording without an outline in any row.
Result<PreparedOutlines> prepare_outlines(std::span<const Recording> recordings, const PreparationOptions& options);

/// One recording, for knots that are given and inputs whose scale is known.
/// Errors: as outline_layout(), another number of points than the knots are for, an input that it has not, no outline
/// in any row.
Result<PreparedOutlines> prepare_outline(const Recording& recording, const std::vector<double>& knots,
                                         std::vector<OutlineInput> inputs, RegressorShape shape,
                                         double pixels_per_unit);

/// Rows with all outputs and all regressors.
std::size_t complete_rows(const Recording& recording, const ChannelChoice& channels);

/// The same of several.
std::size_t complete_rows(std::span<const Recording> recordings, const ChannelChoice& channels);

/// Both sides of the cuts.
struct OutlineParts {
  std::vector<Recording> learned;
  std::vector<Recording> held_out;
};

/// Cuts the last `share` off every recording: at the boundary of episodes nearest to there, where one lies within a
/// tenth of the recording, and otherwise in time. The last rows without an outline do not count.
OutlineParts hold_out(std::span<const Recording> recordings, const ChannelChoice& channels, double share);

}  // namespace wisp
