#include "learn/chain/modes/successor_balance.hpp"

#include <algorithm>
#include <cmath>

namespace wisp::chain {
namespace {

constexpr int kRounds = 60;
constexpr int kWalkSteps = 4;      // of a round: the walk goes on from the round before
constexpr double kStep = 0.15;     // of a price, in usual misfits, where a segment is played e times too often
constexpr double kMaxPrice = 0.3;  // in usual misfits: at 0.5 orientation jumps beyond its 99th percentile at joins

// The misfit that is usual for the last one chosen: what prices are measured in.
double usual_misfit(const Successors& successors, int breadth) {
  std::vector<double> last;
  for (const auto& all : successors) {
    if (all.empty()) continue;
    auto sorted = all;
    const auto at = std::min(all.size(), static_cast<std::size_t>(breadth)) - 1;
    std::nth_element(sorted.begin(), sorted.begin() + static_cast<long>(at), sorted.end());
    last.push_back(sorted[at].misfit);
  }
  const auto middle = last.begin() + static_cast<long>(last.size() / 2);
  std::nth_element(last.begin(), middle, last.end());
  return *middle;
}

std::vector<std::uint16_t> chosen(const Successors& successors, const std::vector<double>& price, int breadth) {
  std::vector<std::uint16_t> follow;
  std::vector<Successor> priced;
  for (const auto& all : successors) {
    priced = all;
    for (Successor& one : priced) one.misfit += price[one.segment];
    const auto count = std::min(priced.size(), static_cast<std::size_t>(breadth));
    std::partial_sort(priced.begin(), priced.begin() + static_cast<long>(count), priced.end());
    for (std::size_t k = 0; k < static_cast<std::size_t>(breadth); ++k) follow.push_back(priced[k % count].segment);
  }
  return follow;
}

// Where a walk that is likely to be at each segment as told is after one more.
std::vector<double> walked(const std::vector<double>& likely, std::span<const std::uint16_t> follow,
                           std::span<const double> chances, int modes, int breadth) {
  std::vector<double> next(likely.size());
  const auto count = static_cast<std::size_t>(modes), wide = static_cast<std::size_t>(breadth);
  for (std::size_t from = 0; from < likely.size(); ++from) {
    for (std::size_t to = 0; to < count; ++to) {
      const double share = likely[from] * chances[from * count + to] / breadth;
      if (share == 0) continue;
      for (std::size_t k = 0; k < wide; ++k) next[follow[(from * count + to) * wide + k]] += share;
    }
  }
  return next;
}

// How much oftener each segment is played than as one that stands for so many of its mode.
std::vector<double> overuse(const std::vector<double>& likely, std::span<const std::uint16_t> mode,
                            std::span<const double> weight, int modes) {
  std::vector<double> sum(static_cast<std::size_t>(modes)), size(static_cast<std::size_t>(modes));
  for (std::size_t k = 0; k < likely.size(); ++k) {
    sum[mode[k]] += likely[k];
    size[mode[k]] += weight[k];
  }
  std::vector<double> over(likely.size(), 1.0);
  for (std::size_t k = 0; k < likely.size(); ++k) {
    if (sum[mode[k]] > 0) over[k] = likely[k] * size[mode[k]] / (sum[mode[k]] * weight[k]);
  }
  return over;
}

}  // namespace

std::vector<std::uint16_t> balanced_successors(const Successors& successors, std::span<const std::uint16_t> mode,
                                               std::span<const double> weight, std::span<const double> chances,
                                               int modes, int breadth) {
  const double usual = usual_misfit(successors, breadth);
  std::vector<double> price(mode.size()), likely(mode.size(), 1.0 / static_cast<double>(mode.size()));
  auto follow = chosen(successors, price, breadth);
  for (int round = 0; round < kRounds; ++round) {
    for (int step = 0; step < kWalkSteps; ++step) {
      likely = walked(likely, follow, chances, modes, breadth);
    }
    const auto over = overuse(likely, mode, weight, modes);
    for (std::size_t k = 0; k < price.size(); ++k) {
      const double rise = kStep * usual * std::log(std::max(over[k], 0.05));
      price[k] = std::clamp(price[k] + rise, 0.0, kMaxPrice * usual);
    }
    follow = chosen(successors, price, breadth);
  }
  return follow;
}

}  // namespace wisp::chain
