#include "learn/numeric/chi_squared.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace wisp {
namespace {

// Maximum number of terms. Near the mean both expansions reach rounding after about 9√a terms: enough for a up to 1e8.
constexpr int kMaxTerms = 100000;
constexpr double kEnough = 1e-16;

double log_density(double a, double x) { return a * std::log(x) - x - std::lgamma(a); }

double lower_by_series(double a, double x) {
  double term = 1 / a;
  double sum = term;
  for (int n = 1; n < kMaxTerms && std::abs(term) > kEnough * sum; ++n) {
    term *= x / (a + n);
    sum += term;
  }
  return sum * std::exp(log_density(a, x));
}

double upper_by_fraction(double a, double x) {
  constexpr double kTiny = 1e-300;
  double b = x + 1 - a;
  double c = 1 / kTiny;
  double d = 1 / b;
  double value = d;
  for (int n = 1; n < kMaxTerms; ++n) {
    const double numerator = -n * (n - a);
    b += 2;
    d = numerator * d + b;
    if (std::abs(d) < kTiny) d = kTiny;
    c = b + numerator / c;
    if (std::abs(c) < kTiny) c = kTiny;
    d = 1 / d;
    value *= d * c;
    if (std::abs(d * c - 1) < kEnough) break;
  }
  return value * std::exp(log_density(a, x));
}

// Wilson–Hilferty approximation, with Hastings' rational approximation of the normal quantile.
double first_guess(double p, double freedom) {
  const double tail = std::min(p, 1 - p);
  const double t = std::sqrt(-2 * std::log(tail));
  const double z =
      t - (2.515517 + t * (0.802853 + t * 0.010328)) / (1 + t * (1.432788 + t * (0.189269 + t * 0.001308)));
  const double root = 1 - 2 / (9 * freedom) + (p < 0.5 ? -z : z) * std::sqrt(2 / (9 * freedom));
  return freedom * root * root * root;
}

}  // namespace

double chi_squared_tail(double value, double freedom) {
  assert(freedom > 0);
  if (std::isnan(value)) return value;
  if (value <= 0) return 1;
  const double a = freedom / 2;
  const double x = value / 2;
  return x < a + 1 ? 1 - lower_by_series(a, x) : upper_by_fraction(a, x);
}

double chi_squared_quantile(double p, double freedom) {
  assert(freedom > 0 && p > 0 && p < 1);
  double low = 0;
  double high = freedom + 1;
  while (1 - chi_squared_tail(high, freedom) < p) low = high, high *= 2;
  double value = first_guess(p, freedom);
  if (!(value > low && value < high)) value = low + (high - low) / 2;
  // Newton's method; a step that would leave the bracket is replaced by bisection.
  for (int step = 0; step < 200; ++step) {
    const double excess = 1 - chi_squared_tail(value, freedom) - p;
    (excess < 0 ? low : high) = value;
    const double density = std::exp(log_density(freedom / 2, value / 2)) / value;
    double next = value - excess / density;
    if (!(next > low && next < high)) next = low + (high - low) / 2;
    const bool settled = std::abs(next - value) <= 1e-12 * next;
    value = next;
    if (settled) break;
  }
  return value;
}

}  // namespace wisp
