#pragma once
// Filters of the wind estimator, and their design.

#include <numbers>
#include <vector>

namespace wisp::wind {

using std::numbers::pi;

/// Coefficients of one second-order section: gain · zeros / (1 + a1 z⁻¹ + a2 z⁻²); Filter has the zeros of each kind.
/// The gain is applied once to the band's power, not to every sample.
struct Section {
  float a1 = 0;
  float a2 = 0;
  double gain = 1;
};

/// Section design by the bilinear transform (R. Bristow-Johnson, Cookbook formulae for audio equalizer biquad filters).
/// Uses only + − × ÷ and square root, so that designs are the same bits on every machine.
/// Precondition: 0 < frequency_hz < rate_hz / 2, q > 0.
Section high_pass(double frequency_hz, double q, double rate_hz);
Section low_pass(double frequency_hz, double q, double rate_hz);
Section band_pass(double frequency_hz, double q, double rate_hz);

/// Returns the taps of a linear-phase low-pass: windowed sinc (Hamming), with gain 1 at 0 Hz. Precondition: taps >= 1,
/// 0 < cutoff < 0.5 (as a share of the sample rate).
std::vector<float> windowed_sinc(int taps, double cutoff);

/// Sine and cosine of an angle in turns, 0 to 1.
struct Turn {
  double sin;
  double cos;
};
Turn turn_of(double share);

/// Returns the power gain of the filter x(t) − zero · x(t−1) at a frequency.
double power_of_zero(double zero, double frequency_hz, double rate_hz);

/// Returns 1 − e^(−step / time constant), the weight of one step in an exponential average; 1 if the constant is <= 0.
double approach(double step_seconds, double constant_seconds);

/// State of a section (direct form II), without its gain.
template <class T>
class Filter {
 public:
  explicit Filter(const Section& s) : a1_(s.a1), a2_(s.a2) {}

  /// Filters as a high-pass: zeros 1 − 2 z⁻¹ + z⁻².
  T high(T x) {
    const T w = recurse(x);
    const T y = (w - d1_) - (d1_ - d2_);
    shift(w);
    return y;
  }

  /// Filters as a low-pass: zeros 1 + 2 z⁻¹ + z⁻².
  T low(T x) {
    const T w = recurse(x);
    const T y = (w + d1_) + (d1_ + d2_);
    shift(w);
    return y;
  }

  /// Filters as a band-pass: zeros 1 − z⁻².
  T band(T x) {
    const T w = recurse(x);
    const T y = w - d2_;
    shift(w);
    return y;
  }

  /// Sets state below −300 dB (1e-15) to 0. Called once per hop, it prevents denormal numbers (below 1e-38), which only
  /// some machines flush to zero: in a hop even the fastest filter decays by less than 18 of these 23 decades.
  void hush() {
    const T least = T(1e-15F);
    const bool quiet = d1_ < least && T(-1e-15F) < d1_ && d2_ < least && T(-1e-15F) < d2_;
    if (quiet) d1_ = d2_ = T(0.0F);
  }

 private:
  T recurse(T x) const { return x - a1_ * d1_ - a2_ * d2_; }

  void shift(T w) {
    d2_ = d1_;
    d1_ = w;
  }

  T a1_;
  T a2_;
  T d1_ = T(0.0F);
  T d2_ = T(0.0F);
};

}  // namespace wisp::wind
