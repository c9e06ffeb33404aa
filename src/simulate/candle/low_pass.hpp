#pragma once
// Coloured noise: a two-pole low-pass whose output has the power of its input, when that is white.

namespace wisp::flow {

/// Butterworth, by the bilinear transform.
class LowPass {
 public:
  /// Precondition: 0 < corner_hz < rate_hz / 2.
  LowPass(double corner_hz, double rate_hz);

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
