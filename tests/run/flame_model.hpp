#pragma once
// A made-up flame for tests and benchmarks: eight control points, each a system of two outputs of order 4, one wind.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>

#include "model/bspline.hpp"
#include "wisp/model/model.hpp"

namespace wisp {

/// What may differ between made-up flames.
struct FlameOptions {
  int points = 8;
  InputShape wind = InputShape::kLinear;
  int resampled_rows = 0;  ///< of residuals to play instead, in two stretches; 0: the noise is Gaussian
};

/// Made-up residuals of 16-bit noise, beside a wind that swings from 0 to 1 once in so many rows; a wind from the other
/// side plays their mirror image.
inline ResampledResiduals resampled_flame_residuals(int outputs, int rows, bool both_sides, int swing = 20) {
  ResampledResiduals resampled;
  resampled.scale.assign(outputs, 1e-4);
  for (int k = 0; k < rows * outputs; ++k) resampled.rows.push_back(static_cast<std::int8_t>(k * 7919 % 201 - 100));
  resampled.ends = {static_cast<std::uint32_t>(rows / 3), static_cast<std::uint32_t>(rows)};
  resampled.wind_scale = 1e-4;
  resampled.lags = {0, 1, 2, 4};
  int begin = 0;
  for (std::uint32_t end : resampled.ends) {
    for (int row = begin - resampled.lags.back(); row < static_cast<int>(end); ++row) {
      const int at = (row + swing) % swing;
      resampled.winds.push_back(static_cast<std::int16_t>(20000 / swing * std::min(at, swing - at)));
    }
    begin = static_cast<int>(end);
  }
  resampled.toward = both_sides ? 3 : 0;
  resampled.tolerance = 0.1;
  resampled.margin = 0.01;
  resampled.longest = 40;
  if (!both_sides) return resampled;
  for (int p = outputs / 2 - 1; p >= 0; --p) resampled.mirror.insert(resampled.mirror.end(), {-(2 * p + 1), 2 * p + 2});
  return resampled;
}

/// A stable flame: every channel has the poles 0.75 ± 0.37i, 0.5 and −0.3, a little of its point's other coordinate,
/// and four taps of wind; of its even functions where it has a sign in y, of its odd ones in x.
inline Model flame_model(const FlameOptions& options = {}) {
  const int outputs = 2 * options.points;
  const int regressors = regressor_count(options.wind);
  const bool powers = has_powers(options.wind);
  ArxModel arx;
  arx.orders = {OrderMatrix(outputs, outputs), OrderMatrix(outputs, regressors, 4), OrderMatrix(outputs, regressors)};
  Model model;
  model.name = "made-up flame";
  model.rate_hz = 30;
  model.inputs = {{"wind", "", has_powers(options.wind) ? -1.0 : 0.0, 1.0, options.wind}};
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
      const double share = (1 + along) / (powers ? 2.0 + k % 3 : 1.0);
      if (powers && (k < 3) == x_row) arx.orders.nb(i, k) = 0;
      for (int lag = 0; lag < arx.orders.nb(i, k); ++lag) {
        row.push_back((x_row ? 1 : -0.3) * std::array{0.02, 0.015, -0.004, 0.002}[lag] * share);
      }
    }
    arx.theta.push_back(row);
    arx.constant.push_back(0);
    arx.output_mean.push_back(mean);
    arx.noise.sd.push_back(x_row ? 0.006 : 0.008);
  }
  arx.input_mean.assign(regressors, 0.1);
  if (options.resampled_rows > 0) {
    arx.noise.resampled = resampled_flame_residuals(outputs, options.resampled_rows, has_powers(options.wind));
  }
  model.dynamics = arx;
  model.view = OutlineView{uniform_knots(options.points), 0.03, 0};
  return model;
}

/// A flame as `wisp learn flame` makes them: three lags of every coordinate alone and of a wind's size or sign, the
/// outline's last point the first one mirrored about the base's middle, residuals that are drawn by the wind
/// alone, a rule of extinction.
inline Model default_flame_model(InputShape wind = InputShape::kEvenOdd) {
  constexpr int kOutputs = 16, kLags = 3;
  Model model = flame_model({.wind = wind, .resampled_rows = 600});
  auto& arx = std::get<ArxModel>(model.dynamics);
  const int regressors = regressor_count(wind);
  arx.orders = {OrderMatrix(kOutputs, kOutputs), OrderMatrix(kOutputs, regressors), OrderMatrix(kOutputs, regressors)};
  for (int i = 0; i < kOutputs; ++i) {
    arx.orders.na(i, i) = kLags;
    const double gain = i % 2 == 0 ? 0.02 : -0.006;
    arx.theta[i] = {-1.2, 0.6, -0.1};
    for (int k = 0; k < regressors; ++k) {
      if (has_powers(wind) && (k < 3) == (i % 2 == 0)) continue;
      arx.orders.nb(i, k) = kLags;
      arx.theta[i].insert(arx.theta[i].end(), {gain / (1 + k % 3), 0.5 * gain, 0.0005 * i});
    }
  }
  arx.input_mean.assign(regressors, 0.0);
  auto& rows = arx.noise.resampled.rows;
  for (int i : {0, 1}) {
    const int other = kOutputs - 2 + i;
    arx.theta[other] = arx.theta[i];
    for (std::size_t k = kLags; k < arx.theta[i].size(); ++k) arx.theta[other][k] *= -1;
    for (std::size_t row = 0; row < rows.size(); row += kOutputs) {
      rows[row + other] = static_cast<std::int8_t>(-rows[row + i]);
    }
  }
  model.extinction = Extinction{};
  return model;
}

/// A flame as `wisp learn flame` makes them of films without wind: rows of a sway of seven and one of eleven periods in
/// so many rows, in two stretches, followed as they were; what deviates from them fades.
inline Model still_flame_model(int rows = 300) {
  constexpr int kOutputs = 16;
  constexpr double kFade = 0.8;
  Model model = flame_model();
  model.inputs.clear();
  auto& arx = std::get<ArxModel>(model.dynamics);
  arx.orders = {OrderMatrix(kOutputs, kOutputs), OrderMatrix(kOutputs, 0), OrderMatrix(kOutputs, 0)};
  arx.input_mean.clear();
  for (int i = 0; i < kOutputs; ++i) {
    arx.orders.na(i, i) = 1;
    arx.theta[i] = {-kFade};
  }
  ResampledResiduals& resampled = arx.noise.resampled;
  resampled.scale.assign(kOutputs, 0.001);
  resampled.ends = {static_cast<std::uint32_t>(rows / 3), static_cast<std::uint32_t>(rows)};
  const auto sway = [&](int row, int output) {
    const double turn = 2 * 3.14159265358979 * row / rows;
    return 0.1 * std::sin(7 * turn + 0.3 * output) + 0.05 * std::sin(11 * turn + output);
  };
  for (int row = 0; row < rows; ++row) {
    const bool first = row == 0 || row == rows / 3;
    for (int i = 0; i < kOutputs; ++i) {
      const double left = sway(row, i) - (first ? 0 : kFade * sway(row - 1, i));
      resampled.rows.push_back(static_cast<std::int8_t>(std::lround(left / resampled.scale[i])));
    }
  }
  return model;
}

/// A flame as `wisp learn flame` makes them: every coordinate hears two lags of all others, four of a wind and two of
/// its root and its square, the outline's last point is the first one mirrored about the base's middle.
inline Model coupled_flame_model() {
  constexpr int kOutputs = 16, kRegressors = 6, kLags = 2;
  Model model = default_flame_model();
  auto& arx = std::get<ArxModel>(model.dynamics);
  arx.orders = {OrderMatrix(kOutputs, kOutputs, kLags), OrderMatrix(kOutputs, kRegressors, kLags),
                OrderMatrix(kOutputs, kRegressors, 1)};
  arx.input_mean.assign(kRegressors, 0.0);
  for (int i = 0; i < kOutputs; ++i) {
    arx.theta[i].clear();
    const int like = i < kOutputs - 2 ? i : i - (kOutputs - 2);
    const double sign = i < kOutputs - 2 ? 1 : -1;
    for (int j = 0; j < kOutputs; ++j) {
      const bool last = j >= kOutputs - 2;
      arx.orders.na(i, j) = last ? 0 : kLags;
      if (last) continue;
      const double other = 0.004 * ((like * 7 + j * 5) % 9 - 4.5);
      arx.theta[i].insert(arx.theta[i].end(), {sign * (like == j ? -1.1 : other), sign * (like == j ? 0.4 : -other)});
    }
    for (int k = 0; k < kRegressors; ++k) {
      const int lags = k % 3 == 0 ? 2 * kLags : kLags;
      arx.orders.nb(i, k) = lags;
      arx.orders.nk(i, k) = k % 3 == 0 ? 0 : 1;
      const double side = k >= 3 && like % 2 == 0 ? -1 : 1;
      for (int l = 0; l < lags; ++l) arx.theta[i].push_back(sign * side * 0.001 * (1 + (like + k + l) % 5));
    }
  }
  return model;
}

}  // namespace wisp
