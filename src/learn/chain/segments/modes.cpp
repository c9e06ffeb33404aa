#include "learn/chain/segments/modes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "learn/numeric/clustering.hpp"

namespace wisp::chain {
namespace {

constexpr double kMinProbability = 1e-6;

std::uint16_t nearest(const KMeans& found, std::span<const double> row) {
  std::uint16_t best = 0;
  double least = std::numeric_limits<double>::max();
  for (std::size_t k = 0; k < found.sizes.size(); ++k) {
    double distance = 0;
    for (std::size_t i = 0; i < row.size(); ++i) distance += std::pow(row[i] - found.centroids[k * row.size() + i], 2);
    if (distance >= least) continue;
    least = distance;
    best = static_cast<std::uint16_t>(k);
  }
  return best;
}

// Which row of the probabilities counts after the `at` modes before; 0 before the first mode, which has no row.
std::size_t row_after(std::span<const std::uint16_t> sequence, std::size_t at, std::size_t modes, int history) {
  const std::size_t last = sequence[at - 1];
  return history < 2 || at < 2 ? last : modes + sequence[at - 2] * modes + last;
}

// Counts as probabilities; of nothing, what is given instead.
void normalise(std::span<double> counts, std::span<const double> instead) {
  double total = 0;
  for (double count : counts) total += count;
  for (std::size_t k = 0; k < counts.size(); ++k) counts[k] = total > 0 ? counts[k] / total : instead[k];
}

}  // namespace

Result<Modes> sorted_into_modes(const FeatureTable& table, std::size_t learned, int modes, std::uint64_t seed) {
  const std::span values(table.values);
  const auto found = k_means(values.first(learned * table.features), table.features, {.clusters = modes, .seed = seed});
  if (!found) return found.error();
  Modes out{modes, found->cluster, found->sizes,
            silhouette(values.first(learned * table.features), table.features, *found)};
  for (std::size_t row = learned; row < table.rows(); ++row) {
    out.of.push_back(nearest(*found, values.subspan(row * table.features, table.features)));
  }
  return out;
}

ModeChain counted_chain(const ModeSequences& sequences, int modes, int history) {
  const auto count = static_cast<std::size_t>(modes);
  ModeChain chain{history, std::vector<double>(count),
                  std::vector<double>((history > 1 ? count + count * count : count) * count)};
  std::vector<double> overall(count);
  for (const auto& sequence : sequences) {
    for (std::size_t at = 0; at < sequence.size(); ++at) {
      ++overall[sequence[at]];
      if (at == 0) {
        ++chain.initial[sequence[at]];
        continue;
      }
      // Pairs count for their last mode too: for what has none before it, and for pairs that were never followed.
      ++chain.probabilities[sequence[at - 1] * count + sequence[at]];
      if (history > 1 && at > 1) ++chain.probabilities[row_after(sequence, at, count, history) * count + sequence[at]];
    }
  }
  normalise(overall, overall);
  normalise(chain.initial, overall);
  const std::span all(chain.probabilities);
  for (std::size_t row = 0; row * count < all.size(); ++row) {
    const std::size_t last = row % count;
    normalise(all.subspan(row * count, count),
              row < count ? std::span<const double>(overall) : all.subspan(last * count, count));
  }
  return chain;
}

double log_likelihood(const ModeChain& chain, const ModeSequences& sequences) {
  const std::size_t count = chain.initial.size();
  double sum = 0, transitions = 0;
  for (const auto& sequence : sequences) {
    for (std::size_t at = 1; at < sequence.size(); ++at) {
      const std::size_t row = row_after(sequence, at, count, chain.history);
      sum += std::log(std::max(chain.probabilities[row * count + sequence[at]], kMinProbability));
      ++transitions;
    }
  }
  return sum / transitions;
}

}  // namespace wisp::chain
