
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "simulate/candle/wind_signal.hpp"
#include "simulate/option_range.hpp"
#include "simulate/random_numbers.hpp"

namespace wisp {
namespace {

using flow::RandomNumbers;

constexpr double kOtherLevel = 0.05;  // typical root mean square of a sound other than wind

// A two-pole resonance.
class Resonance {
 public:
  Resonance() = default;
  Resonance(double frequency_hz, double decay_seconds, double rate_hz) {
    const double radius = std::exp(-1 / (decay_seconds * rate_hz));
    const double angle = 2 * std::numbers::pi * std::min(frequency_hz, 0.45 * rate_hz) / rate_hz;
    a1_ = 2 * radius * std::cos(angle);
    a2_ = -radius * radius;
    // An impulse response has an amplitude of about 1.
    gain_ = std::sin(angle);
  }

  double next(double x) {
    const double y = gain_ * x + a1_ * y1_ + a2_ * y2_;
    y2_ = y1_;
    y1_ = std::abs(y) < 1e-20 ? 0.0 : y;
    return y1_;
  }

 private:
  double a1_ = 0, a2_ = 0, gain_ = 0, y1_ = 0, y2_ = 0;
};

// Generates silence with occasional sounds of about unit level other than wind: a few syllables of a voice, a knock or
// two on the table.
class OtherSounds {
 public:
  /// `a_second`: mean number of sounds per second.
  OtherSounds(double rate_hz, double a_second, std::uint64_t seed)
      : rate_hz_(rate_hz), a_second_(a_second), random_(seed, 3) {
    wait();
  }

  double next() {
    if (!sounding()) {
      if (gap_-- > 0) return 0;
      start();
    }
    const double value = is_voice_ ? voice() : knock();
    if (++place_ >= length_) wait();
    return value;
  }

  bool sounding() const { return place_ < length_; }

 private:
  void wait() {
    const double seconds = a_second_ > 0 ? random_.uniform(0.3, 1.7) / a_second_ : 1e9;
    gap_ = static_cast<std::int64_t>(seconds * rate_hz_);
    place_ = length_ = 0;
  }

  void start() {
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

  double voice() {
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

  double knock() {
    const auto every = static_cast<std::int64_t>(knock_seconds_ * rate_hz_);
    const double blow = place_ % std::max<std::int64_t>(every, 1) == 0 ? 1 : 0;
    return 4 * (resonances_[0].next(blow) + 0.6 * resonances_[1].next(blow) + 0.3 * resonances_[2].next(blow));
  }

  double rate_hz_;
  double a_second_;
  RandomNumbers random_;
  std::array<Resonance, 3> resonances_;
  std::int64_t gap_ = 0;    // samples until the next sound
  std::int64_t place_ = 0;  // position in the sound, samples
  std::int64_t length_ = 0;
  bool is_voice_ = false;
  double pitch_hz_ = 0, glide_ = 0, phase_ = 0, syllable_seconds_ = 0, knock_seconds_ = 0;
};

Result<void> check(const VirtualMicrophoneOptions& o) {
  return flow::check_ranges("virtual microphone", {
                                                      {"rate_hz", o.rate_hz, 4000, 192000},
                                                      {"exponent", o.exponent, 0.5, 4},
                                                      {"level", o.level, 1e-6, 1},
                                                      {"corner_hz", o.corner_hz, 20, std::min(5000.0, 0.4 * o.rate_hz)},
                                                      {"hiss", o.hiss, 0, 0.1},
                                                      {"other_sounds", o.other_sounds, 0, 10},
                                                  });
}

}  // namespace

struct VirtualMicrophone::Parts {
  explicit Parts(const VirtualMicrophoneOptions& o)
      : options(o),
        wind_noise(o.seed, 1),
        hiss_noise(o.seed, 2),
        rumble(o.corner_hz, o.rate_hz),
        others(o.rate_hz, o.other_sounds, o.seed) {}

  VirtualMicrophoneOptions options;
  flow::RandomNumbers wind_noise, hiss_noise;
  flow::LowPass rumble;
  OtherSounds others;
};

VirtualMicrophone::VirtualMicrophone(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
VirtualMicrophone::VirtualMicrophone(VirtualMicrophone&&) noexcept = default;
VirtualMicrophone& VirtualMicrophone::operator=(VirtualMicrophone&&) noexcept = default;
VirtualMicrophone::~VirtualMicrophone() = default;

Result<VirtualMicrophone> VirtualMicrophone::create(const VirtualMicrophoneOptions& options) {
  if (auto good = check(options); !good) return good.error();
  return VirtualMicrophone(std::make_unique<Parts>(options));
}

void VirtualMicrophone::hear(std::span<const float> wind, std::span<float> sound) {
  Parts& p = *parts_;
  const VirtualMicrophoneOptions& o = p.options;
  for (std::size_t k = 0; k < sound.size(); ++k) {
    const double speed = std::abs(static_cast<double>(wind[k]));
    const double loudness = o.level * (o.exponent == 2 ? speed * speed : std::pow(speed, o.exponent));
    double value = loudness * p.rumble.next(p.wind_noise.normal()) + o.hiss * p.hiss_noise.normal();
    value += kOtherLevel * p.others.next();
    sound[k] = static_cast<float>(std::clamp(value, -1.0, 1.0));
  }
}

}  // namespace wisp
