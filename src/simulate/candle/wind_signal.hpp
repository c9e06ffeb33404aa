#pragma once
// Wind as a function of time (calm, gusts with rests between them, or a recording's channel), and its sound.

#include <cmath>
#include <memory>
#include <span>
#include <vector>

#include "wisp/base/result.hpp"
#include "wisp/record/recording.hpp"
#include "wisp/simulate/candle_clip.hpp"

namespace wisp::flow {

/// Filter that colours white noise: a Butterworth low-pass of order 2 by the bilinear transform, scaled so that the
/// output has the power of the white input.
class LowPass {
 public:
  /// Precondition: 0 < corner_hz < rate_hz / 2.
  LowPass(double corner_hz, double rate_hz) {
    const double k = std::tan(3.14159265358979323846 * corner_hz / rate_hz);
    const double norm = 1 / (1 + std::sqrt(2.0) * k + k * k);
    b_ = k * k * norm;
    a1_ = 2 * (k * k - 1) * norm;
    a2_ = (1 - std::sqrt(2.0) * k + k * k) * norm;
    double energy = 0;
    const int long_enough = static_cast<int>(20 * rate_hz / corner_hz);
    for (int n = 0; n < long_enough; ++n) {
      const double y = next(n == 0 ? 1.0 : 0.0);
      energy += y * y;
    }
    s1_ = s2_ = 0;
    b_ /= std::sqrt(energy);
  }

  double next(double x) {
    const double y = b_ * x + s1_;
    s1_ = 2 * b_ * x - a1_ * y + s2_;
    s2_ = b_ * x - a2_ * y;
    return y;
  }

 private:
  double b_ = 0, a1_ = 0, a2_ = 0, s1_ = 0, s2_ = 0;
};

}  // namespace wisp::flow

namespace wisp {

/// A wind sampled at a fixed rate.
class WindSignal {
 public:
  /// Generates a wind, `seconds` long. Errors: an option outside its range, or more than 86400 seconds.
  static Result<WindSignal> generate(const WindSignalOptions& options, double seconds);

  /// Reads a recording's only input, in m/s, with missing samples interpolated linearly.
  /// Errors: not one input, a rate that is not above 0, only missing samples, or a wind beyond ±10 m/s.
  static Result<WindSignal> from_recording(const Recording& recording);

  /// Returns the wind at a time, interpolated linearly and constant beyond the ends.
  double at(double seconds) const;

  const std::vector<double>& samples() const { return samples_; }

  /// Returns the times at which an extinguished candle is relit, ascending, in seconds.
  const std::vector<double>& relights() const { return relights_; }

 private:
  double rate_hz_ = 0;
  std::vector<double> relights_;
  std::vector<double> samples_;
};

/// A microphone at the candle: sound of wind on its capsule, hiss, and occasional sounds other than wind. Made block by
/// block; equal wind and seed give equal samples for any division into blocks. Source: R. Raspet, G. Webster et al. on
/// wind noise as stagnation pressure, and its account in Acoustics Today (2021): pressure is proportional to the square
/// of the wind, its spectrum is flat below a corner and falls steeply above.
class VirtualMicrophone {
 public:
  /// Errors: an option outside its range.
  static Result<VirtualMicrophone> create(const VirtualMicrophoneOptions& options = {});

  VirtualMicrophone(VirtualMicrophone&&) noexcept;
  VirtualMicrophone& operator=(VirtualMicrophone&&) noexcept;
  ~VirtualMicrophone();

  /// Makes the next sound.size() samples, mono, clipped to ±1, as by a recorder. `wind` holds the wind in m/s at each
  /// of them; its sign does not matter. Precondition: wind.size() == sound.size().
  void hear(std::span<const float> wind, std::span<float> sound);

 private:
  struct Parts;
  explicit VirtualMicrophone(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

}  // namespace wisp
