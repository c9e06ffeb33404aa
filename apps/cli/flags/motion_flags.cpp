#include "flags/motion_flags.hpp"
#include "wisp/learn/chain_recipe.hpp"

#include <array>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>

namespace wisp::cli {
namespace {

constexpr std::array<const char*, 3> kPosition = {"pos.x", "pos.y", "pos.z"};
constexpr std::array<const char*, 4> kOrientation = {"q.w", "q.x", "q.y", "q.z"};
constexpr std::array<const char*, 3> kWind = {"wind.x", "wind.y", "wind.z"};

// Gives columns that a flag names the names that learning looks for.
template <std::size_t kSize>
Result<void> rename(const Arguments& arguments, const char* flag, const std::array<const char*, kSize>& names,
                    Recording& recording) {
  if (!arguments.has(flag)) return {};
  const auto columns = arguments.names(flag);
  for (std::size_t k = 0; k < kSize; ++k) {
    const auto channel = find_channel(recording, columns[k]);
    if (!channel) return Error{recording.source + ": has no column " + columns[k] + ", which --" + flag + " names"};
    recording.channels[*channel].name = names[k];
  }
  return {};
}

// The samples of channels, where all are there.
template <std::size_t kSize>
std::optional<std::array<std::vector<double>*, kSize>> samples_of(Recording& recording,
                                                                  const std::array<const char*, kSize>& names) {
  std::array<std::vector<double>*, kSize> out{};
  for (std::size_t k = 0; k < kSize; ++k) {
    const auto channel = find_channel(recording, names[k]);
    if (!channel) return {};
    out[k] = &recording.channels[*channel].samples;
  }
  return out;
}

// x, y, z of which y is up: turned about x, so that z is.
void turn_up(const std::array<std::vector<double>*, 3>& vectors) {
  for (std::size_t row = 0; row < vectors[1]->size(); ++row) {
    const double y = (*vectors[1])[row];
    (*vectors[1])[row] = -(*vectors[2])[row];
    (*vectors[2])[row] = y;
  }
}

// The same of orientations: a quarter turn about x before them.
void turn_up(const std::array<std::vector<double>*, 4>& q) {
  const double half = std::sqrt(0.5);
  for (std::size_t row = 0; row < q[0]->size(); ++row) {
    const double w = (*q[0])[row], x = (*q[1])[row], y = (*q[2])[row], z = (*q[3])[row];
    (*q[0])[row] = half * (w - x);
    (*q[1])[row] = half * (x + w);
    (*q[2])[row] = half * (y - z);
    (*q[3])[row] = half * (z + y);
  }
}

double metres_in(const std::string& unit) { return unit == "mm" ? 1e-3 : unit == "cm" ? 1e-2 : 1; }

}  // namespace

std::vector<Flag> motion_flags() {
  return {
      {"position", Kind::kNames, "X,Y,Z", "", "columns of the position, where they are not called pos.x, pos.y, pos.z"},
      {"orientation", Kind::kNames, "A,B,C,D", "",
       "columns of the quaternion, w first, where they are not called q.w, q.x, q.y, q.z"},
      {"up", Kind::kChoice, "y|z", "z", "which axis is up", {"y", "z"}},
      {"units", Kind::kChoice, "m|cm|mm", "m", "of positions", {"m", "cm", "mm"}},
  };
}

Result<std::vector<std::string>> motion_columns(const Arguments& arguments) {
  std::vector<std::string> columns;
  for (const auto& [flag, count] : {std::pair{"position", kPosition.size()}, {"orientation", kOrientation.size()}}) {
    if (!arguments.has(flag)) continue;
    auto names = arguments.names(flag);
    if (names.size() != count) {
      return Error{"--" + std::string(flag) + " names " + std::to_string(names.size()) + " columns, expected " +
                   std::to_string(count)};
    }
    std::move(names.begin(), names.end(), std::back_inserter(columns));
  }
  return columns;
}

CsvOptions motion_table(const Arguments& arguments, double rate_hz) {
  CsvOptions options{.rate_hz = rate_hz, .usual_outputs = {kTimeColumns.begin(), kTimeColumns.end()}};
  if (!arguments.has("inputs")) options.usual_inputs = {kWind.begin(), kWind.end()};
  if (arguments.has("outputs") || arguments.has("position") || arguments.has("orientation")) return options;
  options.usual_outputs.insert(options.usual_outputs.end(), kPosition.begin(), kPosition.end());
  options.usual_outputs.insert(options.usual_outputs.end(), kOrientation.begin(), kOrientation.end());
  return options;
}

Result<Recording> as_motion(Recording recording, const Arguments& arguments) {
  if (auto ok = rename(arguments, "position", kPosition, recording); !ok) return ok.error();
  if (auto ok = rename(arguments, "orientation", kOrientation, recording); !ok) return ok.error();
  const auto position = samples_of(recording, kPosition);
  const auto orientation = samples_of(recording, kOrientation);
  if (position && arguments.has("units")) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (double& x : *(*position)[axis]) x *= metres_in(arguments.text("units"));
      recording.channels[*find_channel(recording, kPosition[axis])].unit = "m";
    }
  }
  if (!arguments.has("up") || arguments.text("up") == "z") return recording;
  if (position) turn_up(*position);
  if (orientation) turn_up(*orientation);
  if (const auto wind = samples_of(recording, kWind)) turn_up(*wind);
  return recording;
}

}  // namespace wisp::cli
