#pragma once
// Learning an outline: from recordings of its control points to a model that moves like it, and what to think of it.

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "learn/fidelity/fidelity.hpp"
#include "learn/outline/outline_alignment.hpp"
#include "learn/outline/outline_figures.hpp"
#include "learn/outline/outline_preparation.hpp"
#include "wisp/base/progress.hpp"
#include "wisp/base/result.hpp"
#include "wisp/learn/outline_recipe.hpp"
#include "wisp/model/model.hpp"
#include "wisp/record/recording.hpp"

namespace wisp {

/// Figures of a free play along the recording in which most moves.
struct OutlineTrial {
  double unsteadiness = 0;  ///< of the recordings: mean square difference of neighbouring frames over that of frames
                            ///< picked at random; 0 moves steadily, 1 is frames in random order (half the ratio of
                            ///< J. von Neumann, Annals of Mathematical Statistics 12 (1941))
  double held_share = 0;    ///< of steps in which something was clamped to its range
  std::vector<double> sd_ratio;  ///< per output, played over recorded; 1 where nothing moves
  double crossed = 0;            ///< share of played outlines that cross themselves
  double crossed_recorded = 0;   ///< and of recorded ones
  double outside = 0;            ///< share of played outlines farther from every recorded one than 99 % of those of the
                                 ///< last 40 % of the rows are from the rows before
  std::optional<Bounded> half_second;  ///< normalised energy distance of windows; nothing where that is too short
  std::optional<Bounded> two_seconds;  ///< likewise
};

/// Plays a model along the inputs of the liveliest of the recordings in the model's units; `original` are the same
/// recordings with their inputs, in step.
/// Errors: as synthesize().
Result<OutlineTrial> try_outline(const Model& model, const PreparedOutlines& prepared,
                                 std::span<const Recording> original, std::uint64_t seed);

/// How good the model is.
struct OutlineSummary {
  double rate_hz = 0;
  std::vector<OutlineInput> inputs;
  std::size_t points = 0;
  OutlineDynamics dynamics;                ///< of the returned model, without its noise's rows
  double radius = 0;                       ///< spectral
  std::vector<InputAlignment> alignment;   ///< of every recording's inputs
  std::size_t rows_learned = 0;            ///< complete rows that the judged dynamics were learned from,
  std::size_t rows_held_out = 0;           ///< and those held out; the returned model is learned from both
  OutlineFigures learned;                  ///< on what was learned from
  std::optional<OutlineFigures> held_out;  ///< on what was held out; nothing where that is too short
  std::vector<double> residual_sd;         ///< one step ahead, one an output
  std::size_t resampled_rows = 0;          ///< of residuals; 0: Gaussian noise
  OutlineTrial trial;
  double pixels_per_unit = 0;  ///< of the first recording
  std::vector<std::string> warnings;
  Usable usable;
  std::string code{};  ///< of the criterion that was missed
};

/// A model of an outline and what to think of it.
struct OutlineFit {
  Model model;
  OutlineSummary summary;
};

/// Learns a model from recordings of an outline in pixels (outline_units.hpp), without a rule of extinction and with
/// every recording's inputs on the scale that it has. The model has the knots of the first recording; recordings with
/// others are expressed in those, with a warning.
/// Errors, naming the recording: not an outline, another number of points than the first, rates that differ, inputs
/// that it has not, too few rows, a recipe out of range; kStopped.
Result<OutlineFit> fit_outline(std::span<const Recording> recordings, const OutlineRecipe& recipe = {},
                               const Progress& progress = {});

}  // namespace wisp
