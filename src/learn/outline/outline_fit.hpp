#pragma once
// Learns the model of an outline from recordings of its control points, with figures and a verdict.

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

/// Figures of a free play driven by the recording with the most motion.
struct OutlineTrial {
  double unsteadiness = 0;  ///< of the recordings: mean square difference of neighbouring frames over that of random
                            ///< pairs; 0: steady, 1: random order (half the ratio of J. von Neumann, Annals of
                            ///< Mathematical Statistics 12 (1941))
  double held_share = 0;    ///< share of steps with an output clamped to its range
  std::vector<double> sd_ratio;  ///< per output, played over recorded; 1 for constant outputs
  double crossed = 0;            ///< self-intersection rate of played outlines
  double crossed_recorded = 0;   ///< self-intersection rate of recorded outlines
  double outside = 0;  ///< share of played outlines whose distance to the nearest recorded one exceeds the 99th
                       ///< percentile of distances from the last 40 % of every recording to the rest
  std::optional<Bounded> half_second;  ///< normalised energy distance of windows of 0.5 s; empty if too short
  std::optional<Bounded> two_seconds;  ///< normalised energy distance of windows of 2 s; empty if too short
};

struct OutlineSummary {
  double rate_hz = 0;
  std::vector<OutlineInput> inputs;
  std::size_t points = 0;
  OutlineDynamics dynamics;                ///< dynamics of the returned model, without residual rows
  double radius = 0;                       ///< spectral radius
  std::vector<InputAlignment> alignment;   ///< per recording and input
  std::size_t rows_learned = 0;            ///< number of complete rows that the judged dynamics were learned from
  std::size_t rows_held_out = 0;           ///< number of complete rows held out, which the returned model also uses
  OutlineFigures learned;                  ///< figures on the training rows
  std::optional<OutlineFigures> held_out;  ///< figures on the held-out rows; empty if too short
  std::vector<double> residual_sd;         ///< standard deviation of the errors one step ahead, per output
  std::size_t resampled_rows = 0;          ///< number of residual rows; 0: Gaussian noise
  OutlineTrial trial;
  double pixels_per_unit = 0;  ///< pixels per model unit in the first recording
  std::vector<std::string> warnings;
  Usable usable;
  std::string code{};  ///< code of the criterion that was missed
};

struct OutlineFit {
  Model model;
  OutlineSummary summary;
};

/// Learns a model from recordings of an outline in pixels (outline_units.hpp), without an extinction rule and with the
/// inputs at the gain that they have (see at_common_gain()). The model has the first recording's knots; recordings with
/// other knots are converted, with a warning. Errors, naming the recording: not an outline, a different number of
/// points, missing inputs, too few rows, a recipe out of range; kStopped. Precondition: equal rates.
Result<OutlineFit> fit_outline(std::span<const Recording> recordings, const OutlineRecipe& recipe = {},
                               const Progress& progress = {});

/// Fit in per cent of the tip simulated from the inputs alone, on held-out rows if there are some; NaN without inputs.
/// Below kMinFollowedPercent the inputs do not explain the motion.
double followed_percent(const OutlineSummary& summary);
constexpr double kMinFollowedPercent = 5;

/// Returns whether the model is usable, with the first reason against it or a sentence in its favour; `code` receives
/// the violated criterion's code. Judges free play, since a model that moves too little also predicts one step well.
Usable outline_verdict(const OutlineSummary& summary, std::string* code = nullptr);

/// The training record for the model's file, without extinction rule and cost.
Training outline_training(std::span<const Recording> recordings, const OutlineRecipe& recipe,
                          const OutlineSummary& summary);

}  // namespace wisp
