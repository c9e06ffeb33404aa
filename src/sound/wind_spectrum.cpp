#include "sound/wind_spectrum.hpp"

#include <algorithm>

#include "sound/wind_filters.hpp"

namespace wisp::wind {
namespace {

constexpr double kWindowSeconds = 0.093;
constexpr double kLowestHz = 60;
constexpr double kHighestHz = 1000;
constexpr double kQuarter = 0.2876820724517809;  // first quartile of an exponential distribution of mean 1

/// One period of cosine and sine over the window's length, and the window.
struct Tables {
  explicit Tables(std::size_t length) : cosine(length), sine(length), window(length) {
    for (std::size_t i = 0; i < length; ++i) {
      const Turn turn = turn_of(static_cast<double>(i) / static_cast<double>(length));
      cosine[i] = static_cast<float>(turn.cos);
      sine[i] = static_cast<float>(turn.sin);
      window[i] = static_cast<float>(0.5 - 0.5 * turn.cos);
    }
  }

  std::vector<float> cosine, sine, window;
};

float power_at(std::size_t turns, const std::vector<float>& sound, const Tables& tables) {
  float re = 0;
  float im = 0;
  std::size_t at = 0;
  for (const float x : sound) {
    re += x * tables.cosine[at];
    im += x * tables.sine[at];
    at += turns;
    if (at >= sound.size()) at -= sound.size();
  }
  return re * re + im * im;
}

}  // namespace

Spectra::Spectra(const std::vector<std::vector<float>>& channels, double rate_hz, const std::vector<double>& middles) {
  const auto length = static_cast<std::size_t>(kWindowSeconds * rate_hz + 0.5);
  const double width_hz = rate_hz / static_cast<double>(length);
  const auto first = static_cast<std::size_t>(kLowestHz / width_hz + 1);
  bands_ = static_cast<std::size_t>(kHighestHz / width_hz) + 1 - first;
  powers_.assign(middles.size() * bands_, 0.0F);
  const Tables tables(length);
  std::vector<float> piece(length);
  for (std::size_t k = 0; k < middles.size(); ++k) {
    const auto begin = static_cast<std::ptrdiff_t>(middles[k] * rate_hz) - static_cast<std::ptrdiff_t>(length / 2);
    for (const std::vector<float>& sound : channels) {
      for (std::size_t i = 0; i < length; ++i) {
        const std::ptrdiff_t at = begin + static_cast<std::ptrdiff_t>(i);
        const bool there = at >= 0 && at < static_cast<std::ptrdiff_t>(sound.size());
        piece[i] = there ? sound[static_cast<std::size_t>(at)] * tables.window[i] : 0.0F;
      }
      for (std::size_t b = 0; b < bands_; ++b) powers_[k * bands_ + b] += power_at(first + b, piece, tables);
    }
  }
}

void Spectra::add(std::size_t k, double weight, std::vector<double>& sum) const {
  sum.resize(bands_, 0.0);
  for (std::size_t b = 0; b < bands_; ++b) sum[b] += weight * static_cast<double>(frame(k)[b]);
}

float power_between(const float* powers, const BandMeans& means) {
  std::vector<double> needed;
  for (std::size_t b = 0; b < means.wind.size(); ++b) {
    if (means.wind[b] > 0)
      needed.push_back((static_cast<double>(powers[b]) / kQuarter - means.room[b]) / means.wind[b]);
  }
  if (needed.empty()) return 0;
  const auto quarter = needed.begin() + static_cast<std::ptrdiff_t>(needed.size() / 4);
  std::nth_element(needed.begin(), quarter, needed.end());
  return static_cast<float>(std::max(*quarter, 0.0));
}

}  // namespace wisp::wind
