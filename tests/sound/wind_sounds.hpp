#pragma once
// Sounds made for the tests of the wind level: blowing, a voice, knocks, a room. Mono, full scale 1, any rate.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <span>
#include <vector>

namespace wisp::sounds {

using Samples = std::vector<float>;

/// Random numbers that are the same everywhere (Numerical Recipes' 64-bit linear congruence).
class Chance {
 public:
  explicit Chance(std::uint64_t seed) : state_(seed * 2 + 1) {
    for (int i = 0; i < 4; ++i) uniform();
  }

  /// 0 to 1.
  double uniform() {
    state_ = state_ * 6364136223846793005ULL + 1442695040888963407ULL;
    return static_cast<double>(state_ >> 11) * 0x1p-53;
  }

  /// Mean 0, variance 1: a sum of twelve.
  double normal() {
    double sum = -6;
    for (int i = 0; i < 12; ++i) sum += uniform();
    return sum;
  }

 private:
  std::uint64_t state_;
};

/// A resonance (or, with q near 0.7, a low-pass of two poles) with gain 1 at 0 Hz.
class Resonance {
 public:
  Resonance(double frequency_hz, double q, double rate_hz) {
    const double w = 2 * std::numbers::pi * std::min(frequency_hz, 0.45 * rate_hz) / rate_hz;
    const double alpha = std::sin(w) / (2 * q);
    b0_ = (1 - std::cos(w)) / 2 / (1 + alpha);
    a1_ = -2 * std::cos(w) / (1 + alpha);
    a2_ = (1 - alpha) / (1 + alpha);
  }

  double next(double x) {
    const double y = b0_ * (x + 2 * x1_ + x2_) - a1_ * y1_ - a2_ * y2_;
    x2_ = x1_;
    x1_ = x;
    y2_ = y1_;
    y1_ = y;
    return y;
  }

 private:
  double b0_, a1_, a2_;
  double x1_ = 0, x2_ = 0, y1_ = 0, y2_ = 0;
};

inline std::size_t count(double seconds, double rate_hz) { return static_cast<std::size_t>(seconds * rate_hz + 0.5); }

inline double rms_of(std::span<const float> samples) {
  double sum = 0;
  for (const float x : samples) sum += static_cast<double>(x) * static_cast<double>(x);
  return samples.empty() ? 0 : std::sqrt(sum / static_cast<double>(samples.size()));
}

inline void scale_to(Samples& samples, double rms) {
  const double now = rms_of(samples);
  for (float& x : samples) x = static_cast<float>(static_cast<double>(x) * rms / now);
}

inline void add(Samples& to, const Samples& what, double at_seconds, double rate_hz) {
  const std::size_t begin = count(at_seconds, rate_hz);
  to.resize(std::max(to.size(), begin + what.size()));
  for (std::size_t i = 0; i < what.size(); ++i) to[begin + i] += what[i];
}

/// A room's hiss: white.
inline Samples room(double seconds, double rate_hz, double rms, std::uint64_t seed = 1) {
  Chance chance(seed);
  Samples samples(count(seconds, rate_hz));
  for (float& x : samples) x = static_cast<float>(rms * chance.normal());
  return samples;
}

/// Wind on a capsule: noise, flat below 300 Hz and falling by 12 dB an octave, RMS `rms` where the wind is 1 and going
/// with its square. `wind` gives the wind at a time.
template <class Wind>
Samples blowing(double seconds, double rate_hz, double rms, Wind wind, std::uint64_t seed = 2) {
  Chance chance(seed);
  Resonance fall(300, 0.707, rate_hz);
  Samples samples(count(seconds, rate_hz));
  for (float& x : samples) x = static_cast<float>(fall.next(chance.normal()));
  scale_to(samples, rms);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double u = wind(static_cast<double>(i) / rate_hz);
    samples[i] = static_cast<float>(static_cast<double>(samples[i]) * u * u);
  }
  return samples;
}

inline Samples steady_blowing(double seconds, double rate_hz, double rms, std::uint64_t seed = 2) {
  return blowing(
      seconds, rate_hz, rms, [](double) { return 1.0; }, seed);
}

/// Somebody talking: glottal pulses of a gliding pitch through three formants that change from syllable to syllable,
/// four syllables a second with gaps, a hiss of an "s" before every third.
inline Samples voice(double seconds, double rate_hz, double pitch_hz, double rms, std::uint64_t seed = 3) {
  Chance chance(seed);
  Samples samples(count(seconds, rate_hz), 0.0F);
  double phase = 0;
  for (double begin = 0.1; begin < seconds - 0.3; begin += 0.25) {
    if (chance.uniform() < 0.2) continue;  // a pause
    const double length = 0.14 + 0.06 * chance.uniform();
    const double pitch = pitch_hz * (0.85 + 0.3 * chance.uniform());
    const double glide = 0.2 * (chance.uniform() - 0.5);
    Resonance glottis(100, 0.5, rate_hz);
    Resonance first(350 + 450 * chance.uniform(), 6, rate_hz);
    Resonance second(1000 + 1000 * chance.uniform(), 10, rate_hz);
    Resonance third(2500, 12, rate_hz);
    const std::size_t at = count(begin, rate_hz);
    const std::size_t n = count(length, rate_hz);
    for (std::size_t i = 0; i < n && at + i < samples.size(); ++i) {
      const double t = static_cast<double>(i) / static_cast<double>(n);
      phase += pitch * (1 + glide * t) * (1 + 0.01 * chance.normal()) / rate_hz;
      const bool pulse = phase >= 1;
      if (pulse) phase -= 1;
      // The pulse's share that falls on each sample keeps its energy at any rate.
      const double source = glottis.next(pulse ? rate_hz / pitch : 0.0);
      const double sound = first.next(source) + 0.4 * second.next(source) + 0.1 * third.next(source);
      const double envelope = std::sin(std::numbers::pi * t);
      samples[at + i] += static_cast<float>(envelope * sound);
    }
    if (chance.uniform() > 0.33) continue;
    double before = 0;
    for (std::size_t i = 0; i < n / 3 && at >= n / 3; ++i) {
      const double now = chance.normal();
      samples[at - n / 3 + i] += static_cast<float>(0.05 * (now - before));
      before = now;
    }
  }
  scale_to(samples, rms);
  return samples;
}

/// Knocks on a table every 0.6 s: a few modes of 150 to 900 Hz that die away in 15 to 40 ms.
inline Samples knocks(double seconds, double rate_hz, double peak, std::uint64_t seed = 4) {
  Chance chance(seed);
  Samples samples(count(seconds, rate_hz), 0.0F);
  for (double begin = 0.3; begin < seconds - 0.3; begin += 0.6) {
    const std::size_t at = count(begin + 0.1 * chance.uniform(), rate_hz);
    for (int mode = 0; mode < 4; ++mode) {
      const double frequency = 150 + 750 * chance.uniform();
      const double decay = 0.015 + 0.025 * chance.uniform();
      for (std::size_t i = 0; i < count(0.25, rate_hz) && at + i < samples.size(); ++i) {
        const double t = static_cast<double>(i) / rate_hz;
        samples[at + i] +=
            static_cast<float>(peak / 3 * std::exp(-t / decay) * std::sin(2 * std::numbers::pi * frequency * t));
      }
    }
  }
  return samples;
}

/// Major chords of a bass, struck every 0.75 s and dying away: low, without a common period that a voice could have.
inline Samples chords(double seconds, double rate_hz, double rms) {
  const double roots[] = {82.4, 110, 98, 123.5};
  Samples samples(count(seconds, rate_hz));
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double t = static_cast<double>(i) / rate_hz;
    double sum = 0;
    for (const double ratio : {1.0, 1.25, 1.5, 2.0}) {
      const double f = roots[static_cast<std::size_t>(t / 0.75) % 4] * ratio;
      for (int h = 1; h <= 5; ++h) sum += std::sin(2 * std::numbers::pi * f * h * t) / (h * h);
    }
    samples[i] = static_cast<float>(sum * std::exp(-std::fmod(t, 0.75) / 0.4));
  }
  scale_to(samples, rms);
  return samples;
}

}  // namespace wisp::sounds
