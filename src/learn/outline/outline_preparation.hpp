#pragma once
// Prepares recordings of outlines for estimation.

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "learn/outline/outline_inputs.hpp"
#include "learn/outline/outline_units.hpp"
#include "learn/rows/arx_design.hpp"
#include "wisp/record/recording.hpp"

namespace wisp {

struct Reknotted {
  Recording recording;  ///< the recording with new outputs and attribute `knots`
  double rms = 0;       ///< RMS distance between old and new curves at equal parameters, in the outputs' unit; 0 if no
                        ///< row has an outline
};

/// Converts a recording's outlines to other knots. In every row the curve keeps its ends and is fitted to the old curve
/// by least squares at 200 equally spaced parameters, with the same number of control points.
///
/// Precondition: layout is the recording's; `knots` has as many values as its own and is valid (valid_knots).
Reknotted with_knots(const Recording& recording, const OutlineLayout& layout, std::span<const double> knots);

struct PreparationOptions {
  std::optional<std::vector<std::string>> inputs;  ///< unset: all inputs of the first recording
  RegressorShape shape{.powers = true};
  double pixels_per_unit = 0;  ///< 0: each recording's resting_height_pixels()
};

/// Recordings in the model's units and knots, with regressors as inputs.
struct PreparedOutlines {
  OutlineLayout layout;  ///< layout of the prepared recordings, outputs first
  std::vector<OutlineInput> inputs;
  RegressorShape shape;  ///< kinds of regressors; no powers without inputs
  ChannelChoice channels;
  std::vector<double> pixels_per_unit;  ///< per recording
  std::vector<Recording> recordings;
  std::vector<std::vector<double>> rest;  ///< mean shape per recording over undisturbed_rows(); empty without such rows
  std::vector<std::string> warnings;      ///< recordings with other knots, or tracked in another colour
};

/// Prepares recordings. Errors: as common_layout() and scaled_input(); a recording without an outline in any row.
Result<PreparedOutlines> prepare_outlines(std::span<const Recording> recordings, const PreparationOptions& options);

/// Prepares recordings for given knots and inputs with known scales. Errors: as outline_layout(); a recording without
/// an outline in any row.
///
/// Precondition: there are recordings; each has the inputs, and as many control points as the knots.
Result<PreparedOutlines> prepare_outlines(std::span<const Recording> recordings, const std::vector<double>& knots,
                                          std::vector<OutlineInput> inputs, RegressorShape shape,
                                          double pixels_per_unit);

/// Number of rows with all outputs and all regressors.
std::size_t complete_rows(std::span<const Recording> recordings, const ChannelChoice& channels);

/// Recordings divided into a training and a held-out part.
struct OutlineParts {
  std::vector<Recording> learned;
  std::vector<Recording> held_out;
};

/// Holds out the last `share` of every recording's complete rows. If an episode boundary lies within a tenth of the
/// recording's rows from that cut, the nearest one replaces it. A share of 0 holds out nothing.
OutlineParts hold_out(std::span<const Recording> recordings, const ChannelChoice& channels, double share);

}  // namespace wisp
