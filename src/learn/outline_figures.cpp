#include "wisp/learn/outline_figures.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

#include "wisp/learn/outline_shape.hpp"

namespace wisp {
namespace {

constexpr std::size_t kWhitenessLags = 20;
constexpr std::size_t kMostShapes = 2000;  // neighbouring frames say the same

using Series = std::vector<std::vector<double>>;  // [output][row]

// One row of series, or of the outputs of a recording; empty where a sample is missing.
std::vector<double> predicted_row(const Series& series, std::size_t row) {
  std::vector<double> control;
  for (const auto& samples : series) {
    if (std::isnan(samples[row])) return {};
    control.push_back(samples[row]);
  }
  return control;
}

std::vector<double> measured_row(const Recording& recording, const OutlineLayout& layout, std::size_t row) {
  std::vector<double> control;
  for (std::size_t c : layout.outputs) {
    const double value = recording.channels[c].samples[row];
    if (std::isnan(value)) return {};
    control.push_back(value);
  }
  return control;
}

// Shapes of one number of steps, gathered over recordings.
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

// Takes every `stride`-th row.
Result<void> add_shapes(const ArxModel& model, const Recording& recording, const ChannelChoice& channels,
                        const OutlineLayout& layout, int steps, std::size_t stride, Shapes& shapes) {
  const auto series = predict(model, recording, channels, {.steps = steps});
  if (!series) return series.error();
  const OutlineCurve curve(layout.knots);
  for (std::size_t row = 0; row < recording.rows(); row += stride) {
    const auto measured = measured_row(recording, layout, row);
    const auto predicted = predicted_row(*series, row);
    if (!measured.empty() && !predicted.empty()) shapes.add(curve, measured, predicted);
  }
  return {};
}

// One-step residuals of every output, episodes after each other, missing rows left out.
Result<Series> residuals(const ArxModel& model, std::span<const Recording> recordings, const ChannelChoice& channels) {
  Series out(channels.outputs.size());
  for (const Recording& recording : recordings) {
    const auto predicted = predict(model, recording, channels, {.steps = 1});
    if (!predicted) return predicted.error();
    for (std::size_t i = 0; i < out.size(); ++i) {
      const auto& measured = recording.channels[*find_channel(recording, channels.outputs[i])].samples;
      for (std::size_t row = 0; row < measured.size(); ++row) {
        const double residual = measured[row] - (*predicted)[i][row];
        if (!std::isnan(residual)) out[i].push_back(residual);
      }
    }
  }
  return out;
}

double upper_tail_chi_square(double value, double freedom) {
  const double spread = 2 / (9 * freedom);
  const double z = (std::cbrt(value / freedom) - (1 - spread)) / std::sqrt(spread);
  return 0.5 * std::erfc(z / std::sqrt(2.0));
}

}  // namespace

Result<OutlineFigures> outline_figures(const ArxModel& model, std::span<const Recording> recordings,
                                       const ChannelChoice& channels, const OutlineLayout& layout,
                                       const std::vector<int>& steps) {
  const auto fits = prediction_figures(model, recordings, channels, {.steps = steps, .group = 2});
  if (!fits) return fits.error();
  OutlineFigures out;
  out.steps = steps;
  for (const std::string& name : channels.outputs) out.channels.push_back({name, {}, 1});
  for (const PredictionFigures& fit : *fits) {
    out.rows = std::max(out.rows, fit.rows);
    out.j.push_back(fit.j);
    for (std::size_t i = 0; i < out.channels.size(); ++i) out.channels[i].fit_percent.push_back(fit.fit_percent[i]);
  }
  std::size_t all_rows = 0;
  for (const Recording& recording : recordings) all_rows += recording.rows();
  const std::size_t stride = 1 + all_rows / kMostShapes;
  for (int k : steps) {
    Shapes shapes;
    for (const Recording& recording : recordings) {
      if (auto ok = add_shapes(model, recording, channels, layout, k, stride, shapes); !ok) return ok.error();
    }
    const auto rows = static_cast<double>(std::max<std::size_t>(1, shapes.tip_measured.size()));
    out.tip_fit_percent.push_back(fit_percent(shapes.tip_measured, shapes.tip_predicted));
    out.overlap.push_back(shapes.overlap / rows);
  }
  const auto left = residuals(model, recordings, channels);
  if (!left) return left.error();
  for (std::size_t i = 0; i < out.channels.size(); ++i) {
    out.channels[i].whiteness_p = ljung_box_p((*left)[i], kWhitenessLags);
  }
  return out;
}

double ljung_box_p(std::span<const double> residual, std::size_t lags) {
  assert(lags >= 1);
  if (residual.size() < lags + 2) return 1;
  const auto n = static_cast<double>(residual.size());
  const double mean = std::accumulate(residual.begin(), residual.end(), 0.0) / n;
  double square = 0;
  for (double value : residual) square += (value - mean) * (value - mean);
  if (square == 0) return 1;
  double statistic = 0;
  for (std::size_t lag = 1; lag <= lags; ++lag) {
    double product = 0;
    for (std::size_t t = lag; t < residual.size(); ++t) product += (residual[t] - mean) * (residual[t - lag] - mean);
    const double r = product / square;
    statistic += r * r / (n - static_cast<double>(lag));
  }
  return upper_tail_chi_square(n * (n + 2) * statistic, static_cast<double>(lags));
}

double fit_percent(std::span<const double> measured, std::span<const double> predicted) {
  assert(measured.size() == predicted.size());
  if (measured.empty()) return 0;
  const double mean = std::accumulate(measured.begin(), measured.end(), 0.0) / static_cast<double>(measured.size());
  double error = 0;
  double spread = 0;
  for (std::size_t t = 0; t < measured.size(); ++t) {
    error += (measured[t] - predicted[t]) * (measured[t] - predicted[t]);
    spread += (measured[t] - mean) * (measured[t] - mean);
  }
  return spread > 0 ? 100 * (1 - std::sqrt(error / spread)) : 0;
}

}  // namespace wisp
