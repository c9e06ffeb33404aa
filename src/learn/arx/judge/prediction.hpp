#pragma once
// What an ARX model says about a recording: k steps ahead from its measured past, or from the input alone.
//
// Source: L. Ljung, System Identification (2nd ed.), section 3.2 (k-step prediction), 16.4 (fit); J_k as in
// L.-M. Reissell and D. K. Pai (2001), section 3.4. A k-step prediction of y(t) uses outputs up to y(t−k) and all
// inputs up to t; its error is Σ F_j e(t−j) over j < k, F the impulse response of the noise, which is how it is
// computed.

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "learn/arx/rows/arx_orders.hpp"
#include "wisp/base/result.hpp"
#include "wisp/learn/arx_recipe.hpp"
#include "wisp/model/arx.hpp"
#include "wisp/record/recording.hpp"

namespace wisp {

/// How to predict.
struct PredictOptions {
  int steps = 1;                                   ///< 1 … 100000, or kFreeRun
  InitialState initial = InitialState::kMeasured;  ///< for kFreeRun
};

/// Predicts all rows of a recording, every episode apart.
/// Returns one series an output, in its own unit, as long as the recording; NaN where there is no prediction: in the
/// first rows of an episode (longest lag + steps − 1 of them; for kFreeRun the longest lag), and where a sample that
/// the prediction needs is missing. A free simulation needs inputs only and starts again after a gap in them. Errors: a
/// channel that the recording has not, channels that do not fit the model, steps out of range.
Result<std::vector<std::vector<double>>> predict(const ArxModel& model, const Recording& recording,
                                                 const ChannelChoice& channels, const PredictOptions& options = {});

/// How far predictions of a model are from recordings.
struct PredictionFigures {
  int steps = 1;                    ///< or kFreeRun
  std::size_t rows = 0;             ///< rows that were predicted and measured
  std::vector<double> mean_square;  ///< of the error, per output, its unit²
  std::vector<double> fit_percent;  ///< 100(1 − ‖y − ŷ‖/‖y − ȳ‖) over those rows, per output; 0 where y is constant
  std::vector<double> j;  ///< J_k: mean norm of the error, per group of outputs: of one here
};

/// Which figures.
struct FigureOptions {
  std::vector<int> steps{1, 5, 15, kFreeRun};
  InitialState initial = InitialState::kMeasured;
  std::optional<int> first_sample;  ///< first row of an episode for one step, 0-based, at least the model's history;
                                    ///< unset: the model's history
};

/// The error of predictions over all recordings together, for every number of steps. All numbers of steps are computed
/// in one pass over the data.
/// Errors: as predict, and where nothing can be predicted.
Result<std::vector<PredictionFigures>> prediction_figures(const ArxModel& model, std::span<const Recording> recordings,
                                                          const ChannelChoice& channels,
                                                          const FigureOptions& options = {});

/// Standard deviations of k-step prediction errors for k = 1 … steps, by the model's own noise: per output, then per k.
/// ±1.96 of them around a prediction is its 95 % interval (for kFreeRun take steps large enough that they settle).
/// `noise_covariance` is ny × ny, row-major (ArxSummary has it); empty: the model's own residual noise.
///
/// Precondition: steps >= 1.
std::vector<std::vector<double>> prediction_sd(const ArxModel& model, std::span<const double> noise_covariance,
                                               int steps);

}  // namespace wisp
