#include "learn/outline/outline_figures.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cassert>
#include <cmath>

#include "base/statistics.hpp"
#include "learn/numeric/constants.hpp"
#include "learn/outline/outline_shape.hpp"

namespace wisp {
namespace {

constexpr std::size_t kMaxShapes = 2000;  // maximum number of frames compared: neighbouring frames add no information

using Predicted = std::vector<std::vector<double>>;  // [output][row]

// Values of all series in one row; empty if one is missing.
std::vector<double> predicted_row(const Predicted& series, std::size_t row) {
  std::vector<double> control;
  for (const auto& samples : series) {
    if (std::isnan(samples[row])) return {};
    control.push_back(samples[row]);
  }
  return control;
}

// Tips and overlap of measured and predicted outlines for one number of steps, over all recordings.
struct Shapes {
  std::vector<double> tip_measured;
  std::vector<double> tip_predicted;
  double overlap = 0;

  void add(const OutlineCurve& curve, const std::vector<double>& measured, const std::vector<double>& predicted) {
    const auto real = curve.polyline(measured);
    const auto made = curve.polyline(predicted);
    tip_measured.push_back(tip_of(real)[0]);
    tip_predicted.push_back(tip_of(made)[0]);
    overlap += overlap_of(real, made);
  }
};

void add_shapes(const OutlineCurve& curve, const Recording& recording, const OutlineLayout& layout,
                const Predicted& predicted, std::size_t stride, Shapes& shapes) {
  for (std::size_t row = 0; row < recording.rows(); row += stride) {
    const auto measured = whole_row(recording, layout, row);
    const auto made = predicted_row(predicted, row);
    if (!measured.empty() && !made.empty()) shapes.add(curve, measured, made);
  }
}

// Error sums over rows that are measured and predicted.
class Errors {
 public:
  explicit Errors(std::size_t outputs) : tally_(static_cast<int>(outputs)), distance_(outputs / 2) {}

  std::size_t rows() const { return tally_.rows(); }

  void add(const Recording& recording, const OutlineLayout& layout, const Predicted& predicted) {
    const auto outputs = static_cast<Eigen::Index>(predicted.size());
    Eigen::MatrixXd errors(static_cast<Eigen::Index>(recording.rows()), outputs);
    Eigen::MatrixXd deviations(errors.rows(), outputs);
    Eigen::Index rows = 0;
    for (std::size_t row = 0; row < recording.rows(); ++row) {
      const auto measured = whole_row(recording, layout, row);
      const auto made = predicted_row(predicted, row);
      if (measured.empty() || made.empty()) continue;
      if (origin_.empty()) origin_ = measured;
      for (Eigen::Index i = 0; i < outputs; ++i) {
        errors(rows, i) = measured[i] - made[i];
        deviations(rows, i) = measured[i] - origin_[i];
      }
      ++rows;
    }
    tally_.add_errors(errors.topRows(rows));
    for (Eigen::Index i = 0; i < outputs; ++i) tally_.add_output(static_cast<int>(i), deviations.col(i).head(rows));
    for (std::size_t p = 0; p < distance_.size(); ++p) {
      distance_[p] += errors.block(0, static_cast<Eigen::Index>(2 * p), rows, 2).rowwise().norm().sum();
    }
  }

  // J is the mean distance of each point from its prediction.
  PredictionFigures figures(int steps) const {
    PredictionFigures out = tally_.figures(steps);
    out.j.clear();
    for (double sum : distance_) out.j.push_back(sum / static_cast<double>(rows()));
    return out;
  }

 private:
  Tally tally_;
  std::vector<double> distance_;
  std::vector<double> origin_;  // first measured row, subtracted so that a constant channel has exactly 0 spread
};

void add_figures(const PredictionFigures& fit, const Shapes& shapes, OutlineFigures& out) {
  out.rows = std::max(out.rows, fit.rows);
  out.j.push_back(mean(fit.j));
  for (std::size_t i = 0; i < out.channels.size(); ++i) out.channels[i].fit_percent.push_back(fit.fit_percent[i]);
  const auto rows = static_cast<double>(std::max<std::size_t>(1, shapes.tip_measured.size()));
  out.tip_fit_percent.push_back(fit_percent(shapes.tip_measured, shapes.tip_predicted));
  out.overlap.push_back(shapes.overlap / rows);
}

}  // namespace

Result<OutlineFigures> outline_figures(const OutlineDynamics& dynamics, std::span<const Recording> recordings,
                                       const PreparedOutlines& prepared, const std::vector<int>& steps) {
  const OutlineLayout& layout = prepared.layout;
  OutlineFigures out;
  out.steps = steps;
  for (std::size_t c : layout.outputs) out.channels.push_back({recordings.front().channels[c].name, {}});
  std::size_t all_rows = 0;
  for (const Recording& recording : recordings) all_rows += recording.rows();
  const std::size_t stride = 1 + all_rows / kMaxShapes;
  const OutlineCurve curve(layout.knots);
  for (int k : steps) {
    Shapes shapes;
    Errors errors(layout.outputs.size());
    for (const Recording& recording : recordings) {
      const auto series = predict_outline(dynamics, recording, prepared, {.steps = k});
      if (!series) return series.error();
      errors.add(recording, layout, *series);
      add_shapes(curve, recording, layout, *series, stride, shapes);
    }
    if (errors.rows() == 0) {
      return Error{recordings.front().source + ": no row can be predicted: no stretch without gaps is long enough"};
    }
    add_figures(errors.figures(k), shapes, out);
  }
  return out;
}

double at_steps(const std::vector<int>& steps, const std::vector<double>& values, int wanted) {
  for (std::size_t k = 0; k < steps.size() && k < values.size(); ++k) {
    if (steps[k] == wanted) return values[k];
  }
  return kMissing;
}

double fit_percent(std::span<const double> measured, std::span<const double> predicted) {
  assert(measured.size() == predicted.size());
  const double middle = mean(measured);
  double error = 0, spread = 0;
  for (std::size_t t = 0; t < measured.size(); ++t) {
    error += (measured[t] - predicted[t]) * (measured[t] - predicted[t]);
    spread += (measured[t] - middle) * (measured[t] - middle);
  }
  return spread > 0 ? 100 * (1 - std::sqrt(error / spread)) : 0;
}

}  // namespace wisp
