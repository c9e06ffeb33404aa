#include "learn/fidelity/fidelity_distance.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

#include "base/statistics.hpp"
#include "learn/numeric/constants.hpp"
#include "learn/numeric/spectrum.hpp"

namespace wisp {
namespace {

bool complete(const Recording& recording, std::span<const std::size_t> channels, std::size_t row) {
  return std::none_of(channels.begin(), channels.end(),
                      [&](std::size_t c) { return std::isnan(recording.channels[c].samples[row]); });
}

Stretch rows_of(const Stretch& stretch, std::size_t first, std::size_t last) {
  const auto begin = stretch.values.begin();
  return {stretch.channels, {begin + first * stretch.channels, begin + last * stretch.channels}};
}

double distance(std::span<const double> a, std::span<const double> b) {
  double sum = 0;
  for (std::size_t f = 0; f < a.size(); ++f) sum += (a[f] - b[f]) * (a[f] - b[f]);
  return std::sqrt(sum);
}

double mean_distance(const FeatureWindows& x, const FeatureWindows& y) {
  double sum = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    for (std::size_t j = 0; j < y.size(); ++j) sum += distance(x.window(i), y.window(j));
  }
  return sum / static_cast<double>(x.size() * y.size());
}

void append_window(const Stretch& stretch, std::size_t first, std::size_t rows, FeatureWindows& out) {
  const auto values = std::span(stretch.values).subspan(first * stretch.channels, rows * stretch.channels);
  out.values.insert(out.values.end(), values.begin(), values.end());
  for (std::size_t t = first; t < first + rows; ++t) {
    for (std::size_t c = 0; c < stretch.channels; ++c) out.values.push_back(stretch(t, c) - stretch(t - 1, c));
  }
}

constexpr double kLongSeconds = 2;            // duration of a long window
constexpr std::size_t kMaxLongWindows = 300;  // maximum number on each side
constexpr double kThinnedHz = 15;
constexpr int kBands = 13;
constexpr std::size_t kMinWindows = 8;           // minimum on each side: with fewer, chance dominates distances
constexpr double kTailShares[] = {0.99, 0.999};  // quantiles of the sizes of second differences
constexpr std::size_t kMinTail = 1000;           // minimum number of rows for the 99.9th percentile

// Frequency bands [first, last) with widths in geometric progression, at least one frequency each.
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
  constexpr double kMin = 1e-12;  // power floor, for channels that do not move
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
    for (std::size_t t = 0; t < stretch.rows(); t += step) thin.add(stretch.row(t));
  }
  return out;
}

double energy_of(FeatureWindows x, FeatureWindows y) {
  if (x.size() < kMinWindows || y.size() < kMinWindows) return kMissing;
  standardise(x, y);
  return energy_distance(x, y);
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
  for (std::size_t c = 0; c < channels; ++c) out.push_back(tolerance * deviation(joined(channel_of(real, c))));
  return out;
}

bool alike(std::span<const double> a, std::span<const double> b, std::span<const double> tolerance) {
  for (std::size_t c = 0; c < a.size(); ++c) {
    if (!(std::abs(a[c] - b[c]) <= tolerance[c])) return false;
  }
  return true;
}

// run[j]: length of the common run that ends at row i of `a` and row j − 1 of `b`.
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

std::vector<std::vector<double>> channel_of(std::span<const Stretch> stretches, std::size_t channel) {
  std::vector<std::vector<double>> out;
  for (const Stretch& stretch : stretches) {
    auto& samples = out.emplace_back();
    for (std::size_t t = 0; t < stretch.rows(); ++t) samples.push_back(stretch(t, channel));
  }
  return out;
}

Result<std::vector<Stretch>> stretches_of(const Recording& recording, std::span<const std::string> channels) {
  std::vector<std::size_t> indices;
  for (const std::string& name : channels) {
    const auto index = find_channel(recording, name);
    if (!index) return Error{recording.source + ": there is no channel " + name};
    indices.push_back(*index);
  }
  std::vector<Stretch> stretches;
  for (const Episode& episode : episodes(recording)) {
    bool open = false;
    for (std::size_t row = episode.begin; row < episode.end; ++row) {
      if (!complete(recording, indices, row)) {
        open = false;
        continue;
      }
      if (!open) stretches.push_back({indices.size(), {}});
      open = true;
      for (std::size_t c : indices) stretches.back().values.push_back(recording.channels[c].samples[row]);
    }
  }
  return stretches;
}

std::size_t total_rows(std::span<const Stretch> stretches) {
  return std::accumulate(stretches.begin(), stretches.end(), std::size_t{0},
                         [](std::size_t sum, const Stretch& stretch) { return sum + stretch.rows(); });
}

std::vector<Stretch> cut_to(std::span<const Stretch> stretches, std::size_t max_rows) {
  std::vector<Stretch> pieces;
  for (const Stretch& stretch : stretches) {
    for (std::size_t first = 0; first < stretch.rows(); first += max_rows) {
      pieces.push_back(rows_of(stretch, first, std::min(stretch.rows(), first + max_rows)));
    }
  }
  return pieces;
}

Halves halves_of(std::span<const Stretch> stretches) {
  Halves halves;
  std::size_t left = total_rows(stretches) / 2;
  for (const Stretch& stretch : stretches) {
    const std::size_t before = std::min(left, stretch.rows());
    if (before > 0) halves.first.push_back(rows_of(stretch, 0, before));
    if (before < stretch.rows()) halves.second.push_back(rows_of(stretch, before, stretch.rows()));
    left -= before;
  }
  return halves;
}

std::vector<Stretch> shuffled(std::span<const Stretch> stretches, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<Stretch> out;
  for (const Stretch& stretch : stretches) {
    std::vector<std::size_t> order(stretch.rows());
    std::iota(order.begin(), order.end(), std::size_t{0});
    shuffle(std::span(order), random);
    Stretch& mixed = out.emplace_back(Stretch{stretch.channels, {}});
    mixed.values.reserve(stretch.values.size());
    for (std::size_t t : order) mixed.add(stretch.row(t));
  }
  return out;
}

FeatureWindows motion_windows(std::span<const Stretch> stretches, std::size_t rows, std::size_t hop) {
  assert(rows >= 1 && hop >= 1);
  FeatureWindows out;
  for (const Stretch& stretch : stretches) {
    out.features = 2 * rows * stretch.channels;
    // The first row of a stretch has no difference to a row before, so no window starts there.
    for (std::size_t first = 1; first + rows <= stretch.rows(); first += hop) append_window(stretch, first, rows, out);
  }
  return out;
}

FeatureWindows thinned(const FeatureWindows& windows, std::size_t most) {
  if (windows.size() <= most) return windows;
  FeatureWindows out{windows.features, {}};
  for (std::size_t k = 0; k < most; ++k) {
    const auto window = windows.window(k * windows.size() / most);
    out.values.insert(out.values.end(), window.begin(), window.end());
  }
  return out;
}

void standardise(FeatureWindows& reference, FeatureWindows& other) {
  // A constant feature differs by rounding only, which must not be scaled up to the size of the others.
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

double energy_distance(const FeatureWindows& x, const FeatureWindows& y) {
  assert(x.size() > 0 && y.size() > 0 && x.features == y.features);
  const double across = 2 * mean_distance(x, y);
  return across > 0 ? (across - mean_distance(x, x) - mean_distance(y, y)) / across : 0;
}

FeatureWindows spectral_windows(std::span<const Stretch> stretches, std::size_t rows, std::size_t hop) {
  FeatureWindows out;
  for (const Stretch& stretch : stretches) {
    for (std::size_t first = 0; first + rows <= stretch.rows(); first += hop) {
      const std::size_t before = out.values.size();
      append_spectra(stretch, first, rows, out.values);
      out.features = out.values.size() - before;
    }
  }
  return out;
}

LongDistances long_distances(std::span<const Stretch> a, std::span<const Stretch> b, double rate_hz, bool motion_only) {
  const std::size_t rows = std::lround(kLongSeconds * rate_hz) / 2 * 2;
  if (rows < 8) return {kMissing, kMissing, tails_apart(a, b)};
  const auto hop_of = [&](std::span<const Stretch> side, std::size_t step) {
    return std::max<std::size_t>(1, total_rows(side) / step / kMaxLongWindows);
  };
  const std::size_t step = std::max<std::size_t>(1, static_cast<std::size_t>(rate_hz / kThinnedHz));
  const auto motion = [&](std::span<const Stretch> side) {
    return thinned(motion_windows(every(side, step), rows / step, hop_of(side, step)), kMaxLongWindows);
  };
  const auto spectra = [&](std::span<const Stretch> side) {
    return thinned(spectral_windows(side, rows, hop_of(side, 1)), kMaxLongWindows);
  };
  if (motion_only) return {energy_of(motion(a), motion(b)), kMissing, kMissing};
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
