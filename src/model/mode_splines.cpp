// Source: section 2.2 of the paper names splines as realisations of a mode. Only + − × ÷ and square root, in the order
// written: rows feed the frame path.

#include "wisp/model/mode_splines.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "model/bspline.hpp"
#include "wisp/model/chain.hpp"

namespace wisp {
namespace {

constexpr double kMaxStored = 32767;
constexpr double kMaxNumber = 1e6;

std::int16_t rounded(double x) {
  const double held = std::clamp(x, -kMaxStored, kMaxStored);
  return static_cast<std::int16_t>(held < 0 ? held - 0.5 : held + 0.5);
}

// Control points of one segment: control points × channels.
void control(const ModeSplines& splines, std::size_t mode, std::span<const std::int16_t> score,
             std::span<double> points) {
  const std::size_t size = points.size();
  std::copy_n(splines.mean.begin() + static_cast<long>(mode * size), size, points.begin());
  const float* component = splines.component.data() + mode * score.size() * size;
  for (std::int16_t one : score) {
    for (double& point : points) point += one * static_cast<double>(*component++);
  }
}

// Gives a stored quaternion its length; what has none becomes no turn at all.
void make_unit(std::span<double> q, double scale) {
  double square = 0;
  for (double x : q) square += x * x;
  if (!(square > 1)) {
    std::fill(q.begin(), q.end(), 0.0);
    q[0] = square = 1;
  }
  const double length = 1 / (scale * std::sqrt(square));
  for (double& x : q) x *= length;
}

bool in_range(const std::vector<float>& numbers) {
  return std::all_of(numbers.begin(), numbers.end(), [](float x) { return x >= -kMaxNumber && x <= kMaxNumber; });
}

// Whether segments are so far sound that rows can be made of them.
bool are_sound(const ChainSegments& segments, int modes, int channels) {
  const auto known = [&](std::uint16_t mode) { return mode < modes; };
  const auto lasts = [](std::uint16_t steps) { return steps > 0; };
  const auto measures = [](double scale) { return scale >= 1e-12 && scale <= kMaxNumber; };
  return std::all_of(segments.mode.begin(), segments.mode.end(), known) &&
         std::all_of(segments.steps.begin(), segments.steps.end(), lasts) &&
         std::all_of(segments.row_scale.begin(), segments.row_scale.end(), measures) &&
         segments.steps.size() == segments.size() && segments.row_scale.size() == (channels == 7 ? 2U : 1U);
}

}  // namespace

std::vector<std::int16_t> rows_of(const ModeSplines& splines, const ChainSegments& segments, int channels) {
  const auto width = static_cast<std::size_t>(channels), components = static_cast<std::size_t>(splines.components);
  const std::vector<double> knots = uniform_knots(splines.control_points);
  std::vector<double> points(static_cast<std::size_t>(splines.control_points) * width), row(width);
  std::vector<std::int16_t> rows;
  for (std::size_t segment = 0; segment < segments.size(); ++segment) {
    control(splines, segments.mode[segment], std::span(splines.score).subspan(segment * components, components),
            points);
    const int steps = segments.steps[segment];
    for (int step = 0; step <= steps; ++step) {
      const BasisWeights weights = basis(knots, static_cast<double>(step) / steps);
      std::fill(row.begin(), row.end(), 0.0);
      for (std::size_t k = 0; k < 4; ++k) {
        const double* point = points.data() + (static_cast<std::size_t>(weights.first) + k) * width;
        for (std::size_t channel = 0; channel < width; ++channel) row[channel] += weights.weight[k] * point[channel];
      }
      if (width == 7) make_unit(std::span(row).subspan(3), segments.row_scale[1]);
      for (double x : row) rows.push_back(rounded(x));
    }
  }
  return rows;
}

Result<void> check(const ModeSplines& splines, const ChainSegments& segments, int modes, int channels) {
  if (splines.control_points < 4 || splines.control_points > 32 || splines.components < 0 || splines.components > 64) {
    return Error{"the splines of a chain's modes have control points or components beyond 4 to 32 and 0 to 64"};
  }
  const auto components = static_cast<std::size_t>(splines.components);
  const std::size_t size = static_cast<std::size_t>(modes) * static_cast<std::size_t>(splines.control_points) *
                           static_cast<std::size_t>(channels);
  if (splines.mean.size() != size || splines.component.size() != size * components ||
      splines.score.size() != segments.size() * components || !are_sound(segments, modes, channels)) {
    return Error{"the splines of a chain's modes do not fit each other or its segments"};
  }
  if (!in_range(splines.mean) || !in_range(splines.component)) {
    return Error{"the splines of a chain's modes hold a number out of range, expected -1e6 to 1e6"};
  }
  if (segment_rows(segments).back() > kMaxSplineRows) {
    return Error{"the splines of a chain's modes make too many rows, expected at most 1000000"};
  }
  return {};
}

}  // namespace wisp
