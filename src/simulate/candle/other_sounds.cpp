#include "simulate/candle/other_sounds.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace wisp::flow {
Resonance::Resonance(double frequency_hz, double decay_seconds, double rate_hz) {
  const double radius = std::exp(-1 / (decay_seconds * rate_hz));
  const double angle = 2 * std::numbers::pi * std::min(frequency_hz, 0.45 * rate_hz) / rate_hz;
  a1_ = 2 * radius * std::cos(angle);
  a2_ = -radius * radius;
  // An impulse rings with an amplitude of about 1.
  gain_ = std::sin(angle);
}

double Resonance::next(double x) {
  const double y = gain_ * x + a1_ * y1_ + a2_ * y2_;
  y2_ = y1_;
  y1_ = std::abs(y) < 1e-20 ? 0.0 : y;
  return y1_;
}

OtherSounds::OtherSounds(double rate_hz, double a_second, std::uint64_t seed)
    : rate_hz_(rate_hz), a_second_(a_second), random_(seed, 3) {
  wait();
}

void OtherSounds::wait() {
  const double seconds = a_second_ > 0 ? random_.uniform(0.3, 1.7) / a_second_ : 1e9;
  gap_ = static_cast<std::int64_t>(seconds * rate_hz_);
  place_ = length_ = 0;
}

void OtherSounds::start() {
  is_voice_ = random_.uniform() < 0.5;
  place_ = 0;
  phase_ = 1;
  if (is_voice_) {
    length_ = static_cast<std::int64_t>(random_.uniform(0.4, 1.2) * rate_hz_);
    pitch_hz_ = random_.uniform(95, 220);
    glide_ = random_.uniform(-0.25, 0.1);
    syllable_seconds_ = random_.uniform(0.16, 0.28);
    resonances_ = {Resonance(random_.uniform(350, 750), 0.006, rate_hz_),
                   Resonance(random_.uniform(1000, 1900), 0.004, rate_hz_), Resonance(2600, 0.003, rate_hz_)};
  } else {
    length_ = static_cast<std::int64_t>(random_.uniform(0.2, 0.7) * rate_hz_);
    knock_seconds_ = random_.uniform(0.15, 0.3);
    resonances_ = {Resonance(random_.uniform(120, 300), 0.02, rate_hz_),
                   Resonance(random_.uniform(500, 900), 0.01, rate_hz_), Resonance(1800, 0.004, rate_hz_)};
  }
}

double OtherSounds::voice() {
  const double t = static_cast<double>(place_) / rate_hz_;
  phase_ += pitch_hz_ * (1 + glide_ * t) / rate_hz_;
  double pulse = 0;
  if (phase_ >= 1) {
    phase_ -= 1;
    pulse = 1;
  }
  const double mouth = 0.5 * (1 - std::cos(2 * std::numbers::pi * t / syllable_seconds_));
  const double ends = std::min(1.0, 30 * static_cast<double>(length_ - place_) / rate_hz_);
  return 2.2 * mouth * ends *
         (resonances_[0].next(pulse) + 0.5 * resonances_[1].next(pulse) + 0.25 * resonances_[2].next(pulse));
}

double OtherSounds::knock() {
  const auto every = static_cast<std::int64_t>(knock_seconds_ * rate_hz_);
  const double blow = place_ % std::max<std::int64_t>(every, 1) == 0 ? 1 : 0;
  return 4 * (resonances_[0].next(blow) + 0.6 * resonances_[1].next(blow) + 0.3 * resonances_[2].next(blow));
}

double OtherSounds::next() {
  if (!sounding()) {
    if (gap_-- > 0) return 0;
    start();
  }
  const double value = is_voice_ ? voice() : knock();
  if (++place_ >= length_) wait();
  return value;
}

}  // namespace wisp::flow
