#include "learn/fidelity/fidelity_long.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "learn/numeric/constants.hpp"

namespace wisp {
namespace {

constexpr double kThinnedHz = 15;
constexpr int kBands = 13;
constexpr std::size_t kMinWindows = 8;           // a side: fewer tell chance
constexpr double kTailShares[] = {0.99, 0.999};  // of the sizes of second differences
constexpr std::size_t kMinTail = 1000;           // rows that a percentile of 99.9 wants

// Power of every frequency from 1 to rows / 2 cycles a window: the transform is short, and its tables are made once.
class Transform {
 public:
  explicit Transform(std::size_t rows) : rows_(rows), cosine_(rows), sine_(rows), hann_(rows) {
    for (std::size_t k = 0; k < rows; ++k) {
      const double turn = 2 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(rows);
      cosine_[k] = std::cos(turn);
      sine_[k] = std::sin(turn);
      hann_[k] = 0.5 - 0.5 * std::cos(turn);
    }
  }

  std::vector<double> power(std::vector<double> samples) const {
    double mean = 0;
    for (double sample : samples) mean += sample / static_cast<double>(rows_);
    for (std::size_t k = 0; k < rows_; ++k) samples[k] = (samples[k] - mean) * hann_[k];
    std::vector<double> out;
    for (std::size_t f = 1; f <= rows_ / 2; ++f) {
      double real = 0, imaginary = 0;
      for (std::size_t k = 0, at = 0; k < rows_; ++k, at = (at + f) % rows_) {
        real += samples[k] * cosine_[at];
        imaginary += samples[k] * sine_[at];
      }
      out.push_back(real * real + imaginary * imaginary);
    }
    return out;
  }

 private:
  std::size_t rows_;
  std::vector<double> cosine_, sine_, hann_;
};

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

void append_spectra(const Stretch& stretch, std::size_t first, std::size_t rows, const Transform& transform,
                    std::vector<double>& out) {
  constexpr double kMin = 1e-12;  // of nothing that moves
  for (std::size_t c = 0; c < stretch.channels; ++c) {
    std::vector<double> samples(rows);
    for (std::size_t t = 0; t < rows; ++t) samples[t] = stretch(first + t, c);
    const std::vector<double> power = transform.power(std::move(samples));
    for (const auto& [from, to] : bands_of(power.size())) {
      double sum = 0;
      for (std::size_t f = from; f < to; ++f) sum += power[f];
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

}  // namespace

FeatureWindows spectral_windows(std::span<const Stretch> stretches, std::size_t rows, std::size_t hop) {
  constexpr std::size_t kBlockWindows = 4;
  const Transform transform(rows);
  FeatureWindows out;
  std::size_t first_block = 0;
  for (const Stretch& stretch : stretches) {
    if (stretch.rows() < rows) continue;
    std::size_t block = first_block;
    for (std::size_t first = 0; first + rows <= stretch.rows(); first += hop) {
      const std::size_t before = out.values.size();
      append_spectra(stretch, first, rows, transform, out.values);
      out.features = out.values.size() - before;
      block = first_block + first / (kBlockWindows * rows);
      out.blocks.push_back(block);
    }
    first_block = block + 1;
  }
  return out;
}

LongDistances long_distances(std::span<const Stretch> a, std::span<const Stretch> b, const LongOptions& options) {
  const auto rows = static_cast<std::size_t>(std::lround(options.window_seconds * options.rate_hz));
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

}  // namespace wisp
