#pragma once
// Coloured noise: a two-pole low-pass whose output has the power of its white input.

#include <cmath>

namespace wisp::flow {

/// Butterworth low-pass of order 2, by the bilinear transform.
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
