#include "sound/wind_filters.hpp"

#include <cmath>
#include <cstddef>

namespace wisp::wind {
namespace {

/// Returns sin and cos of x, |x| <= 4: series at x / 256, then eight doublings of the angle; error below 1e-14. The C
/// library's results may differ in the last bit between machines.
Turn sin_cos(double x) {
  const double y = x / 256;
  const double y2 = y * y;
  double s = y * (1 - y2 / 6 * (1 - y2 / 20 * (1 - y2 / 42)));
  double v = y2 / 2 * (1 - y2 / 12 * (1 - y2 / 30 * (1 - y2 / 56)));  // 1 − cos: cos itself would lose digits
  for (int i = 0; i < 8; ++i) {
    const double c = 1 - v;
    v = 2 * s * s;
    s = 2 * s * c;
  }
  return {s, 1 - v};
}

/// Returns sin for any positive angle.
double sine(double x) {
  const double turns = std::floor(x / (2 * pi) + 0.5);
  return sin_cos(x - turns * 2 * pi).sin;
}

struct Denominator {
  double sin;
  double cos;
  double alpha;
};

Denominator denominator(double frequency_hz, double q, double rate_hz) {
  const Turn w = sin_cos(2 * pi * frequency_hz / rate_hz);
  return {w.sin, w.cos, w.sin / (2 * q)};
}

Section section(const Denominator& d, double numerator) {
  const double a0 = 1 + d.alpha;
  return {static_cast<float>(-2 * d.cos / a0), static_cast<float>((1 - d.alpha) / a0), numerator / a0};
}

}  // namespace

Section high_pass(double frequency_hz, double q, double rate_hz) {
  const Denominator d = denominator(frequency_hz, q, rate_hz);
  return section(d, (1 + d.cos) / 2);
}

Section low_pass(double frequency_hz, double q, double rate_hz) {
  const Denominator d = denominator(frequency_hz, q, rate_hz);
  return section(d, (1 - d.cos) / 2);
}

Section band_pass(double frequency_hz, double q, double rate_hz) {
  const Denominator d = denominator(frequency_hz, q, rate_hz);
  return section(d, d.alpha);
}

std::vector<float> windowed_sinc(int taps, double cutoff) {
  std::vector<double> exact(static_cast<std::size_t>(taps));
  double sum = 0;
  for (int i = 0; i < taps; ++i) {
    const double from_middle = i - (taps - 1) / 2.0;
    const double angle = 2 * pi * cutoff * from_middle;
    const double sinc = from_middle == 0 ? 2 * cutoff : (angle < 0 ? -sine(-angle) : sine(angle)) / (pi * from_middle);
    const double window = taps == 1 ? 1 : 0.54 + 0.46 * sin_cos(2 * pi * from_middle / (taps - 1)).cos;
    exact[static_cast<std::size_t>(i)] = sinc * window;
    sum += sinc * window;
  }
  std::vector<float> rounded;
  rounded.reserve(exact.size());
  for (const double tap : exact) rounded.push_back(static_cast<float>(tap / sum));
  return rounded;
}

Turn turn_of(double share) { return sin_cos((share > 0.5 ? share - 1 : share) * 2 * pi); }

double power_of_zero(double zero, double frequency_hz, double rate_hz) {
  const double difference = 2 * sin_cos(pi * frequency_hz / rate_hz).sin;
  return (1 - zero) * (1 - zero) + zero * difference * difference;
}

double approach(double step_seconds, double constant_seconds) {
  if (constant_seconds <= 0) return 1;
  // (e^(−x/1024))^1024 by squaring; the series' remainder is below 1e-15 for x <= 4, beyond which the answer is near 1.
  const double x = step_seconds / constant_seconds;
  if (x > 30) return 1;
  const double y = x / 1024;
  double e = 1 - y * (1 - y / 2 * (1 - y / 3 * (1 - y / 4 * (1 - y / 5))));
  for (int i = 0; i < 10; ++i) e *= e;
  return 1 - e;
}

}  // namespace wisp::wind
