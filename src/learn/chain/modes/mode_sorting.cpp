#include "learn/chain/modes/mode_sorting.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "learn/chain/modes/mode_chain.hpp"

namespace wisp::chain {
namespace {

constexpr int kMaxAutoModes = 12;

std::vector<std::uint16_t> nearest(const FeatureTable& table, const KMeans& found) {
  std::vector<std::uint16_t> cluster;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    std::size_t best = 0;
    double least = std::numeric_limits<double>::max();
    for (std::size_t k = 0; k < found.sizes.size(); ++k) {
      double distance = 0;
      for (std::size_t i = 0; i < table.features; ++i) {
        const double away = table.values[row * table.features + i] - found.centroids[k * table.features + i];
        distance += away * away;
      }
      if (distance >= least) continue;
      least = distance;
      best = k;
    }
    cluster.push_back(static_cast<std::uint16_t>(best));
  }
  return cluster;
}

Result<SortedSegments> sorted(const FeatureTable& table, std::size_t learned, int modes, const ChainRecipe& recipe) {
  const KMeansOptions clustering{.clusters = modes, .restarts = recipe.restarts, .seed = recipe.seed};
  auto found = k_means(std::span(table.values).first(learned * table.features), table.features, clustering);
  if (!found) return found.error();
  auto cluster = nearest(table, *found);
  // A row that was given to an empty cluster stays there.
  std::copy(found->cluster.begin(), found->cluster.end(), cluster.begin());
  return SortedSegments{std::move(*found), std::move(cluster)};
}

// Mean log-likelihood of held-out features, each mode a normal distribution of one variance around its middle: the one
// measure that chains of different numbers of modes share.
double feature_likelihood(const FeatureTable& table, std::size_t learned, const SortedSegments& modes,
                          std::span<const Segment> segments, int count) {
  const std::size_t columns = table.features;
  const double variance =
      std::max(1e-12, modes.found.inertia / static_cast<double>(learned) / static_cast<double>(columns));
  const auto told = by_stretch(segments.first(learned), std::span(modes.cluster).first(learned));
  const ModeChain chain = estimate_chain(told, count, {.history = 1, .back_off = true});
  const bool judged_apart = learned < table.rows();
  const std::size_t first = judged_apart ? learned : 0;
  const auto judged = by_stretch(segments.subspan(first), std::span(modes.cluster).subspan(first));
  double square = 0;
  for (std::size_t row = first; row < table.rows(); ++row) {
    for (std::size_t k = 0; k < columns; ++k) {
      const double away = table.values[row * columns + k] - modes.found.centroids[modes.cluster[row] * columns + k];
      square += away * away;
    }
  }
  const auto rows = static_cast<double>(table.rows() - first);
  const double spread = -0.5 * (square / rows / variance + static_cast<double>(columns) * std::log(variance));
  const double walk = log_likelihood(chain, judged);
  return spread + (std::isnan(walk) ? 0 : walk);
}

}  // namespace

Result<SortedSegments> sorted_segments(const FeatureTable& table, std::size_t learned,
                                       std::span<const Segment> segments, const ChainRecipe& recipe,
                                       const Progress& progress) {
  if (recipe.modes > 0) return sorted(table, learned, recipe.modes, recipe);
  Result<SortedSegments> best = sorted(table, learned, 1, recipe);
  if (!best) return best;
  double highest = -std::numeric_limits<double>::infinity();
  const int most = std::min(kMaxAutoModes, static_cast<int>(learned));
  for (int modes = 2; modes <= most; ++modes) {
    if (!go_on(progress, "sorting segments", static_cast<double>(modes) / (most + 1)))
      return Error{std::string(kStopped)};
    auto tried = sorted(table, learned, modes, recipe);
    if (!tried) return tried;
    const double likelihood = feature_likelihood(table, learned, *tried, segments, modes);
    if (likelihood <= highest) continue;
    highest = likelihood;
    best = std::move(tried);
  }
  return best;
}

}  // namespace wisp::chain
