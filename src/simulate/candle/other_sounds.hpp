#pragma once
// Sounds at a candle that are not wind: a few syllables of a voice, a knock or two on the table.

#include <array>
#include <cstdint>

#include "simulate/random_numbers.hpp"

namespace wisp::flow {

/// A two-pole resonance.
class Resonance {
 public:
  Resonance() = default;
  Resonance(double frequency_hz, double decay_seconds, double rate_hz);
  double next(double x);

 private:
  double a1_ = 0, a2_ = 0, gain_ = 0, y1_ = 0, y2_ = 0;
};

/// Sample after sample of silence, and now and then a sound of about unit level.
class OtherSounds {
 public:
  /// `a_second` sounds a second on average.
  OtherSounds(double rate_hz, double a_second, std::uint64_t seed);

  double next();
  bool sounding() const { return place_ < length_; }

 private:
  void wait();
  void start();
  double voice();
  double knock();

  double rate_hz_;
  double a_second_;
  RandomNumbers random_;
  std::array<Resonance, 3> resonances_;
  std::int64_t gap_ = 0;    // samples until the next sound
  std::int64_t place_ = 0;  // within the sound
  std::int64_t length_ = 0;
  bool is_voice_ = false;
  double pitch_hz_ = 0, glide_ = 0, phase_ = 0, syllable_seconds_ = 0, knock_seconds_ = 0;
};

}  // namespace wisp::flow
