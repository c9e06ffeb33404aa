#include "learn/arx/judge/prediction_tally.hpp"

#include <cmath>

#include "learn/arx/judge/free_run.hpp"

namespace wisp {
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
