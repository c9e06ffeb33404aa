#include "learn/fidelity/fidelity_distance.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>
#include <utility>

#include "base/statistics.hpp"
#include "learn/numeric/constants.hpp"
#include "learn/numeric/spectrum.hpp"

namespace wisp {
namespace {

// Behaviour has memory, and neighbouring blocks touch. Measured on a resonance against itself (80 seeds, memory of a
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
  const double across = 2 * xy / (n * m);
  return (across - xx / (n * n) - yy / (m * m)) / across;
}

// Exchanges whole blocks between the two sides at random; y keeps its number of blocks.
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

constexpr double kThinnedHz = 15;
constexpr int kBands = 13;
constexpr std::size_t kMinWindows = 8;           // a side: with fewer, chance rules
constexpr double kTailShares[] = {0.99, 0.999};  // of the sizes of second differences
constexpr std::size_t kMinTail = 1000;           // fewest rows for the 99.9th percentile

// Bands [first, last) of frequencies that grow by a factor, each at least one wide.
std::vector<std::pair<std::size_t, std::size_t>> bands_of(std::size_t frequencies) {
  std::vector<std::pair<std::size_t, std::size_t>> bands;
  std::size_t first = 0;
  for (int band = 1; band <= kBands && first < frequencies; ++band) {
    const double edge = std::pow(static_cast<double>(frequencies), static_cast<double>(band) / kBands);
    const std::size_t last = band == kBands ? frequencies : static_cast<std::size_t>(std::lround(edge));
    if (last <= first) continue;
    bands.push_back({first, last});
    first = last;
  }
  return bands;
}

void append_spectra(const Stretch& stretch, std::size_t first, std::size_t rows, std::vector<double>& out) {
  constexpr double kMin = 1e-12;  // the power of a channel that does not move
  for (std::size_t c = 0; c < stretch.channels; ++c) {
    std::vector<double> samples(rows);
    for (std::size_t t = 0; t < rows; ++t) samples[t] = stretch(first + t, c);
    const std::vector<double> power = welch({&samples, 1}, 1, rows).power;
    for (const auto& [from, to] : bands_of(power.size() - 1)) {
      double sum = 0;
      for (std::size_t f = from; f < to; ++f) sum += power[f + 1];
      out.push_back(std::log(sum / static_cast<double>(to - from) + kMin));
    }
  }
}

std::vector<Stretch> every(std::span<const Stretch> stretches, std::size_t step) {
  std::vector<Stretch> out;
  for (const Stretch& stretch : stretches) {
    Stretch& thin = out.emplace_back(Stretch{stretch.channels, {}});
    for (std::size_t t = 0; t < stretch.rows(); t += step) {
      const auto row = stretch.row(t);
      thin.values.insert(thin.values.end(), row.begin(), row.end());
    }
  }
  return out;
}

double energy_of(FeatureWindows x, FeatureWindows y) {
  if (x.size() < kMinWindows || y.size() < kMinWindows) return kMissing;
  standardise(x, y);
  return energy_test(x, y, 0, 1).distance;
}

std::vector<double> accelerations(std::span<const Stretch> stretches, std::size_t channel) {
  std::vector<double> out;
  for (const Stretch& stretch : stretches) {
    for (std::size_t t = 2; t < stretch.rows(); ++t) {
      out.push_back(std::abs(stretch(t, channel) - 2 * stretch(t - 1, channel) + stretch(t - 2, channel)));
    }
  }
  std::sort(out.begin(), out.end());
  return out;
}

double tails_apart(std::span<const Stretch> a, std::span<const Stretch> b) {
  double sum = 0, count = 0;
  for (std::size_t c = 0; c < a.front().channels; ++c) {
    const std::vector<double> x = accelerations(a, c), y = accelerations(b, c);
    if (x.size() < kMinTail || y.size() < kMinTail) return kMissing;
    for (double share : kTailShares) {
      const auto at = [share](const std::vector<double>& sorted) {
        return sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1))];
      };
      if (!(at(x) > 0 && at(y) > 0)) continue;
      sum += std::abs(std::log(at(y) / at(x)));
      ++count;
    }
  }
  return count > 0 ? sum / count : 0;
}

std::vector<double> tolerances(std::span<const Stretch> real, double tolerance) {
  std::vector<double> out;
  const std::size_t channels = real.empty() ? 0 : real.front().channels;
  for (std::size_t c = 0; c < channels; ++c) {
    std::vector<double> all;
    for (const Stretch& stretch : real) {
      const auto samples = stretch.channel(c);
      all.insert(all.end(), samples.begin(), samples.end());
    }
    out.push_back(tolerance * deviation(all));
  }
  return out;
}

bool alike(std::span<const double> a, std::span<const double> b, std::span<const double> tolerance) {
  for (std::size_t c = 0; c < a.size(); ++c) {
    if (!(std::abs(a[c] - b[c]) <= tolerance[c])) return false;
  }
  return true;
}

// run[j]: rows of a common run that ends at row i of one and row j of the other.
std::size_t longest_common_run(const Stretch& a, const Stretch& b, std::span<const double> tolerance) {
  std::vector<std::size_t> run(b.rows() + 1, 0);
  std::size_t longest = 0;
  for (std::size_t i = 0; i < a.rows(); ++i) {
    for (std::size_t j = b.rows(); j > 0; --j) {
      run[j] = alike(a.row(i), b.row(j - 1), tolerance) ? run[j - 1] + 1 : 0;
      longest = std::max(longest, run[j]);
    }
  }
  return longest;
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

FeatureWindows spectral_windows(std::span<const Stretch> stretches, std::size_t rows, std::size_t hop) {
  FeatureWindows out;
  std::size_t first_block = 0;
  for (const Stretch& stretch : stretches) {
    if (stretch.rows() < rows) continue;
    std::size_t block = first_block;
    for (std::size_t first = 0; first + rows <= stretch.rows(); first += hop) {
      const std::size_t before = out.values.size();
      append_spectra(stretch, first, rows, out.values);
      out.features = out.values.size() - before;
      block = first_block + first / (kBlockWindows * rows);
      out.blocks.push_back(block);
    }
    first_block = block + 1;
  }
  return out;
}

LongDistances long_distances(std::span<const Stretch> a, std::span<const Stretch> b, const LongOptions& options) {
  const std::size_t rows = std::lround(options.window_seconds * options.rate_hz) / 2 * 2;
  if (rows < 8) return {kMissing, kMissing, tails_apart(a, b)};
  const auto hop_of = [&](std::span<const Stretch> side, std::size_t step) {
    return std::max<std::size_t>(1, total_rows(side) / step / options.max_windows);
  };
  const std::size_t step = std::max<std::size_t>(1, static_cast<std::size_t>(options.rate_hz / kThinnedHz));
  const auto motion = [&](std::span<const Stretch> side) {
    return thinned(motion_windows(every(side, step), rows / step, hop_of(side, step)), options.max_windows);
  };
  const auto spectra = [&](std::span<const Stretch> side) {
    return thinned(spectral_windows(side, rows, hop_of(side, 1)), options.max_windows);
  };
  return {energy_of(motion(a), motion(b)), energy_of(spectra(a), spectra(b)), tails_apart(a, b)};
}

std::size_t longest_verbatim_run(std::span<const Stretch> real, std::span<const Stretch> synthesized,
                                 double tolerance) {
  const std::vector<double> allowed = tolerances(real, tolerance);
  std::size_t longest = 0;
  for (const Stretch& a : real) {
    for (const Stretch& b : synthesized) longest = std::max(longest, longest_common_run(a, b, allowed));
  }
  return longest;
}

}  // namespace wisp
