#include "draw/plot/plot_scale.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace wisp::drawing {
namespace {

// Returns the round number (1, 2 or 5 times a power of ten) that divides the length into about `wanted` steps.
double round_step(double length, int wanted, bool whole_numbers) {
  const double rough = 0.8 * length / wanted;
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  double step = 10 * power;
  for (const double factor : {5.0, 2.0, 1.0}) {
    if (factor * power >= rough) step = factor * power;
  }
  return whole_numbers ? std::max(1.0, std::ceil(step)) : step;
}

std::string superscript(int number) {
  static constexpr std::array<const char*, 10> kDigits{"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string text = number < 0 ? "⁻" : "";
  for (const char digit : std::to_string(std::abs(number))) text += kDigits[digit - '0'];
  return text;
}

std::string formatted(double value, int decimals) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%.*f", decimals, std::abs(value));
  const bool zero = std::string_view(text.data()).find_first_not_of("0.") == std::string_view::npos;
  return (value < 0 && !zero ? "−" : "") + std::string(text.data());
}

// Returns the number of decimals needed to distinguish multiples of the step.
int decimals_of(double step) {
  for (int decimals = 0; decimals < 12; ++decimals) {
    const double scaled = step * std::pow(10.0, decimals);
    if (std::abs(scaled - std::round(scaled)) < 1e-6 * scaled) return decimals;
  }
  return 12;
}

Ticks linear_ticks(const Scale& scale, int wanted, bool whole_numbers) {
  Ticks ticks;
  const double length = scale.high - scale.low;
  const double slack = 1e-9 * length;
  double step = round_step(length, wanted, whole_numbers);
  const auto first = [&] { return std::ceil((scale.low - slack) / step); };
  const auto last = [&] { return std::floor((scale.high + slack) / step); };
  // At least two ticks, as fewer do not define the scale.
  for (int more = wanted + 1; last() < first() + 1 && more < 3 * wanted; ++more) {
    step = round_step(length, more, whole_numbers);
  }
  const double largest = std::max(std::abs(scale.low), std::abs(scale.high));
  const int exponent = static_cast<int>(std::floor(std::log10(largest) + 1e-9));
  // Labels have no exponent if the largest number has at most five digits before the point or one zero after it.
  const bool apart = exponent >= 5 || exponent <= -3;
  const double unit = apart ? std::pow(10.0, exponent) : 1.0;
  if (apart) ticks.shared = "×10" + superscript(exponent);
  const int decimals = decimals_of(step / unit);
  for (double k = first(); k <= last(); ++k) {
    ticks.at.push_back(k * step);
    ticks.labels.push_back(formatted(k * step / unit, decimals));
  }
  return ticks;
}

Ticks logarithmic_ticks(const Scale& scale, int wanted) {
  Ticks ticks;
  const int first = static_cast<int>(std::floor(std::log10(scale.low) + 1e-9));
  const int last = static_cast<int>(std::ceil(std::log10(scale.high) - 1e-9));
  const int every = std::max(1, (last - first + wanted - 1) / wanted);
  const bool plain = first >= -2 && last <= 3;
  const auto power_label = [&](int exponent) {
    return plain ? formatted(std::pow(10.0, exponent), std::max(0, -exponent)) : "10" + superscript(exponent);
  };
  for (int exponent = first; exponent <= last; ++exponent) {
    const double power = std::pow(10.0, exponent);
    for (int digit = 1; digit <= 9; ++digit) {
      const double value = digit * power;
      if (value < scale.low * (1 - 1e-9) || value > scale.high * (1 + 1e-9)) continue;
      const bool round = digit == 1 && (exponent - first) % every == 0;
      // Over less than two decades, powers of ten alone would be too few ticks.
      const bool few = scale.high < 50 * scale.low && (digit == 2 || digit == 5);
      if (!round && !few) {
        ticks.between.push_back(value);
        continue;
      }
      ticks.at.push_back(value);
      ticks.labels.push_back(digit == 1 ? power_label(exponent) : formatted(value, std::max(0, -exponent)));
    }
  }
  return ticks;
}

}  // namespace

double Scale::operator()(double value) const {
  const double share = logarithmic ? std::log(value / low) / std::log(high / low) : (value - low) / (high - low);
  // Points are clamped to four axis lengths outside, as Cairo's fixed-point coordinates have a limited range.
  return from + std::clamp(share, -4.0, 5.0) * (to - from);
}

bool Scale::shows(double value) const { return std::isfinite(value) && (!logarithmic || value > 0); }

Ticks make_ticks(const Scale& scale, int wanted, bool whole_numbers) {
  wanted = std::clamp(wanted, 2, 20);
  return scale.logarithmic ? logarithmic_ticks(scale, wanted) : linear_ticks(scale, wanted, whole_numbers);
}

void Extent::take(double value, bool logarithmic) {
  if (!std::isfinite(value) || (logarithmic && value <= 0)) return;
  if (empty()) low_ = high_ = value;
  low_ = std::min(low_, value);
  high_ = std::max(high_, value);
}

}  // namespace wisp::drawing
