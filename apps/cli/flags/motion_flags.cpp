#include "flags/motion_flags.hpp"
#include "wisp/learn/chain_recipe.hpp"

#include <array>
#include <iterator>
#include <utility>

namespace wisp::cli {
namespace {

constexpr std::array<const char*, 3> kPosition = {"pos.x", "pos.y", "pos.z"};
constexpr std::array<const char*, 4> kOrientation = {"q.w", "q.x", "q.y", "q.z"};
constexpr std::array<const char*, 3> kWind = {"wind.x", "wind.y", "wind.z"};

// Renames columns named by a flag to the names that learning expects.
template <std::size_t kSize>
Result<void> rename(const Arguments& arguments, const char* flag, const std::array<const char*, kSize>& names,
                    Recording& recording) {
  if (!arguments.has(flag)) return {};
  const auto columns = arguments.names(flag);
  std::array<std::size_t, kSize> found{};
  for (std::size_t k = 0; k < kSize; ++k) {
    const auto channel = find_channel(recording, columns[k]);
    if (!channel) return Error{recording.source + ": has no column " + columns[k] + ", which --" + flag + " names"};
    found[k] = *channel;
  }
  // Renamed after all are found, as the columns may have these names in another order.
  for (std::size_t k = 0; k < kSize; ++k) recording.channels[found[k]].name = names[k];
  return {};
}

}  // namespace

std::vector<Flag> motion_flags() {
  return {
      {"position", Kind::kNames, "X,Y,Z", "", "columns of the position, where they are not called pos.x, pos.y, pos.z"},
      {"orientation", Kind::kNames, "A,B,C,D", "",
       "columns of the quaternion, w first, where they are not called q.w, q.x, q.y, q.z"},
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
  return recording;
}

}  // namespace wisp::cli
