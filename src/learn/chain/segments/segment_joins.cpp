#include "learn/chain/segments/segment_joins.hpp"

#include <algorithm>

#include "learn/chain/modes/successor_balance.hpp"

namespace wisp::chain {
namespace {

constexpr std::size_t kLookedAt = 64;  // nearest ones, of which those that are played too often give way
constexpr double kMaxGain = 0.4;       // of the variance of velocity: what falls is not sped up by more at once
constexpr double kGainCost = 4;  // a join that does counts as twice as far away: it is taken where others are none

// How much faster a segment begins than another ends: the square of its speed over the other's, in variances. Moments
// begin with velocity in such units.
double gain_of(const JoinMoment& end, const JoinMoment& start) {
  double gain = 0;
  for (std::size_t k = 0; k < std::min<std::size_t>(3, start.size()); ++k)
    gain += start[k] * start[k] - end[k] * end[k];
  return gain;
}

Successors candidates_of(const SegmentMoments& moments, std::span<const std::uint16_t> mode,
                         std::span<const double> weight, int modes) {
  std::vector<std::vector<std::uint16_t>> members(static_cast<std::size_t>(modes));
  for (std::size_t k = 0; k < mode.size(); ++k) members[mode[k]].push_back(static_cast<std::uint16_t>(k));
  Successors candidates;
  // One buffer for all: each list that is kept has kLookedAt at most, not room for all of its mode.
  std::vector<Successor> near;
  for (std::size_t from = 0; from < mode.size(); ++from) {
    for (const auto& all : members) {
      near.clear();
      for (std::uint16_t to : all) {
        if (to == from && all.size() > 1) continue;
        near.push_back({distance_of(moments.ends[from], moments.starts[to]), to});
      }
      const std::size_t looked_at = std::min(near.size(), kLookedAt);
      std::partial_sort(near.begin(), near.begin() + static_cast<long>(looked_at), near.end());
      near.resize(looked_at);  // keeps its room
      for (Successor& one : near) {
        // Of two that stood beside each other in a plane of moments, the nearer one would be as much nearer.
        one.misfit /= weight[one.segment];
        if (gain_of(moments.ends[from], moments.starts[one.segment]) > kMaxGain) one.misfit *= kGainCost;
      }
      candidates.emplace_back(near.begin(), near.end());
    }
  }
  return candidates;
}

}  // namespace

std::vector<std::uint16_t> best_successors(const SegmentMoments& moments, std::span<const std::uint16_t> mode,
                                           int modes, int breadth, std::span<const double> weight,
                                           std::span<const double> chances) {
  return balanced_successors(candidates_of(moments, mode, weight, modes), mode, weight, chances, modes, breadth);
}

}  // namespace wisp::chain
