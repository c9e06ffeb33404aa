#include "learn/fidelity/fidelity_energy.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <numeric>

#include "learn/fidelity/fidelity_shuffle.hpp"

namespace wisp {
namespace {

// Behaviour remembers, and neighbouring blocks touch. Measured on a resonance against itself (80 seeds, memory of a
// window): with blocks of four windows a tenth of the p-values fall below 0.05, still somewhat too many.
constexpr std::size_t kBlockWindows = 4;

double distance(std::span<const double> a, std::span<const double> b) {
  double sum = 0;
  for (std::size_t f = 0; f < a.size(); ++f) sum += (a[f] - b[f]) * (a[f] - b[f]);
  return std::sqrt(sum);
}

// All windows of both sides and the distances between them.
struct Pool {
  std::size_t size = 0;
  std::vector<double> distances;    // size × size
  std::vector<std::size_t> blocks;  // of x, then of y, all different

  Pool(const FeatureWindows& x, const FeatureWindows& y) : size(x.size() + y.size()), distances(size * size) {
    const auto window = [&](std::size_t i) { return i < x.size() ? x.window(i) : y.window(i - x.size()); };
    for (std::size_t i = 0; i < size; ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        distances[i * size + j] = distances[j * size + i] = distance(window(i), window(j));
      }
    }
    blocks = x.blocks;
    const std::size_t first_of_y = x.blocks.back() + 1;
    for (std::size_t block : y.blocks) blocks.push_back(first_of_y + block);
  }
};

double mean_pair(double sum, double pairs) { return sum / pairs; }

double energy_distance(const Pool& pool, std::span<const std::uint8_t> in_y) {
  double xx = 0;
  double yy = 0;
  double xy = 0;
  for (std::size_t i = 0; i < pool.size; ++i) {
    double to_x = 0;
    double to_y = 0;
    const double* row = &pool.distances[i * pool.size];
    for (std::size_t j = 0; j < pool.size; ++j) (in_y[j] != 0 ? to_y : to_x) += row[j];
    if (in_y[i] != 0) {
      yy += to_y;
    } else {
      xx += to_x;
      xy += to_y;
    }
  }
  const auto m = static_cast<double>(std::accumulate(in_y.begin(), in_y.end(), std::size_t{0}));
  const double n = static_cast<double>(pool.size) - m;
  if (n == 0 || m == 0 || xy == 0) return 0;
  const double across = 2 * mean_pair(xy, n * m);
  return (across - mean_pair(xx, n * n) - mean_pair(yy, m * m)) / across;
}

// Deals whole blocks to the two sides anew, as many to y as there were.
std::vector<std::uint8_t> dealt(const Pool& pool, std::vector<std::size_t>& order, std::size_t blocks_of_y,
                                std::mt19937_64& random) {
  shuffle(std::span(order), random);
  std::vector<std::uint8_t> block_in_y(order.size(), 0);
  for (std::size_t k = 0; k < blocks_of_y; ++k) block_in_y[order[k]] = 1;
  std::vector<std::uint8_t> in_y(pool.size);
  for (std::size_t i = 0; i < pool.size; ++i) in_y[i] = block_in_y[pool.blocks[i]];
  return in_y;
}

void append_window(const Stretch& stretch, std::size_t first, std::size_t rows, FeatureWindows& out) {
  for (std::size_t t = first; t < first + rows; ++t) {
    const auto row = stretch.row(t);
    out.values.insert(out.values.end(), row.begin(), row.end());
  }
  for (std::size_t t = first; t < first + rows; ++t) {
    for (std::size_t c = 0; c < stretch.channels; ++c) out.values.push_back(stretch(t, c) - stretch(t - 1, c));
  }
}

}  // namespace

FeatureWindows motion_windows(std::span<const Stretch> stretches, std::size_t rows, std::size_t hop) {
  assert(rows >= 1 && hop >= 1);
  FeatureWindows out;
  std::size_t block_base = 0;
  for (const Stretch& stretch : stretches) {
    out.features = 2 * rows * stretch.channels;
    // The first row of a stretch has no row before it, so it starts no window.
    for (std::size_t first = 1; first + rows <= stretch.rows(); first += hop) {
      append_window(stretch, first, rows, out);
      out.blocks.push_back(block_base + (first - 1) / (kBlockWindows * rows));
    }
    if (!out.blocks.empty()) block_base = out.blocks.back() + 1;
  }
  return out;
}

FeatureWindows thinned(const FeatureWindows& windows, std::size_t most) {
  if (windows.size() <= most) return windows;
  FeatureWindows out{windows.features, {}, {}};
  std::size_t last_block = 0;
  for (std::size_t k = 0; k < most; ++k) {
    const std::size_t i = k * windows.size() / most;
    const auto window = windows.window(i);
    out.values.insert(out.values.end(), window.begin(), window.end());
    const bool new_block = !out.blocks.empty() && windows.blocks[i] != last_block;
    out.blocks.push_back(out.blocks.empty() ? 0 : out.blocks.back() + (new_block ? 1 : 0));
    last_block = windows.blocks[i];
  }
  return out;
}

void standardise(FeatureWindows& reference, FeatureWindows& other) {
  // A feature that never moves differs by rounding alone, which must not be blown up to the size of the others.
  constexpr double kStill = 1e-9;
  const auto n = static_cast<double>(reference.size());
  std::vector<double> mean(reference.features), sd(reference.features);
  for (std::size_t f = 0; f < reference.features; ++f) {
    for (std::size_t i = 0; i < reference.size(); ++i) mean[f] += reference.values[i * reference.features + f] / n;
    double variance = 0;
    for (std::size_t i = 0; i < reference.size(); ++i) {
      const double deviation = reference.values[i * reference.features + f] - mean[f];
      variance += deviation * deviation / n;
    }
    sd[f] = std::sqrt(variance);
  }
  const double largest = *std::max_element(sd.begin(), sd.end());
  for (FeatureWindows* side : {&reference, &other}) {
    for (std::size_t k = 0; k < side->values.size(); ++k) {
      const std::size_t f = k % side->features;
      side->values[k] = (side->values[k] - mean[f]) / (sd[f] > kStill * largest ? sd[f] : std::max(largest, 1e-300));
    }
  }
}

EnergyTest energy_test(const FeatureWindows& x, const FeatureWindows& y, std::size_t permutations, std::uint64_t seed) {
  assert(x.size() > 0 && y.size() > 0 && x.features == y.features);
  const Pool pool(x, y);
  std::vector<std::uint8_t> in_y(pool.size, 0);
  std::fill(in_y.begin() + static_cast<std::ptrdiff_t>(x.size()), in_y.end(), std::uint8_t{1});
  EnergyTest test;
  test.distance = energy_distance(pool, in_y);
  std::mt19937_64 random(seed);
  std::vector<std::size_t> order(pool.blocks.back() + 1);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::size_t as_large = 1;
  for (std::size_t k = 0; k < permutations; ++k) {
    const auto exchanged = dealt(pool, order, y.blocks.back() + 1, random);
    if (energy_distance(pool, exchanged) >= test.distance) ++as_large;
  }
  test.p_value = static_cast<double>(as_large) / static_cast<double>(permutations + 1);
  return test;
}

}  // namespace wisp
