#include "wisp/model/chain.hpp"

#include <cmath>
#include <cstdlib>
#include <span>
#include <string>

namespace wisp {
namespace {

constexpr double kMaxRounding = 1e-6;  // tolerance of a sum of probabilities, for ones written with seven digits
constexpr double kMaxStretch = 0.005;  // tolerance of a quaternion's norm: 20 times the rounding error of 1/4096 steps
constexpr double kLargestScale = 1e9;
constexpr int kMaxBlendSteps = 4096;

std::string found(std::size_t value, const std::string& expected) {
  return std::to_string(value) + ", expected " + expected;
}

Result<void> check_size(std::size_t size, std::size_t expected, const std::string& what) {
  if (size == expected) return {};
  return Error{"the chain's " + what + " hold " + found(size, std::to_string(expected)) + " values"};
}

Result<void> check_row(std::span<const double> row, const std::string& what) {
  double sum = 0;
  for (double p : row) {
    if (!(p >= 0 && p <= 1)) return Error{"the chain's " + what + " hold a number that is not a probability"};
    sum += p;
  }
  if (std::abs(sum - 1) > kMaxRounding) {
    return Error{"the chain's " + what + " sum to " + std::to_string(sum) + ", expected 1"};
  }
  return {};
}

Result<void> check_scales(const std::vector<double>& scales, int expected, const std::string& what) {
  if (auto ok = check_size(scales.size(), static_cast<std::size_t>(expected), what); !ok) return ok;
  for (double scale : scales) {
    if (!(scale > 0 && scale <= kLargestScale)) return Error{"the chain's " + what + " hold one that is not above 0"};
  }
  return {};
}

Result<void> check_modes(const ChainModel& model) {
  const ChainSegments& segments = model.segments;
  std::vector<std::size_t> members(static_cast<std::size_t>(model.modes));
  for (std::size_t k = 0; k < segments.size(); ++k) {
    const std::uint16_t mode = segments.mode[k];
    if (mode >= model.modes) {
      return Error{"segment " + std::to_string(k) + " has mode " + found(mode, "below " + std::to_string(model.modes))};
    }
    if (k > 0 && mode < segments.mode[k - 1]) return Error{"the chain's segments are not in the order of their modes"};
    if (segments.steps[k] == 0) return Error{"segment " + std::to_string(k) + " has no steps, expected at least 1"};
    ++members[mode];
  }
  for (std::size_t mode = 0; mode < members.size(); ++mode) {
    if (members[mode] == 0) return Error{"mode " + std::to_string(mode) + " of the chain has no segment"};
  }
  return {};
}

Result<void> check_follow(const ChainModel& model) {
  const ChainSegments& segments = model.segments;
  if (segments.breadth < 0 || segments.breadth > 256) {
    return Error{"the chain's breadth is " + std::to_string(segments.breadth) + ", expected 0 to 256"};
  }
  const auto breadth = static_cast<std::size_t>(segments.breadth), modes = static_cast<std::size_t>(model.modes);
  if (auto ok = check_size(segments.follow.size(), segments.size() * modes * breadth, "successors"); !ok) return ok;
  for (std::size_t k = 0; k < segments.follow.size(); ++k) {
    const std::size_t mode = k / breadth % modes, successor = segments.follow[k];
    if (successor >= segments.size() || segments.mode[successor] != mode) {
      return Error{"successor " + std::to_string(k) + " of the chain is segment " +
                   found(successor, "one of mode " + std::to_string(mode))};
    }
  }
  return {};
}

Result<void> check_heights(const ChainSegments& segments) {
  if (segments.height.empty()) return {};
  if (auto ok = check_size(segments.height.size(), segments.size(), "heights"); !ok) return ok;
  return check_scales({segments.height_scale}, 1, "scale of heights");
}

// Checks that stored quaternions have norm 1 up to rounding. A larger deviation shows a damaged file.
Result<void> check_orientations(const ChainSegments& segments) {
  for (std::size_t row = 0; 7 * row < segments.rows.size(); ++row) {
    double square = 0;
    for (std::size_t k = 7 * row + 3; k < 7 * row + 7; ++k) {
      square += static_cast<double>(segments.rows[k]) * segments.rows[k];
    }
    const double length = segments.row_scale[1] * std::sqrt(square);
    if (std::abs(length - 1) <= kMaxStretch) continue;
    return Error{"row " + std::to_string(row) + " of the chain's segments has a quaternion of length " +
                 std::to_string(length) + ", expected 1 but for rounding"};
  }
  return {};
}

Result<void> check_segments(const ChainModel& model) {
  const ChainSegments& segments = model.segments;
  if (segments.size() == 0 || segments.size() > kMaxSegments) {
    return Error{"a chain has " + std::to_string(segments.size()) + " segments, expected 1 to 65535"};
  }
  if (auto ok = check_size(segments.steps.size(), segments.size(), "lengths"); !ok) return ok;
  if (auto ok = check_modes(model); !ok) return ok;
  const auto channels = static_cast<std::size_t>(channel_count(model.motion));
  const auto rates = static_cast<std::size_t>(rate_count(model.motion));
  if (auto ok = check_size(segments.rows.size(), segment_rows(segments).back() * channels, "rows"); !ok) return ok;
  if (auto ok = check_size(segments.rates.size(), segments.size() * 2 * rates, "rates"); !ok) return ok;
  if (auto ok = check_scales(segments.row_scale, scale_count(model.motion), "row scales"); !ok) return ok;
  if (auto ok = check_scales(segments.rate_scale, scale_count(model.motion), "rate scales"); !ok) return ok;
  if (model.motion == ChainMotion::kPose) {
    if (auto ok = check_orientations(segments); !ok) return ok;
  }
  if (auto ok = check_heights(segments); !ok) return ok;
  return check_follow(model);
}

Result<void> check_probabilities(const ChainModel& model) {
  const auto modes = static_cast<std::size_t>(model.modes);
  if (auto ok = check_size(model.initial.size(), modes, "initial probabilities"); !ok) return ok;
  if (auto ok = check_row(model.initial, "initial probabilities"); !ok) return ok;
  if (model.history < 1 || model.history > 2) {
    return Error{"a chain looks " + std::to_string(model.history) + " modes back, expected 1 or 2"};
  }
  const std::size_t rows = model.history > 1 ? modes + modes * modes : modes;
  if (auto ok = check_size(model.probabilities.size(), rows * modes, "probabilities"); !ok) return ok;
  for (std::size_t row = 0; row < rows; ++row) {
    const std::string before = row < modes ? "" : " " + std::to_string(row / modes - 1);
    const std::string name = "probabilities after" + before + " " + std::to_string(row % modes);
    if (auto ok = check_row(std::span(model.probabilities).subspan(row * modes, modes), name); !ok) return ok;
  }
  return {};
}

Result<void> check_gust(const GustResponse& gust) {
  for (const GustResponse::Axis& axis : {gust.ground, gust.vertical}) {
    for (double coefficient : {axis.change, axis.wind, axis.press}) {
      if (std::abs(coefficient) <= 1e3) continue;
      return Error{"the response to gusts holds a coefficient that is not a number below 1000"};
    }
    if (std::abs(static_cast<float>(axis.change)) < 1) continue;
    return Error{"the response to gusts never dies away: it is unstable in single precision; learn it again"};
  }
  return {};
}

Result<void> check_drift(const ChainModel& model) {
  const ChainDrift& drift = *model.drift;
  if (auto ok = check_size(drift.lead.size(), 3 * model.segments.size(), "leads"); !ok) return ok;
  bool sound = drift.memory_seconds >= 0 && drift.memory_seconds <= 1e6;
  for (double scale : {drift.lead_scale, drift.spread_ground, drift.spread_height}) {
    sound &= scale >= 1e-12 && scale <= kLargestScale;
  }
  for (double speed : drift.drift) sound &= std::abs(speed) <= kLargestScale;
  if (!sound) return Error{"what the chain is steered by holds a number out of its range"};
  return {};
}

}  // namespace

int channel_count(ChainMotion motion) { return motion == ChainMotion::kPose ? 7 : 3; }

int rate_count(ChainMotion motion) { return motion == ChainMotion::kPose ? 6 : 3; }

int scale_count(ChainMotion motion) { return motion == ChainMotion::kPose ? 2 : 1; }

std::vector<double> ChainModel::transitions() const {
  return {probabilities.begin(), probabilities.begin() + static_cast<long>(modes) * modes};
}

std::vector<std::uint32_t> segment_rows(const ChainSegments& segments) {
  std::vector<std::uint32_t> first = {0};
  for (std::uint16_t steps : segments.steps) first.push_back(first.back() + steps + 1U);
  return first;
}

Result<void> check(const ChainModel& model) {
  if (model.motion != ChainMotion::kPosition && model.motion != ChainMotion::kPose) {
    return Error{"a chain has a kind of motion that this program does not know"};
  }
  if (model.modes < 1 || static_cast<std::size_t>(model.modes) > kMaxModes) {
    return Error{"a chain has " + std::to_string(model.modes) + " modes, expected 1 to 64"};
  }
  if (auto ok = check_segments(model); !ok) return ok;
  if (auto ok = check_probabilities(model); !ok) return ok;
  if (model.blend_steps < 0 || model.blend_steps > kMaxBlendSteps) {
    return Error{"a chain spreads joins over " + std::to_string(model.blend_steps) + " steps, expected 0 to 4096"};
  }
  if (model.gust) {
    if (auto ok = check_gust(*model.gust); !ok) return ok;
  }
  if (model.drift) {
    if (auto ok = check_drift(model); !ok) return ok;
  }
  return {};
}

}  // namespace wisp
