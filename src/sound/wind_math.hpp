#pragma once
// Functions of the wind estimator beyond + − × ÷ √, made of these operations only, so that results are the same bits
// with every compiler and C library.

#include <bit>
#include <cstdint>

namespace wisp::wind {

// The kernel is a template over its number type: float in the product, a counting type where its cost is measured.
// Only plain() accesses a number's value; a counting type overloads it.
inline float plain(float x) { return x; }

/// Decomposition of a number x as mantissa · 2^exponent with mantissa in [1/√2, √2). For finite x >= 2^-126.
struct Split {
  float mantissa;
  int exponent;
};

inline Split split(float x) {
  const std::uint32_t bits = std::bit_cast<std::uint32_t>(x);
  const std::uint32_t above = bits - 0x3f3504f3U;  // the bits of 1/√2
  const std::uint32_t exponent = above & 0xff800000U;
  return {std::bit_cast<float>(bits - exponent), static_cast<std::int32_t>(exponent) >> 23};
}

/// 2^n for n in −126 … 127.
inline float power_of_two(int n) { return std::bit_cast<float>(static_cast<std::uint32_t>(n + 127) << 23); }

/// Base-2 logarithm, from the series of artanh((m−1)/(m+1)) truncated after its fourth term (remainder below 4.3e-8);
/// absolute error below 2e-7 for |log2 x| < 1, else one more rounding. For finite x >= 2^-126.
template <class T>
T log2_of(T x) {
  const Split parts = split(plain(x));
  const T m = T(parts.mantissa);
  const T s = (m - T(1.0F)) / (m + T(1.0F));
  const T s2 = s * s;
  const T series = T(2.8853900818F) + s2 * (T(0.9617966939F) + s2 * (T(0.5770780164F) + s2 * T(0.4121985831F)));
  return T(static_cast<float>(parts.exponent)) + s * series;
}

/// 2 to the power x, from the power series of 2^f, |f| <= 1/2, truncated after f^6 (relative remainder below 1.7e-7);
/// relative error below 4e-7. x is clamped to −125 … 125.
template <class T>
T exp2_of(T x) {
  if (x < T(-125.0F)) x = T(-125.0F);
  if (x > T(125.0F)) x = T(125.0F);
  const float given = plain(x);
  const int whole = static_cast<int>(given < 0 ? given - 0.5F : given + 0.5F);
  const T f = x - T(static_cast<float>(whole));
  const T low = T(1.0F) + f * (T(0.6931471806F) + f * (T(0.2402265070F) + f * T(0.0555041087F)));
  const T f2 = f * f;
  const T high = f2 * f2 * (T(0.0096181291F) + f * (T(0.0013333558F) + f * T(0.0001540353F)));
  return (low + high) * T(power_of_two(whole));
}

/// Decibels of a power ratio; powers below 1e-12 count as 1e-12 (−120 dB).
template <class T>
T decibels(T power) {
  if (power < T(1e-12F)) power = T(1e-12F);
  return T(3.0102999566F) * log2_of(power);
}

/// Power ratio of a number of decibels.
template <class T>
T from_decibels(T db) {
  return exp2_of(db * T(0.3321928095F));
}

/// Logistic function 1 / (1 + e^−x).
template <class T>
T sigmoid(T x) {
  return T(1.0F) / (T(1.0F) + exp2_of(x * T(-1.4426950409F)));
}

}  // namespace wisp::wind
