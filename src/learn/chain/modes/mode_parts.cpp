#include "learn/chain/modes/mode_parts.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "learn/numeric/clustering.hpp"
#include "wisp/model/chain.hpp"

namespace wisp::chain {
namespace {

constexpr std::size_t kKinds = 2;  // of each half
constexpr int kRestarts = 3;

struct Halves {
  std::vector<Segment> segments;
  std::vector<std::size_t> group;  // mode × 2 + half
};

Halves halves_of(std::span<const Segment> segments, std::span<const std::uint16_t> cluster) {
  Halves out;
  for (std::size_t k = 0; k < segments.size(); ++k) {
    Segment first = segments[k];
    const std::size_t group = std::size_t{cluster[k]} * 2;
    if (first.steps > 1) {
      Segment second = first;
      first.begin = std::round(first.begin);
      first.steps /= 2;
      first.end = second.begin = first.begin + first.steps;
      second.steps -= first.steps;
      second.end = second.begin + second.steps;
      out.segments.insert(out.segments.end(), {first, second});
      out.group.insert(out.group.end(), {group, group + 1});
    } else {
      out.segments.push_back(first);
      out.group.push_back(group);
    }
  }
  return out;
}

}  // namespace

Result<ModeParts> mode_parts(const Motion& motion, std::span<const Segment> segments,
                             std::span<const std::uint16_t> cluster, int modes, const FeatureChoice& features,
                             std::uint64_t seed) {
  Halves halves = halves_of(segments, cluster);
  const auto table = segment_features(motion, halves.segments, features);
  if (!table) return table.error();
  ModeParts parts;
  parts.cluster.resize(halves.segments.size());
  for (std::size_t group = 0; group < static_cast<std::size_t>(modes) * 2; ++group) {
    std::vector<std::size_t> members;
    std::vector<double> values;
    for (std::size_t k = 0; k < halves.group.size(); ++k) {
      if (halves.group[k] != group) continue;
      members.push_back(k);
      const auto row = table->values.begin() + static_cast<long>(k * table->features);
      values.insert(values.end(), row, row + static_cast<long>(table->features));
    }
    if (members.empty()) continue;
    const auto kinds = static_cast<int>(std::min(kKinds, members.size()));
    const auto found = k_means(values, table->features, {.clusters = kinds, .restarts = kRestarts, .seed = seed});
    if (!found) return found.error();
    for (std::size_t k = 0; k < members.size(); ++k) {
      parts.cluster[members[k]] = static_cast<std::uint16_t>(parts.modes + found->cluster[k]);
    }
    parts.modes += kinds;
    parts.parent.insert(parts.parent.end(), static_cast<std::size_t>(kinds), static_cast<std::uint16_t>(group / 2));
  }
  if (static_cast<std::size_t>(parts.modes) > kMaxModes) {
    return Error{"chains of " + std::to_string(modes) + " modes of their own make " + std::to_string(parts.modes) +
                 " kinds of segment, expected at most 256: choose fewer modes"};
  }
  parts.segments = std::move(halves.segments);
  return parts;
}

}  // namespace wisp::chain
