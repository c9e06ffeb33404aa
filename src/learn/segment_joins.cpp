#include "learn/segment_joins.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "learn/follower_balance.hpp"
#include "learn/join_jumps.hpp"

namespace wisp {
namespace {

// Attitude counts as much as velocity and spin together: a jump of attitude is what the eye sees first.
constexpr double kAttitudeWeight = 1.5;

constexpr std::size_t kLookedAt = 64;  // nearest ones of which the jumps are foreseen
// Jumps that come near the recording's 99th percentile count against a follower, and soon more than all else.
constexpr double kSmooth = 0.8;
constexpr double kJumpWeight = 15;

// What must agree at a join, as numbers of one length.
std::vector<double> moment_of(const Motion& motion, std::size_t piece, double row, bool heading_free) {
  const MotionPiece& from = motion.pieces[piece];
  const Triple velocity = at_row(from.velocity, row);
  if (!motion.has_orientation) {
    if (heading_free) return {std::hypot(velocity[0], velocity[1]), velocity[2]};
    return {velocity.begin(), velocity.end()};
  }
  const Quad q = at_row(from.orientation, row);
  const Triple spin = at_row(from.spin, row);
  std::vector<double> moment;
  const auto add = [&](const Triple& vector) { moment.insert(moment.end(), vector.begin(), vector.end()); };
  if (heading_free) {
    add(in_body_axes(q, velocity));
    add(in_body_axes(q, spin));
    add(in_body_axes(q, {0, 0, 1}));
  } else {
    add(velocity);
    add(spin);
    for (const Triple& axis : {Triple{1, 0, 0}, Triple{0, 1, 0}, Triple{0, 0, 1}}) add(in_world_axes(q, axis));
  }
  return moment;
}

// The inverse standard deviation of each group of three, so that axes keep their proportions.
std::vector<double> weights_of(const std::vector<std::vector<double>>& moments, bool attitude) {
  const std::size_t size = moments.front().size();
  std::vector<double> weight(size, 1.0);
  for (std::size_t group = 0; group < size; group += 3) {
    const std::size_t end = std::min(size, group + 3);
    double spread = 0;
    for (std::size_t k = group; k < end; ++k) {
      double mean = 0, square = 0;
      for (const auto& moment : moments) mean += moment[k];
      mean /= static_cast<double>(moments.size());
      for (const auto& moment : moments) square += (moment[k] - mean) * (moment[k] - mean);
      spread += square / static_cast<double>(moments.size());
    }
    const double unit = spread > 0 ? 1 / std::sqrt(spread) : 1;
    for (std::size_t k = group; k < end; ++k) weight[k] = attitude && group >= 6 ? kAttitudeWeight * unit : unit;
  }
  return weight;
}

Followers candidates_of(const std::vector<std::vector<double>>& starts, const std::vector<std::vector<double>>& ends,
                        std::span<const std::uint16_t> mode, int modes, const std::vector<double>& weight,
                        const JoinForesight& foresight) {
  std::vector<std::vector<std::uint16_t>> members(static_cast<std::size_t>(modes));
  for (std::size_t k = 0; k < mode.size(); ++k) members[mode[k]].push_back(static_cast<std::uint16_t>(k));
  Followers candidates;
  for (std::size_t from = 0; from < mode.size(); ++from) {
    for (const auto& all : members) {
      std::vector<Follower> near;
      for (std::uint16_t to : all) {
        if (to == from && all.size() > 1) continue;
        double distance = 0;
        for (std::size_t k = 0; k < weight.size(); ++k) {
          const double away = ends[from][k] - starts[to][k];
          distance += away * away;
        }
        near.push_back({distance, to});
      }
      const std::size_t looked_at = std::min(near.size(), kLookedAt);
      std::partial_sort(near.begin(), near.begin() + static_cast<long>(looked_at), near.end());
      near.resize(looked_at);
      for (Follower& one : near) {
        const double beyond = std::max(0.0, foresight.jump(from, one.segment) - kSmooth);
        one.misfit += kJumpWeight * beyond * beyond;
      }
      candidates.push_back(std::move(near));
    }
  }
  return candidates;
}

}  // namespace

std::vector<std::uint16_t> best_followers(const Motion& motion, std::span<const Segment> segments,
                                          std::span<const std::uint16_t> mode, int modes, bool heading_free,
                                          int breadth, const ChainBlend& blend, std::span<const double> transitions) {
  const JoinForesight foresight(motion, segments, heading_free, blend);
  std::vector<std::vector<double>> starts, ends;
  for (const Segment& segment : segments) {
    starts.push_back(moment_of(motion, segment.piece, segment.begin, heading_free));
    ends.push_back(moment_of(motion, segment.piece, segment.end, heading_free));
  }
  const auto weight = weights_of(starts, motion.has_orientation);
  for (auto* all : {&starts, &ends}) {
    for (auto& moment : *all) {
      for (std::size_t k = 0; k < weight.size(); ++k) moment[k] *= weight[k];
    }
  }
  const auto candidates = candidates_of(starts, ends, mode, modes, weight, foresight);
  return balanced_followers(candidates, mode, transitions, modes, breadth);
}

}  // namespace wisp
