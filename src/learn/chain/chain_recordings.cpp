// Prepares recordings for chains: falls, and windy–calm pairs that show the effect of wind.

#include <algorithm>
#include <cmath>
#include <string>

#include "learn/chain/learn_chain.hpp"
#include "learn/chain/motion/motion.hpp"
#include "record/number_text.hpp"

namespace wisp {
namespace {

constexpr double kFarthest = 1e6;     // metres: limit of positions in players
constexpr double kMaxClones = 10000;  // limit of `simulate leaf --clones`

// Checks that every channel of the pose has a sample.
Result<void> check_filled(const Recording& recording) {
  for (const char* name : {"pos.x", "pos.y", "pos.z", "q.w", "q.x", "q.y", "q.z"}) {
    const auto channel = find_channel(recording, name);
    if (!channel) continue;
    const auto& samples = recording.channels[*channel].samples;
    if (std::any_of(samples.begin(), samples.end(), [](double x) { return !std::isnan(x); })) continue;
    return Error{recording.source + ": " + name + " has no sample in any of its " + std::to_string(samples.size()) +
                 " rows, expected a number in each: fill it in, or leave its column out"};
  }
  return {};
}

Result<void> check_metres(const Recording& recording) {
  for (const char* name : chain::kPositions) {
    const Channel& channel = recording.channels[*find_channel(recording, name)];
    if (!channel.unit.empty() && channel.unit != "m") {
      return Error{recording.source + ": " + name + " is in " + channel.unit + ", expected metres: convert it"};
    }
    const auto& samples = channel.samples;
    const auto far = std::find_if(samples.begin(), samples.end(), [](double x) { return std::abs(x) > kFarthest; });
    if (far == samples.end()) continue;
    return Error{chain::row_name(recording, static_cast<std::size_t>(far - samples.begin())) + ": " + name + " is " +
                 number_text(*far, 3) +
                 ", expected metres, within 1000 km: give positions in metres from where it starts"};
  }
  return {};
}

Result<void> check_paired(const Recording& recording) {
  for (std::size_t channel : channels_with_role(recording, Role::kInput)) {
    const auto& samples = recording.channels[channel].samples;
    const auto missing = std::find_if(samples.begin(), samples.end(), [](double x) { return std::isnan(x); });
    if (missing == samples.end()) continue;
    return Error{chain::row_name(recording, static_cast<std::size_t>(missing - samples.begin())) + ": has no " +
                 recording.channels[channel].name + ", expected the wind in every row of a pair: fill it in"};
  }
  const auto clones = numbers_attribute(recording, "clones");
  if (!clones) return clones.error();
  if (!*clones || (*clones)->empty()) return {};
  const double count = (*clones)->front();
  if (count >= 1 && count <= kMaxClones && count == std::floor(count)) return {};
  return Error{recording.source + ": \"# clones\" is " + number_text(count, 3) +
               ", expected a whole number from 1 to " + number_text(kMaxClones, 6) +
               ": how many episodes in a row belong to one gust"};
}

}  // namespace

Result<void> check_motion(const Recording& recording) {
  if (auto ok = check_filled(recording); !ok) return ok;
  if (const auto motion = chain::motion_of(std::span(&recording, 1)); !motion) return motion.error();
  if (auto ok = check_metres(recording); !ok) return ok;
  return find_attribute(recording, "pair") ? check_paired(recording) : Result<void>();
}

namespace chain {

bool is_calm(const Recording& recording) {
  for (std::size_t channel : channels_with_role(recording, Role::kInput)) {
    const auto& samples = recording.channels[channel].samples;
    if (std::any_of(samples.begin(), samples.end(), [](double x) { return x != 0; })) return false;
  }
  return true;
}

Result<SortedRecordings> sorted_recordings(std::span<const Recording> recordings) {
  SortedRecordings sorted;
  for (const Recording& recording : recordings) {
    if (auto ok = check_motion(recording); !ok) return ok.error();
    (find_attribute(recording, "pair") ? sorted.paired : sorted.falls).push_back(recording);
  }
  auto& paired = sorted.paired;
  if (paired.empty()) return sorted;
  if (paired.size() != 2 || *find_attribute(paired[0], "pair") != *find_attribute(paired[1], "pair") ||
      is_calm(paired[0]) == is_calm(paired[1])) {
    return Error{paired.front().source + ": is one of " + std::to_string(paired.size()) +
                 " recordings with the attribute pair, expected two of one pair, one of them calm: give both, "
                 "or neither"};
  }
  if (is_calm(paired[0])) std::swap(paired[0], paired[1]);
  return sorted;
}

}  // namespace chain
}  // namespace wisp
