#include "learn/outline/outline_drawn.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "learn/arx/judge/prediction.hpp"

namespace wisp {
namespace {

constexpr double kTrendSeconds = 1.0 / 15;     // by which a gust's rise is told from its fall
constexpr double kShortestSeconds = 1.0 / 20;  // between jumps
constexpr double kLongestSeconds = 4;          // in a wind that stays; longer would repeat what was recorded
constexpr double kLongestAloneSeconds = 0.5;   // where no input says when to go elsewhere
constexpr double kTolerance = 0.25;            // of wind 1
constexpr double kCalm = 0.04;                 // of wind 1: less than this does not move what stands still
constexpr double kLeanWeight = 0.45;           // of wind 1, of a standard deviation of how it leans or rises
constexpr double kMinSeconds = 1;
constexpr double kLargestStored = 32767;

// One row's residuals, the lean before it and its wind, NaN where one is missing.
struct Row {
  std::vector<double> residual;
  std::array<double, 2> lean{};
  double wind = 0;
  double trend = 0;

  bool complete() const {
    return std::isfinite(wind) && std::isfinite(trend) &&
           std::all_of(residual.begin(), residual.end(), [](double x) { return std::isfinite(x); });
  }
};

int steps_of(double seconds, double rate_hz) { return std::max(1, static_cast<int>(std::lround(seconds * rate_hz))); }

const std::vector<double>& samples(const Recording& recording, const std::string& name) {
  return recording.channels[*find_channel(recording, name)].samples;
}

// The first input as it was given, its sides put together again; zeros where there is none.
std::vector<double> signed_input(const Recording& recording, const PreparedOutlines& prepared) {
  if (prepared.inputs.empty()) return std::vector<double>(recording.rows(), 0.0);
  const std::string& name = prepared.inputs.front().name;
  if (!prepared.shape.split_sign) return samples(recording, name);
  std::vector<double> out = samples(recording, name + "+");
  const std::vector<double>& other = samples(recording, name + "-");
  for (std::size_t row = 0; row < out.size(); ++row) out[row] -= other[row];
  return out;
}

// The two control points about the tip: their x, which change places and signs in a mirror image, and their y.
std::vector<int> tip_outputs(std::size_t points) {
  const auto left = static_cast<int>((points - 1) / 2), right = static_cast<int>(points / 2);
  return {2 * left, 2 * right, 2 * left + 1, 2 * right + 1};
}

// Where it begins to blow after calm. What was recorded in calm ends there: a thing that stands still in a wind that
// stays away is not to be moved by a gust that it does not feel, however little of that gust is within the tolerance.
bool begins_to_blow(const Row& before, const Row& now) {
  return std::abs(before.wind) <= kCalm && std::abs(now.wind) > kCalm;
}

// Complete rows in stretches.
Result<std::vector<std::vector<Row>>> stretches_left(const ArxModel& model, const Recording& recording,
                                                     const PreparedOutlines& prepared, std::size_t trend_steps) {
  const auto predicted = predict(model, recording, prepared.channels, {.steps = 1});
  if (!predicted) return predicted.error();
  const std::vector<double> wind = signed_input(recording, prepared);
  const std::vector<int> tip = tip_outputs(prepared.layout.points);
  std::vector<std::vector<Row>> out;
  for (const Episode& episode : episodes(recording)) {
    out.emplace_back();
    for (std::size_t row = episode.begin + trend_steps; row < episode.end; ++row) {
      Row one{{}, {}, wind[row], wind[row] - wind[row - trend_steps]};
      for (std::size_t k = 0; k < tip.size(); ++k) {
        const auto output = static_cast<std::size_t>(tip[k]);
        const double value = samples(recording, prepared.channels.outputs[output])[row - 1];
        one.lean[k / 2] += value - model.output_mean[output];
      }
      for (std::size_t i = 0; i < prepared.channels.outputs.size(); ++i) {
        one.residual.push_back(samples(recording, prepared.channels.outputs[i])[row] - (*predicted)[i][row]);
      }
      if (!out.back().empty() && begins_to_blow(out.back().back(), one)) out.emplace_back();
      if (one.complete()) {
        out.back().push_back(std::move(one));
      } else if (!out.back().empty()) {
        out.emplace_back();
      }
    }
  }
  std::erase_if(out, [](const auto& stretch) { return stretch.size() < 2; });
  return out;
}

std::size_t row_count(const std::vector<std::vector<Row>>& stretches) {
  std::size_t rows = 0;
  for (const auto& stretch : stretches) rows += stretch.size();
  return rows;
}

// Keeps the same share of every stretch.
void keep_at_most(std::vector<std::vector<Row>>& stretches, std::size_t rows) {
  const auto all = static_cast<double>(row_count(stretches));
  if (all <= static_cast<double>(rows)) return;
  for (auto& stretch : stretches) {
    stretch.resize(static_cast<std::size_t>(static_cast<double>(stretch.size()) * static_cast<double>(rows) / all));
  }
  std::erase_if(stretches, [](const auto& stretch) { return stretch.size() < 2; });
}

std::int16_t stored(double value, double scale) {
  const double units = scale > 0 ? std::round(value / scale) : 0;
  return static_cast<std::int16_t>(std::clamp(units, -kLargestStored, kLargestStored));
}

void store_rows(const std::vector<std::vector<Row>>& stretches, DrawnResiduals& out) {
  const std::size_t ny = stretches.front().front().residual.size();
  out.scale.assign(ny, 0.0);
  for (const auto& stretch : stretches) {
    for (const Row& row : stretch) {
      for (std::size_t i = 0; i < ny; ++i) {
        out.scale[i] = std::max(out.scale[i], std::abs(row.residual[i]) / kLargestStored);
      }
      out.wind_scale =
          std::max({out.wind_scale, std::abs(row.wind) / kLargestStored, std::abs(row.trend) / kLargestStored});
    }
  }
  for (const auto& stretch : stretches) {
    for (const Row& row : stretch) {
      for (std::size_t i = 0; i < ny; ++i) out.rows.push_back(stored(row.residual[i], out.scale[i]));
      if (out.toward < 0) continue;
      out.winds.push_back(stored(row.wind, out.wind_scale));
      out.winds.push_back(stored(row.trend, out.wind_scale));
    }
    out.ends.push_back(static_cast<std::uint32_t>(out.row_count() + stretch.size()));
  }
}

// How the outline leaned and rose before every row: what a gust does hangs on where it finds the flame. Both weigh by
// the larger of their standard deviations.
void store_leans(const std::vector<std::vector<Row>>& stretches, std::size_t points, DrawnResiduals& out) {
  double largest = 0;
  std::array<double, 2> sum{}, square{};
  for (const auto& stretch : stretches) {
    for (const Row& row : stretch) {
      for (std::size_t k = 0; k < 2; ++k) {
        largest = std::max(largest, std::abs(row.lean[k]));
        sum[k] += row.lean[k];
        square[k] += row.lean[k] * row.lean[k];
      }
    }
  }
  const auto rows = static_cast<double>(row_count(stretches));
  double variance = 0;
  for (std::size_t k = 0; k < 2; ++k) variance = std::max(variance, square[k] / rows - sum[k] * sum[k] / rows / rows);
  if (!(variance > 0)) return;
  out.lean_of = tip_outputs(points);
  out.lean_weight = kLeanWeight / std::sqrt(variance);
  out.lean_scale = largest / kLargestStored;
  for (const auto& stretch : stretches) {
    for (const Row& row : stretch) {
      for (double lean : row.lean) out.leans.push_back(stored(lean, out.lean_scale));
    }
  }
}

// x of the point opposite negated, y as it is.
std::vector<int> mirror_image(std::size_t points) {
  std::vector<int> out;
  for (std::size_t p = 0; p < points; ++p) {
    const auto x = static_cast<int>(2 * (points - 1 - p));
    out.push_back(-(1 + x));
    out.push_back(1 + x + 1);
  }
  return out;
}

}  // namespace

Result<DrawnResiduals> drawn_residuals(const ArxModel& model, std::span<const Recording> recordings,
                                       const PreparedOutlines& prepared, const DrawnOptions& options) {
  const double rate = recordings.front().rate_hz;
  DrawnResiduals out;
  out.trend_steps = steps_of(kTrendSeconds, rate);
  std::vector<std::vector<Row>> stretches;
  for (const Recording& recording : recordings) {
    auto found = stretches_left(model, recording, prepared, static_cast<std::size_t>(out.trend_steps));
    if (!found) return found.error();
    for (auto& stretch : *found) stretches.push_back(std::move(stretch));
  }
  const std::size_t bytes_a_row = 2 * prepared.channels.outputs.size();
  keep_at_most(stretches, std::min(kMostDrawnRows, options.most_bytes / bytes_a_row));
  if (static_cast<double>(row_count(stretches)) < kMinSeconds * rate) return DrawnResiduals{};
  const bool driven = !prepared.inputs.empty();
  if (driven) out.toward = 0;
  if (driven && prepared.shape.split_sign) out.against = 1;
  if (out.against >= 0 && options.mirror) out.mirror = mirror_image(prepared.layout.points);
  out.tolerance = kTolerance;
  out.shortest = steps_of(kShortestSeconds, rate);
  out.longest = std::max(out.shortest, steps_of(driven ? kLongestSeconds : kLongestAloneSeconds, rate));
  store_rows(stretches, out);
  if (driven) store_leans(stretches, prepared.layout.points, out);
  return out;
}

void centre_on_calm(ArxModel& model) {
  const int ny = model.orders.outputs();
  Eigen::MatrixXd feedback = Eigen::MatrixXd::Identity(ny, ny);
  Eigen::VectorXd push(ny);
  for (int i = 0; i < ny; ++i) {
    for (int j = 0; j < ny; ++j) {
      for (double a : model.a(i, j)) feedback(i, j) += a;
    }
    push[i] = model.constant[i];
    for (int k = 0; k < model.orders.inputs(); ++k) {
      for (double b : model.b(i, k)) push[i] -= b * model.input_mean[k];
    }
  }
  const Eigen::VectorXd shift = feedback.partialPivLu().solve(push);
  if (!shift.allFinite()) return;
  for (int i = 0; i < ny; ++i) model.output_mean[i] += shift[i];
  std::fill(model.constant.begin(), model.constant.end(), 0.0);
  std::fill(model.input_mean.begin(), model.input_mean.end(), 0.0);
}

}  // namespace wisp
