#include "simulate/candle/virtual_microphone.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include "simulate/candle/low_pass.hpp"
#include "simulate/candle/other_sounds.hpp"
#include "simulate/option_range.hpp"
#include "simulate/random_numbers.hpp"

namespace wisp {
namespace {

Result<void> check(const VirtualMicrophoneOptions& o) {
  return flow::check_ranges("virtual microphone", {
                                                      {"rate_hz", o.rate_hz, 4000, 192000},
                                                      {"exponent", o.exponent, 0.5, 4},
                                                      {"level", o.level, 1e-6, 1},
                                                      {"corner_hz", o.corner_hz, 20, std::min(5000.0, 0.4 * o.rate_hz)},
                                                      {"hiss", o.hiss, 0, 0.1},
                                                      {"hum", o.hum, 0, 0.1},
                                                      {"other_sounds", o.other_sounds, 0, 10},
                                                      {"other_level", o.other_level, 0, 1},
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
  flow::OtherSounds others;
  std::int64_t count = 0;
  bool other = false;
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
  const double hum_step = 2 * std::numbers::pi * 50 / o.rate_hz;
  p.other = false;
  for (std::size_t k = 0; k < sound.size(); ++k) {
    const double speed = std::abs(static_cast<double>(wind[k]));
    const double loudness = o.level * (o.exponent == 2 ? speed * speed : std::pow(speed, o.exponent));
    double value = loudness * p.rumble.next(p.wind_noise.normal()) + o.hiss * p.hiss_noise.normal();
    if (o.hum > 0) value += o.hum * std::sin(hum_step * static_cast<double>(p.count));
    value += o.other_level * p.others.next();
    p.other = p.other || p.others.sounding();
    sound[k] = static_cast<float>(std::clamp(value, -1.0, 1.0));
    ++p.count;
  }
}

bool VirtualMicrophone::other_sound() const { return parts_->other; }

}  // namespace wisp
