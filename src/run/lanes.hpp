#pragma once
// What the kernels are templates over: the kind of number, and how many instances go side by side.
//
// Kernels are plain loops over lanes, one lane per instance, with the same operations in the same order in each, so
// that a compiler may make vectors of them and the bits stay. A block is kLanes instances; everything that an instance
// has is laid out as [what][lane].

#include <bit>
#include <cfloat>
#include <cstdint>

#ifdef __FAST_MATH__
#error "wisp's run layer gives the same bits on every machine and can't be compiled with -ffast-math"
#endif
static_assert(FLT_EVAL_METHOD == 0, "float must be computed as float: the frame path gives the same bits everywhere");

namespace wisp {

/// The numbers of a live bank.
struct LiveNumbers {
  using Real = float;
  using Word = std::uint32_t;
  static constexpr int kLanes = 8;
};

inline std::uint32_t bits_of(float value) { return std::bit_cast<std::uint32_t>(value); }
inline float real_of_bits(std::uint32_t bits) { return std::bit_cast<float>(bits); }

/// The word as a number, rounded to nearest. Precondition: word < 2^31 (signed conversion is an instruction of every
/// machine, unsigned is not).
inline float real_of(std::uint32_t word) { return static_cast<float>(static_cast<std::int32_t>(word)); }

/// All ones where the highest bit is set, zeros elsewhere.
inline std::uint32_t spread_sign(std::uint32_t word) { return word >> 31 ? 0xffffffffU : 0U; }

/// The product's high and low word.
struct WideProduct {
  std::uint32_t high;
  std::uint32_t low;
};
inline WideProduct wide_product(std::uint32_t a, std::uint32_t b) {
  const std::uint64_t product = static_cast<std::uint64_t>(a) * b;
  return {static_cast<std::uint32_t>(product >> 32), static_cast<std::uint32_t>(product)};
}

inline std::uint32_t plain(std::uint32_t word) { return word; }

/// Held to [low, high]; what is not a number becomes `low`.
template <class Real>
inline Real hold(Real value, Real low, Real high) {
  const Real raised = value > low ? value : low;
  return raised < high ? raised : high;
}

/// State nearer to zero than this is zero, so that an engine that flushes denormals sees the same numbers. States are
/// in units of a power of two near the channel's range; coefficients below kLeastCoefficient are zero too. Products are
/// then multiples of 2^−123 and their sums can't be denormal.
inline constexpr float kLeastState = 1e-20f;
inline constexpr float kLeastCoefficient = 1e-10f;

template <class Real>
inline Real settle(Real value) {
  return value < Real(kLeastState) && value > Real(-kLeastState) ? Real(0) : value;
}

}  // namespace wisp
