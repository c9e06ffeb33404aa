#pragma once
// Predictions of a recording by an ARX model: k steps ahead from its measured past, or simulated from the input alone.
//
// Source: L. Ljung, System Identification (2nd ed.), section 3.2 (k-step prediction), 16.4 (fit); J_k as in L.-M.
// Reissell and D. K. Pai (2001), section 3.4. A k-step prediction of y(t) uses outputs up to y(t−k) and all inputs up
// to t. Its error is computed as Σ F_j e(t−j) over j < k, with F the impulse response from noise to output.

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "learn/rows/arx_design.hpp"
#include "learn/rows/arx_rows.hpp"
#include "wisp/base/result.hpp"
#include "wisp/learn/arx_recipe.hpp"
#include "wisp/model/arx.hpp"
#include "wisp/record/recording.hpp"

namespace wisp {

/// Receives simulated deviations of all outputs, row by row, from row `first` of the recording on.
using SimulatedRows = std::function<void(std::size_t first, std::size_t rows, const double* values)>;

struct FreeRunStart {
  InitialState initial = InitialState::kMeasured;
  int first_sample = 0;    ///< first simulated row of an episode, at least the model's history; kZero starts at row 0
  bool as_played = false;  ///< single precision, as run/ steps the stored model
};

/// Simulates one recording block by block. Simulation restarts at every episode and after every gap in the inputs. Rows
/// that cannot be simulated are skipped. Precondition: the signals' offsets are the model's operating point.
void free_run(const ArxModel& model, const Signals& signals, std::size_t recording, const FreeRunStart& start,
              const SimulatedRows& visit);

struct PredictOptions {
  int steps = 1;                                   ///< 1 … 100000, or kFreeRun
  InitialState initial = InitialState::kMeasured;  ///< initial state of a free simulation (kFreeRun)
};

/// Predicts all rows of a recording; history never crosses episodes. Returns one series per output, in its own unit, as
/// long as the recording. NaN in an episode's first rows (longest lag + steps − 1 rows; for kFreeRun the longest lag,
/// or none with kZero), and where this row, one of the steps − 1 rows before, or a sample at their lags is missing. A
/// free simulation needs only inputs after its start, and restarts after a gap in them. Errors: a channel missing from
/// the recording, channels that do not fit the model, steps out of range.
Result<std::vector<std::vector<double>>> predict(const ArxModel& model, const Recording& recording,
                                                 const ChannelChoice& channels, const PredictOptions& options = {});

/// Accuracy of a model's predictions over recordings.
struct PredictionFigures {
  int steps = 1;                    ///< steps ahead, or kFreeRun
  std::size_t rows = 0;             ///< number of rows predicted and measured
  std::vector<double> mean_square;  ///< mean squared error per output, its unit²
  std::vector<double> fit_percent;  ///< 100(1 − ‖y − ŷ‖/‖y − ȳ‖) over these rows, per output; 0 where y is constant
  std::vector<double> j;  ///< J_k: mean absolute error per output, its unit
};

struct FigureOptions {
  std::vector<int> steps{1, 5, 15, kFreeRun};
  InitialState initial = InitialState::kMeasured;
  std::optional<int> first_sample;  ///< first row of an episode that is predicted one step ahead, 0-based, at least
                                    ///< the model's history; unset: the model's history
};

/// Prediction errors over all recordings, per number of steps. Errors: as predict, and where nothing can be predicted.
Result<std::vector<PredictionFigures>> prediction_figures(const ArxModel& model, std::span<const Recording> recordings,
                                                          const ChannelChoice& channels,
                                                          const FigureOptions& options = {});

/// Number of steps after which the noise of a free simulation has reached its full variance.
inline constexpr int kSettledSteps = 2000;

/// Standard deviations of k-step prediction errors for k = 1 … steps, from the model's own noise: [output][k − 1]. A
/// prediction ±1.96 sd is its 95 % interval (for kFreeRun take kSettledSteps). Precondition: steps >= 1.
std::vector<std::vector<double>> prediction_sd(const ArxModel& model, int steps);

/// Checks numbers of steps. Errors: an empty list, or a number that is neither 1 to 100000 nor kFreeRun.
Result<void> check_steps(std::span<const int> all);

/// Sums of errors over the rows for one number of steps.
class Tally {
 public:
  explicit Tally(int outputs) : square_(outputs), y_(outputs), y_square_(outputs), size_(outputs) {}

  std::size_t rows() const { return rows_; }

  /// Adds errors: one column per output, one row per sample; none may be NaN.
  void add_errors(const Eigen::Ref<const Eigen::MatrixXd>& errors);

  void add_output(int i, const Eigen::Ref<const Eigen::VectorXd>& deviations);

  /// Adds the errors of simulated rows [first, first + rows) of a recording: `values` are the simulated deviations, row
  /// by row. Rows with an output not measured are skipped.
  void add_simulated(const Signals& signals, std::size_t recording, std::size_t first, std::size_t rows,
                     const double* values);

  PredictionFigures figures(int steps) const;

 private:
  std::size_t rows_ = 0;
  std::vector<double> square_;
  std::vector<double> y_;
  std::vector<double> y_square_;
  std::vector<double> size_;
};

/// Errors of free simulation over all recordings.
///
/// Preconditions: the signals' offsets are the model's operating point; start.first_sample >= the model's history.
Tally free_run_tally(const ArxModel& model, const Signals& signals, const FreeRunStart& start);

/// prediction_figures() of signals whose offsets are the model's operating point and whose scales are 1.
Result<std::vector<PredictionFigures>> figures_of(const ArxModel& model, const Signals& signals,
                                                  const FigureOptions& options);

}  // namespace wisp
