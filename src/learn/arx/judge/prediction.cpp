#include "learn/arx/judge/prediction.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>

#include "learn/arx/fit/arx_errors.hpp"
#include "learn/arx/judge/free_run.hpp"
#include "learn/arx/judge/prediction_tally.hpp"

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

// Figures of all finite numbers of steps.
class Tallies {
 public:
  Tallies(const ArxModel& model, const Signals& signals, const FigureOptions& options, int first_sample)
      : signals_(signals), at_(1 + *std::max_element(options.steps.begin(), options.steps.end()), -1) {
    for (int steps : options.steps) {
      if (steps == kFreeRun || at_[steps] >= 0) continue;
      at_[steps] = static_cast<int>(tallies_.size());
      tallies_.emplace_back(signals.outputs);
    }
    const int most = static_cast<int>(at_.size()) - 1;
    if (most < 1) return;
    StepErrors errors(model, signals, most);
    for (const RowRun& run : plan_rows(signals, layout_of_model(model), first_sample).runs) {
      errors.run(run, [&](int k, std::size_t first, const Eigen::MatrixXd& block) { add(run, k, first, block); });
    }
  }

  const Tally& operator[](int steps) const { return tallies_[at_[steps]]; }

 private:
  void add(const RowRun& run, int k, std::size_t first, const Eigen::MatrixXd& block) {
    if (at_[k] < 0) return;
    const std::size_t start = run.begin + static_cast<std::size_t>(k) - 1;
    const auto skip = static_cast<Eigen::Index>(start > first ? start - first : 0);
    if (skip >= block.rows()) return;
    const Eigen::Index rows = block.rows() - skip;
    tallies_[at_[k]].add_errors(block.bottomRows(rows));
    for (int i = 0; i < signals_.outputs; ++i) {
      const double* measured = signals_.samples[run.recording][i].data() + first + skip;
      tallies_[at_[k]].add_output(i, (Eigen::Map<const Eigen::ArrayXd>(measured, rows) - signals_.offset[i]).matrix());
    }
  }

  const Signals& signals_;
  std::vector<int> at_;
  std::vector<Tally> tallies_;
};

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
  const Tallies tallies(model, signals, options, first_sample);
  std::vector<PredictionFigures> out;
  for (int steps : options.steps) {
    const Tally tally =
        steps == kFreeRun ? free_run_tally(model, signals, {options.initial, first_sample}) : tallies[steps];
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

}  // namespace wisp
