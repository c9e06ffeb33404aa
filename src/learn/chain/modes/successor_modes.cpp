#include "learn/chain/modes/successor_modes.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace wisp::chain {
namespace {

constexpr std::size_t kNear = 8;         // of 24, some begin too far away to be joined
constexpr double kUnseen = 0.025;        // of its usual chance that a mode keeps which none of them is of
constexpr double kMinTransition = 1e-3;  // rarer ones were seen by chance
constexpr double kMaxShare = 65535;

using Near = std::pair<double, std::size_t>;

// Shares of the modes among what the recorded segments stand for that begin nearest to a moment.
std::vector<double> nearby(const JoinMoment& moment, const std::vector<JoinMoment>& starts,
                           std::span<const std::uint16_t> mode, std::span<const double> weight, std::size_t modes) {
  std::vector<Near> near;
  for (std::size_t k = 0; k < starts.size(); ++k) near.emplace_back(distance_of(moment, starts[k]), k);
  const std::size_t count = std::min(near.size(), kNear);
  std::nth_element(near.begin(), near.begin() + static_cast<long>(count) - 1, near.end());
  std::vector<double> share(modes);
  double all = 0;
  for (std::size_t k = 0; k < count; ++k) {
    share[mode[near[k].second]] += weight[near[k].second];
    all += weight[near[k].second];
  }
  for (double& one : share) one /= all;
  return share;
}

}  // namespace

SuccessorModes successor_modes(const SegmentMoments& recorded, std::span<const std::uint16_t> mode,
                               std::span<const double> weight, std::span<const std::size_t> kept,
                               std::span<const double> transitions, int modes) {
  const auto count = static_cast<std::size_t>(modes);
  SuccessorModes out;
  for (std::size_t segment : kept) {
    const auto share = nearby(recorded.ends[segment], recorded.starts, mode, weight, count);
    std::vector<double> ratio(count), chance(count);
    for (std::size_t k = 0; k < count; ++k) {
      const double usual = transitions[mode[segment] * count + k];
      ratio[k] = share[k] / std::max(usual, kMinTransition) + kUnseen;
      chance[k] = usual * ratio[k];
    }
    const double most = *std::max_element(ratio.begin(), ratio.end());
    const double all = std::accumulate(chance.begin(), chance.end(), 0.0);
    for (std::size_t k = 0; k < count; ++k) {
      out.share.push_back(static_cast<std::uint16_t>(std::lround(std::max(1.0, kMaxShare * ratio[k] / most))));
      out.chances.push_back(all > 0 ? chance[k] / all : 1.0 / modes);
    }
  }
  return out;
}

}  // namespace wisp::chain
