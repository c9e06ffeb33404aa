#include "reports/chain_recordings.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <set>
#include <span>

#include "flags/recordings.hpp"
#include "wisp/base/hash.hpp"
#include "wisp/learn/motion.hpp"

namespace wisp::cli {
namespace {

constexpr double kFarthest = 1e6;      // metres: players hold positions no further
constexpr double kMostClones = 10000;  // as `simulate leaf --clones`

std::string place(const Recording& recording, std::size_t row) {
  return recording.source + ": row " + std::to_string(row + 1);
}

// Of all samples of an episode. Two episodes that differ have the same one once in 10^19.
std::uint64_t hash_of(const Recording& recording, const Episode& episode) {
  std::uint64_t hash = hash_bytes({});
  for (const Channel& channel : recording.channels) {
    hash = hash_bytes(std::as_bytes(std::span(channel.samples).subspan(episode.begin, episode.size())), hash);
  }
  return hash;
}

// A channel of the pose that is only a name.
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

}  // namespace

Result<void> check_motion(const Recording& recording) {
  if (auto ok = check_filled(recording); !ok) return ok;
  if (const auto motion = motion_of(std::span(&recording, 1)); !motion) return motion.error();
  for (const char* name : {"pos.x", "pos.y", "pos.z"}) {
    const auto& samples = recording.channels[*find_channel(recording, name)].samples;
    const auto far = std::find_if(samples.begin(), samples.end(), [](double x) { return std::abs(x) > kFarthest; });
    if (far == samples.end()) continue;
    return Error{place(recording, static_cast<std::size_t>(far - samples.begin())) + ": " + name + " is " +
                 shown(*far) + ", expected metres, within 1000 km: give positions in metres from where it starts"};
  }
  return {};
}

Result<void> check_paired(const Recording& recording) {
  if (auto ok = check_motion(recording); !ok) return ok;
  for (std::size_t channel : channels_with_role(recording, Role::kInput)) {
    const auto& samples = recording.channels[channel].samples;
    const auto missing = std::find_if(samples.begin(), samples.end(), [](double x) { return std::isnan(x); });
    if (missing == samples.end()) continue;
    return Error{place(recording, static_cast<std::size_t>(missing - samples.begin())) + ": has no " +
                 recording.channels[channel].name + ", expected the wind in every row of a pair: fill it in"};
  }
  const auto clones = numbers_attribute(recording, "clones");
  if (!clones) return clones.error();
  if (!*clones || (*clones)->empty()) return {};
  const double count = (*clones)->front();
  if (count >= 1 && count <= kMostClones && count == std::floor(count)) return {};
  return Error{recording.source + ": \"# clones\" is " + shown(count) + ", expected a whole number from 1 to " +
               shown(kMostClones, 6) + ": how many episodes in a row belong to one gust"};
}

Result<std::vector<Recording>> read_motions(const std::vector<std::string>& paths, const Arguments& arguments,
                                            Terminal& terminal) {
  std::vector<Recording> recordings;
  for (const std::string& path : paths) {
    auto recording = read_table(path, arguments);
    Result<void> sound;
    if (!recording) {
      sound = recording.error();
    } else {
      sound = find_attribute(*recording, "pair") ? check_paired(*recording) : check_motion(*recording);
    }
    if (sound) {
      recordings.push_back(std::move(*recording));
    } else if (!leave_out(path, sound.error(), arguments, terminal)) {
      return sound.error();
    }
  }
  if (recordings.empty()) return Error{paths.front() + ": none of the recordings can be used"};
  return recordings;
}

Repeats repeats_in(const std::vector<Recording>& recordings) {
  Repeats repeats;
  std::set<std::uint64_t> seen;
  for (const Recording& recording : recordings) {
    for (const Episode& episode : episodes(recording)) {
      ++repeats.episodes;
      if (!seen.insert(hash_of(recording, episode)).second) ++repeats.repeated;
    }
  }
  return repeats;
}

}  // namespace wisp::cli
