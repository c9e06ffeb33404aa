#include "learn/arx/judge/prediction.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>

#include "learn/arx/fit/arx_errors.hpp"
#include "learn/arx/judge/free_run.hpp"

namespace wisp {
namespace {

constexpr int kMaxSteps = 100000;

Result<void> check_steps(int steps) {
  if (steps == kFreeRun || (steps >= 1 && steps <= kMaxSteps)) return {};
  return Error{"a prediction of " + std::to_string(steps) + " steps was requested, expected 1 to 100000"};
}

Result<void> check_figures(const ArxModel& model, const FigureOptions& options) {
  if (options.steps.empty()) return Error{"no number of steps was requested"};
  for (int steps : options.steps) {
    if (auto ok = check_steps(steps); !ok) return ok;
  }
  if (options.first_sample && *options.first_sample < model.orders.history()) {
    return Error{"the first sample is " + std::to_string(*options.first_sample) + ", but the model's history is " +
                 std::to_string(model.orders.history()) + " samples"};
  }
  return {};
}

// Errors of k-step predictions for k = 1, 2, …, block by block: err_k(t) = err_{k−1}(t) + F_{k−1} e(t − k + 1).
class StepErrors {
 public:
  StepErrors(const ArxModel& model, const Signals& signals, int steps)
      : filter_(model, signals), response_(noise_response(model, steps)), steps_(steps) {}

  /// Calls visit(k, first, errors) for k = 1 … steps and every block of a run; `errors` has one column an output and
  /// row 0 is row `first` of the recording. Rows before run.begin + k − 1 have no k-step prediction.
  template <class Visit>
  void run(const RowRun& run, Visit visit) {
    const int ny = static_cast<int>(response_.front().rows());
    const Eigen::Index before = steps_ - 1;
    shocks_.setZero(static_cast<Eigen::Index>(kBlockRows) + before, ny);
    for (std::size_t first = run.begin; first < run.end; first += kBlockRows) {
      const auto rows = static_cast<Eigen::Index>(std::min(kBlockRows, run.end - first));
      filter_.errors({run.recording, first, first + static_cast<std::size_t>(rows)}, shocks_.middleRows(before, rows));
      sum_ = shocks_.middleRows(before, rows);
      visit(1, first, sum_);
      for (int k = 2; k <= steps_; ++k) {
        const Eigen::MatrixXd& weights = response_[k - 1];
        for (int i = 0; i < ny; ++i) {
          for (int j = 0; j < ny; ++j) {
            if (weights(i, j) != 0) sum_.col(i) += weights(i, j) * shocks_.col(j).segment(before - (k - 1), rows);
          }
        }
        visit(k, first, sum_);
      }
      if (before > 0) shocks_.topRows(before) = shocks_.middleRows(rows, before).eval();
    }
  }

 private:
  ErrorFilter filter_;
  std::vector<Eigen::MatrixXd> response_;
  int steps_;
  Eigen::MatrixXd shocks_;
  Eigen::MatrixXd sum_;
};

// The errors of predictions of one finite number of steps.
Tally steps_tally(const ArxModel& model, const Signals& signals, int steps, int first_sample) {
  Tally tally(signals.outputs);
  StepErrors errors(model, signals, steps);
  for (const RowRun& run : plan_rows(signals, layout_of_model(model), first_sample).runs) {
    errors.run(run, [&](int k, std::size_t first, const Eigen::MatrixXd& block) {
      const std::size_t start = run.begin + static_cast<std::size_t>(k) - 1;
      const auto skip = static_cast<Eigen::Index>(start > first ? start - first : 0), rows = block.rows() - skip;
      if (k < steps || rows <= 0) return;
      tally.add_errors(block.bottomRows(rows));
      for (int i = 0; i < signals.outputs; ++i) {
        const double* measured = signals.samples[run.recording][i].data() + first + skip;
        tally.add_output(i, (Eigen::Map<const Eigen::ArrayXd>(measured, rows) - signals.offset[i]).matrix());
      }
    });
  }
  return tally;
}

std::vector<std::vector<double>> nothing_predicted(const Signals& signals) {
  const std::vector<double> series(signals.samples[0].front().size(), std::numeric_limits<double>::quiet_NaN());
  return std::vector<std::vector<double>>(signals.outputs, series);
}

std::vector<std::vector<double>> predict_steps(const ArxModel& model, const Signals& signals, int steps) {
  auto out = nothing_predicted(signals);
  StepErrors errors(model, signals, steps);
  for (const RowRun& run : plan_rows(signals, layout_of_model(model), model.orders.history()).runs) {
    errors.run(run, [&](int k, std::size_t first, const Eigen::MatrixXd& block) {
      if (k != steps) return;
      for (int i = 0; i < signals.outputs; ++i) {
        for (Eigen::Index t = 0; t < block.rows(); ++t) {
          const std::size_t row = first + static_cast<std::size_t>(t);
          if (row + 1 >= run.begin + k) out[i][row] = signals.samples[0][i][row] - block(t, i);
        }
      }
    });
  }
  return out;
}

}  // namespace

Result<std::vector<std::vector<double>>> predict(const ArxModel& model, const Recording& recording,
                                                 const ChannelChoice& channels, const PredictOptions& options) {
  if (auto ok = check_steps(options.steps); !ok) return ok.error();
  const auto signals = signals_of_model(model, {&recording, 1}, channels);
  if (!signals) return signals.error();
  if (options.steps != kFreeRun) return predict_steps(model, *signals, options.steps);
  auto out = nothing_predicted(*signals);
  free_run(model, *signals, 0, {options.initial, model.orders.history()},
           [&](std::size_t first, std::size_t rows, const double* values) {
             for (std::size_t t = first; t < first + rows; ++t) {
               for (int i = 0; i < signals->outputs; ++i) out[i][t] = *values++ + model.output_mean[i];
             }
           });
  return out;
}

Result<std::vector<PredictionFigures>> prediction_figures(const ArxModel& model, std::span<const Recording> recordings,
                                                          const ChannelChoice& channels, const FigureOptions& options) {
  const auto signals = signals_of_model(model, recordings, channels);
  if (!signals) return signals.error();
  return figures_of(model, *signals, options);
}

Result<std::vector<PredictionFigures>> figures_of(const ArxModel& model, const Signals& signals,
                                                  const FigureOptions& options) {
  if (auto ok = check_figures(model, options); !ok) return ok.error();
  const int first_sample = options.first_sample.value_or(model.orders.history());
  std::vector<PredictionFigures> out;
  for (int steps : options.steps) {
    const Tally tally = steps == kFreeRun ? free_run_tally(model, signals, {options.initial, first_sample})
                                          : steps_tally(model, signals, steps, first_sample);
    if (tally.rows() == 0) {
      return Error{"no row can be predicted: no stretch without gaps is longer than the model's history of " +
                   std::to_string(model.orders.history()) + " samples" +
                   (steps > 1 ? " and " + std::to_string(steps) + " steps" : "")};
    }
    out.push_back(tally.figures(steps));
  }
  return out;
}

std::vector<std::vector<double>> prediction_sd(const ArxModel& model, std::span<const double> noise_covariance,
                                               int steps) {
  const int ny = model.orders.outputs();
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(ny, ny);
  if (noise_covariance.empty()) {
    for (int i = 0; i < ny; ++i) covariance(i, i) = model.noise.sd[i] * model.noise.sd[i];
    if (model.noise.rank > 0) {
      const Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>> mixing(
          model.noise.mixing.data(), ny, model.noise.rank);
      covariance += mixing * mixing.transpose();
    }
  } else {
    for (int i = 0; i < ny; ++i) {
      for (int j = 0; j < ny; ++j) covariance(i, j) = noise_covariance[static_cast<std::size_t>(i) * ny + j];
    }
  }
  std::vector<std::vector<double>> sd(ny);
  Eigen::VectorXd variance = Eigen::VectorXd::Zero(ny);
  for (const Eigen::MatrixXd& weights : noise_response(model, steps)) {
    variance += (weights * covariance * weights.transpose()).diagonal();
    for (int i = 0; i < ny; ++i) sd[i].push_back(std::sqrt(variance[i]));
  }
  return sd;
}

namespace {

// Moves the rows without missing samples to the front. Returns how many they are.
Eigen::Index drop_missing(Eigen::Index rows, Eigen::MatrixXd& measured, Eigen::MatrixXd& errors) {
  if (!errors.topRows(rows).hasNaN()) return rows;
  Eigen::Index count = 0;
  for (Eigen::Index t = 0; t < rows; ++t) {
    if (errors.row(t).hasNaN()) continue;
    measured.row(count) = measured.row(t);
    errors.row(count) = errors.row(t);
    ++count;
  }
  return count;
}

}  // namespace

void Tally::add_errors(const Eigen::Ref<const Eigen::MatrixXd>& errors) {
  rows_ += static_cast<std::size_t>(errors.rows());
  for (std::size_t i = 0; i < square_.size(); ++i) {
    square_[i] += errors.col(static_cast<Eigen::Index>(i)).squaredNorm();
  }
  for (std::size_t g = 0; g < norm_.size(); ++g) {
    norm_[g] += errors.middleCols(static_cast<Eigen::Index>(g) * group_, group_).rowwise().norm().sum();
  }
}

void Tally::add_output(int i, const Eigen::Ref<const Eigen::VectorXd>& deviations) {
  y_[i] += deviations.sum();
  y_square_[i] += deviations.squaredNorm();
}

PredictionFigures Tally::figures(int steps) const {
  PredictionFigures out;
  out.steps = steps;
  out.rows = rows_;
  const double n = static_cast<double>(rows_);
  for (std::size_t i = 0; i < square_.size(); ++i) {
    out.mean_square.push_back(square_[i] / n);
    const double variance = y_square_[i] / n - (y_[i] / n) * (y_[i] / n);
    out.fit_percent.push_back(variance > 0 ? 100 * (1 - std::sqrt(out.mean_square[i] / variance)) : 0);
  }
  for (double sum : norm_) out.j.push_back(sum / n);
  return out;
}

void Tally::add_simulated(const Signals& signals, std::size_t recording, std::size_t first, std::size_t rows,
                          const double* values) {
  const auto count = static_cast<Eigen::Index>(rows);
  const Eigen::Map<const Eigen::MatrixXd> simulated(values, signals.outputs, count);
  Eigen::MatrixXd measured(count, signals.outputs);
  for (int i = 0; i < signals.outputs; ++i) {
    const double* samples = signals.samples[recording][i].data() + first;
    measured.col(i) = Eigen::Map<const Eigen::VectorXd>(samples, count).array() - signals.offset[i];
  }
  Eigen::MatrixXd errors = measured - simulated.transpose();
  const Eigen::Index whole = drop_missing(count, measured, errors);
  add_errors(errors.topRows(whole));
  for (int i = 0; i < signals.outputs; ++i) add_output(i, measured.col(i).head(whole));
}

Tally free_run_tally(const ArxModel& model, const Signals& signals, const FreeRunStart& start) {
  Tally tally(signals.outputs);
  for (std::size_t r = 0; r < signals.samples.size(); ++r) {
    free_run(model, signals, r, start, [&](std::size_t first, std::size_t rows, const double* values) {
      tally.add_simulated(signals, r, first, rows, values);
    });
  }
  return tally;
}

}  // namespace wisp
