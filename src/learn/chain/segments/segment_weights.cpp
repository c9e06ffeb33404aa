#include "learn/chain/segments/segment_weights.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>

namespace wisp::chain {
namespace {

constexpr double kMaxWeight = 4;     // what hardly any recording was long enough to show, would else stand for many
constexpr double kFewCutOff = 0.05;  // of all that began: their lengths are as they were seen, but for chance

// A segment that began: how long it was seen, and which one it is where it was seen whole.
struct Seen {
  double rows;
  std::size_t segment;
};

constexpr std::size_t kCutOff = static_cast<std::size_t>(-1);

// All that began, the shortest first; of those that were seen as long, whole ones before what was cut off.
std::vector<Seen> all_that_began(const Motion& motion, std::span<const Segment> segments) {
  std::vector<Seen> all;
  for (std::size_t k = 0; k < segments.size(); ++k) {
    const Segment& one = segments[k];
    all.push_back({one.end - one.begin, k});
    const bool last = k + 1 == segments.size() || segments[k + 1].piece != one.piece;
    if (last) all.push_back({static_cast<double>(motion.pieces[one.piece].rows() - 1) - one.end, kCutOff});
  }
  std::stable_sort(all.begin(), all.end(), [](const Seen& a, const Seen& b) {
    return a.rows < b.rows || (a.rows == b.rows && a.segment != kCutOff && b.segment == kCutOff);
  });
  return all;
}

}  // namespace

std::vector<double> segment_weights(const Motion& motion, std::span<const Segment> segments) {
  const std::vector<Seen> all = all_that_began(motion, segments);
  std::vector<double> weight(segments.size(), 1);
  const auto cut_off = static_cast<double>(all.size() - segments.size());
  if (cut_off < kFewCutOff * static_cast<double>(all.size())) return weight;
  double going_on = 1;  // how likely a recording goes on for as long after a segment's beginning
  for (std::size_t k = 0; k < all.size(); ++k) {
    const auto at_risk = static_cast<double>(all.size() - k);
    if (all[k].segment == kCutOff)
      going_on *= 1 - 1 / at_risk;
    else
      weight[all[k].segment] = std::min(kMaxWeight, 1 / going_on);
  }
  const double mean = std::accumulate(weight.begin(), weight.end(), 0.0) / static_cast<double>(weight.size());
  for (double& one : weight) one /= mean;
  return weight;
}

}  // namespace wisp::chain
