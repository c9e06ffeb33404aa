#pragma once
// A made-up flame for tests and benchmarks: eight control points, each a system of two outputs of order 4, one wind.

#include <algorithm>
#include <cstdint>
#include <string>

#include "model/bspline.hpp"
#include "wisp/model/model.hpp"

namespace wisp {

/// What may differ between made-up flames.
struct FlameOptions {
  int points = 8;
  InputShape wind = InputShape::kLinear;
  int noise_rank = 0;
  int drawn_rows = 0;  ///< of residuals to play instead, in two stretches; 0: the noise is Gaussian
};

/// Made-up residuals of 16-bit noise, beside a wind that swings from 0 to 1 once in so many rows; a wind from the other
/// side plays their mirror image.
inline DrawnResiduals drawn_flame_residuals(int outputs, int rows, bool both_sides, int swing = 20) {
  DrawnResiduals drawn;
  drawn.scale.assign(outputs, 1e-6);
  for (int k = 0; k < rows * outputs; ++k) drawn.rows.push_back(static_cast<std::int16_t>(k * 7919 % 20011 - 10005));
  drawn.ends = {static_cast<std::uint32_t>(rows / 3), static_cast<std::uint32_t>(rows)};
  drawn.wind_scale = 1e-4;
  for (int row = 0; row < rows; ++row) {
    const auto wind = [swing](int at) { return 20000 / swing * std::min(at % swing, swing - at % swing); };
    drawn.winds.push_back(static_cast<std::int16_t>(wind(row)));
    drawn.winds.push_back(static_cast<std::int16_t>(wind(row) - wind(row + swing - 2)));
  }
  drawn.toward = 0;
  drawn.trend_steps = 2;
  drawn.tolerance = 0.15;
  drawn.shortest = 2;
  drawn.longest = 40;
  if (!both_sides) return drawn;
  drawn.against = 1;
  for (int p = outputs / 2 - 1; p >= 0; --p) drawn.mirror.insert(drawn.mirror.end(), {-(2 * p + 1), 2 * p + 2});
  return drawn;
}

/// A stable flame: every channel has the poles 0.75 ± 0.37i, 0.5 and −0.3, a little of its point's other coordinate,
/// and four taps of wind (of either sign of it).
inline Model flame_model(const FlameOptions& options = {}) {
  const int outputs = 2 * options.points;
  const int regressors = regressor_count(options.wind);
  ArxModel arx;
  arx.orders = {OrderMatrix(outputs, outputs), OrderMatrix(outputs, regressors, 4), OrderMatrix(outputs, regressors)};
  Model model;
  model.name = "made-up flame";
  model.rate_hz = 30;
  model.inputs = {{"wind", "", splits_sign(options.wind) ? -1.0 : 0.0, 1.0, options.wind}};
  if (has_curve(options.wind)) model.inputs[0].curve = {{0, 0.3, 0.55, 0.8, 1}, {0, 0.07, 0.32, 0.9, 1}};
  for (int i = 0; i < outputs; ++i) {
    const bool x_row = i % 2 == 0;
    const double along = static_cast<double>(i / 2) / (options.points - 1);
    const double mean = x_row ? along - 0.5 : 4 * along * (1 - along);
    model.outputs.push_back({"p" + std::to_string(i / 2) + (x_row ? ".x" : ".y"), "", mean - 0.4, mean + 0.4});
    arx.orders.na(i, i) = arx.orders.na(i, i ^ 1) = 4;
    const std::vector<double> own{-1.7, 0.85, 0.085, -0.105}, other{0.01, -0.02, 0.015, -0.005};
    std::vector<double> row = x_row ? own : other;
    row.insert(row.end(), (x_row ? other : own).begin(), (x_row ? other : own).end());
    for (int k = 0; k < regressors; ++k) {
      const bool left = splits_sign(options.wind) && k % 2 == 1;
      const double sign = x_row && left ? -1 : 1;
      for (double b : {0.02, 0.015, -0.004, 0.002}) row.push_back((x_row ? sign : -0.3) * b * (1 + along));
    }
    arx.theta.push_back(row);
    arx.constant.push_back(0);
    arx.output_mean.push_back(mean);
    arx.noise.sd.push_back(x_row ? 0.006 : 0.008);
    for (int r = 0; r < options.noise_rank; ++r) arx.noise.mixing.push_back(0.002 * (1 + r) - 0.0005 * (i % 3));
  }
  arx.input_mean.assign(regressors, 0.1);
  arx.noise.rank = options.noise_rank;
  if (options.drawn_rows > 0) {
    arx.noise.drawn = drawn_flame_residuals(outputs, options.drawn_rows, splits_sign(options.wind));
  }
  model.dynamics = arx;
  model.view = OutlineView{uniform_knots(options.points), 0.03, 0};
  return model;
}

/// A flame as `wisp learn flame` makes them: three lags of every coordinate alone and of a wind from either side, the
/// outline's last point the first one mirrored about the base's middle, residuals that are drawn by the wind
/// alone, a rule of extinction.
inline Model default_flame_model(InputShape wind = InputShape::kSplitSign) {
  constexpr int kOutputs = 16, kLags = 3;
  Model model = flame_model({.wind = wind, .drawn_rows = 600});
  auto& arx = std::get<ArxModel>(model.dynamics);
  arx.orders = {OrderMatrix(kOutputs, kOutputs), OrderMatrix(kOutputs, 2, kLags), OrderMatrix(kOutputs, 2)};
  for (int i = 0; i < kOutputs; ++i) {
    arx.orders.na(i, i) = kLags;
    const double gain = i % 2 == 0 ? 0.02 : -0.006;
    arx.theta[i] = {-1.2, 0.6, -0.1, gain, 0.5 * gain, 0.001 * i, i % 2 == 0 ? -gain : gain, 0.004, 0.0001 * i};
  }
  arx.input_mean = {0, 0};
  auto& rows = arx.noise.drawn.rows;
  for (int i : {0, 1}) {
    const int other = kOutputs - 2 + i;
    for (int k = 0; k < 3 * kLags; ++k) arx.theta[other][k] = (k < kLags ? 1 : -1) * arx.theta[i][k];
    for (std::size_t row = 0; row < rows.size(); row += kOutputs) {
      rows[row + other] = static_cast<std::int16_t>(-rows[row + i]);
    }
  }
  model.extinction = Extinction{};
  return model;
}

/// The same whose jumps look at the lean too. Its residuals' wind swings half as fast, so that they jump about as often
/// as learned ones: with their random words 30 operations a frame, where flames learned from five sets of clips take 18
/// to 40.
inline Model leaning_flame_model(InputShape wind) {
  Model model = default_flame_model(wind);
  DrawnResiduals& drawn = std::get<ArxModel>(model.dynamics).noise.drawn;
  drawn.winds = drawn_flame_residuals(1, static_cast<int>(drawn.row_count()), true, 40).winds;
  drawn.tolerance = 0.25;
  drawn.longest = 45;
  drawn.lean_of = {6, 8, 7, 9};
  drawn.lean_weight = 2;
  drawn.lean_scale = 1e-4;
  for (std::size_t k = 0; k < 2 * drawn.row_count(); ++k) {
    drawn.leans.push_back(static_cast<std::int16_t>(k * 7919 % 4001 - 2000));
  }
  return model;
}

}  // namespace wisp
