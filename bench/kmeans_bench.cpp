// K-means of 100 000 rows of 12 numbers into 6 clusters, the best of 10 starts; bench/peers/kmeans.py has scikit-learn
// do the same with the same rows.

#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdint>
#include <vector>

#include "learn/numeric/clustering.hpp"

namespace {

constexpr std::size_t kRows = 100'000, kColumns = 12, kClouds = 9;

// The peer makes the same words: a linear congruential generator of 64 bits, its upper half.
class Words {
 public:
  double next() {
    state_ = state_ * 6364136223846793005U + 1442695040888963407U;
    return static_cast<double>(state_ >> 32) / 4294967296.0;
  }

 private:
  std::uint64_t state_ = 1;
};

// Nine clouds that overlap: no clusters that any start would find.
std::vector<double> clouds() {
  Words words;
  std::vector<double> centroids(kClouds * kColumns), rows;
  for (double& x : centroids) x = 3 * words.next();
  for (std::size_t row = 0; row < kRows; ++row) {
    for (std::size_t column = 0; column < kColumns; ++column) {
      const double noise = words.next() + words.next() + words.next() - 1.5;
      rows.push_back(centroids[row % kClouds * kColumns + column] + 1.5 * noise);
    }
  }
  return rows;
}

void k_means_of_100000(benchmark::State& state) {
  const auto rows = clouds();
  double inertia = 0;
  for (auto _ : state) {
    const auto found = wisp::k_means(rows, kColumns, {.clusters = 6});
    inertia = found->inertia;
  }
  state.counters["inertia"] = inertia;
}
BENCHMARK(k_means_of_100000)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();

}  // namespace
