#pragma once
// What the kernels are templates over: the kind of number, and how many instances go side by side.
//
// A block is kLanes instances; everything that an instance has is laid out as [what][lane], and a kernel does the same
// operations in the same order in every lane. Lanes are written as the compilers' vectors, since gcc 12 and clang 14
// unroll plain loops over eight lanes first and then make poor vectors of the pieces (measured: three times slower).
// How wide the machine's vectors are changes no bit.

#include <bit>
#include <cfloat>
#include <cstdint>
#include <cstring>

#if defined(__GNUC__) && !defined(WISP_PLAIN_LANES)
#define WISP_VECTOR_LANES 1
#endif
// clang sees by itself that 32-bit numbers multiplied to 64 bits are one instruction; gcc has to be told.
#if defined(WISP_VECTOR_LANES) && defined(__SSE2__) && !defined(__clang__)
#define WISP_WIDE_INTRINSICS 1
#include <immintrin.h>
#endif

#ifdef __FAST_MATH__
#error "wisp's run layer gives the same bits on every machine and can't be compiled with -ffast-math"
#endif
static_assert(FLT_EVAL_METHOD == 0, "float must be computed as float: the frame path gives the same bits everywhere");

namespace wisp {

// A part is what the machine computes at once: a vector, or one number.

#ifdef WISP_VECTOR_LANES
#ifdef __AVX2__
inline constexpr int kPartLanes = 8;
#else
inline constexpr int kPartLanes = 4;
#endif
using RealPart = float __attribute__((vector_size(4 * kPartLanes)));
using WordPart = std::uint32_t __attribute__((vector_size(4 * kPartLanes)));
using SignedPart = std::int32_t __attribute__((vector_size(4 * kPartLanes)));

inline RealPart real_of_part(WordPart word) { return __builtin_convertvector((SignedPart)word, RealPart); }
inline WordPart bits_of_part(RealPart real) { return (WordPart)real; }
inline RealPart real_of_bits_part(WordPart bits) { return (RealPart)bits; }
inline WordPart spread_sign_part(WordPart word) { return (WordPart)((SignedPart)word >> 31); }
inline WordPart differ_part(RealPart a, RealPart b) { return (WordPart)(a != b); }
inline void spread_part(float value, RealPart& part) { part = value - RealPart{}; }  // x − 0 is x: nothing is rounded
inline void spread_part(std::uint32_t value, WordPart& part) { part = value - WordPart{}; }
#else
inline constexpr int kPartLanes = 1;
using RealPart = float;
using WordPart = std::uint32_t;

inline RealPart real_of_part(WordPart word) { return static_cast<float>(static_cast<std::int32_t>(word)); }
inline WordPart bits_of_part(RealPart real) { return std::bit_cast<std::uint32_t>(real); }
inline RealPart real_of_bits_part(WordPart bits) { return std::bit_cast<float>(bits); }
inline WordPart spread_sign_part(WordPart word) { return word >> 31 ? 0xffffffffU : 0U; }
inline WordPart differ_part(RealPart a, RealPart b) { return a != b ? 0xffffffffU : 0U; }
inline void spread_part(float value, RealPart& part) { part = value; }
inline void spread_part(std::uint32_t value, WordPart& part) { part = value; }
#endif

/// High and low words of a product.
template <class Part>
struct WideProduct {
  Part high;
  Part low;
};

#if defined(WISP_WIDE_INTRINSICS) && defined(__AVX2__)
inline WideProduct<WordPart> wide_product_part(WordPart a, std::uint32_t b) {
  const __m256i x = (__m256i)a, factor = _mm256_set1_epi32(static_cast<int>(b));
  const __m256i even = _mm256_mul_epu32(x, factor), odd = _mm256_mul_epu32(_mm256_srli_epi64(x, 32), factor);
  return {(WordPart)_mm256_blend_epi32(_mm256_srli_epi64(even, 32), odd, 0xAA),
          (WordPart)_mm256_blend_epi32(even, _mm256_slli_epi64(odd, 32), 0xAA)};
}
#elif defined(WISP_WIDE_INTRINSICS)
inline WideProduct<WordPart> wide_product_part(WordPart a, std::uint32_t b) {
  const __m128i x = (__m128i)a, factor = _mm_set1_epi32(static_cast<int>(b));
  const __m128i even = _mm_mul_epu32(x, factor), odd = _mm_mul_epu32(_mm_srli_epi64(x, 32), factor);
  const __m128i lows = _mm_shuffle_epi32(even, 0x08), highs = _mm_shuffle_epi32(even, 0x0D);
  return {(WordPart)_mm_unpacklo_epi32(highs, _mm_shuffle_epi32(odd, 0x0D)),
          (WordPart)_mm_unpacklo_epi32(lows, _mm_shuffle_epi32(odd, 0x08))};
}
#elif defined(WISP_VECTOR_LANES)
inline WideProduct<WordPart> wide_product_part(WordPart a, std::uint32_t b) {
  using WidePart = std::uint64_t __attribute__((vector_size(8 * kPartLanes)));
  const WidePart product = __builtin_convertvector(a, WidePart) * b;
  return {__builtin_convertvector(product >> 32, WordPart), __builtin_convertvector(product, WordPart)};
}
#else
inline WideProduct<WordPart> wide_product_part(WordPart a, std::uint32_t b) {
  const std::uint64_t product = static_cast<std::uint64_t>(a) * b;
  return {static_cast<std::uint32_t>(product >> 32), static_cast<std::uint32_t>(product)};
}
#endif

inline float square_root(float a) { return __builtin_sqrtf(a); }
inline float value_of(float a) { return a; }
inline std::uint32_t value_of(std::uint32_t a) { return a; }

/// The numbers of a live bank.
struct LiveNumbers {
  using Real = float;
  using Word = std::uint32_t;
  using RealPart = wisp::RealPart;
  using WordPart = wisp::WordPart;
  static constexpr int kLanes = 8;
  static constexpr int kParts = kLanes / kPartLanes;
};

/// Values side by side, one a lane. Arithmetic is lane by lane.
template <class Part, int kParts>
struct Pack {
  Part part[kParts];
};
template <class N>
using Reals = Pack<typename N::RealPart, N::kParts>;
template <class N>
using Words = Pack<typename N::WordPart, N::kParts>;

/// Applies a function to each part of packs that go together.
template <class Function, class Part, int kParts, class... More>
inline auto each(Function function, const Pack<Part, kParts>& first, const More&... more) {
  Pack<decltype(function(first.part[0], more.part[0]...)), kParts> out;
  for (int i = 0; i < kParts; ++i) out.part[i] = function(first.part[i], more.part[i]...);
  return out;
}

template <class Part, int kParts>
inline auto operator+(const Pack<Part, kParts>& a, const Pack<Part, kParts>& b) {
  return each([](const Part& x, const Part& y) { return x + y; }, a, b);
}
template <class Part, int kParts>
inline auto operator-(const Pack<Part, kParts>& a, const Pack<Part, kParts>& b) {
  return each([](const Part& x, const Part& y) { return x - y; }, a, b);
}
template <class Part, int kParts>
inline auto operator*(const Pack<Part, kParts>& a, const Pack<Part, kParts>& b) {
  return each([](const Part& x, const Part& y) { return x * y; }, a, b);
}
template <class Part, int kParts>
inline auto operator^(const Pack<Part, kParts>& a, const Pack<Part, kParts>& b) {
  return each([](const Part& x, const Part& y) { return x ^ y; }, a, b);
}
template <class Part, int kParts>
inline auto operator&(const Pack<Part, kParts>& a, const Pack<Part, kParts>& b) {
  return each([](const Part& x, const Part& y) { return x & y; }, a, b);
}
template <class Part, int kParts>
inline auto operator|(const Pack<Part, kParts>& a, const Pack<Part, kParts>& b) {
  return each([](const Part& x, const Part& y) { return x | y; }, a, b);
}
template <class Part, int kParts>
inline auto operator>>(const Pack<Part, kParts>& a, int bits) {
  return each([bits](const Part& x) { return x >> bits; }, a);
}

/// The same value in every lane.
template <class Packed, class Value>
inline Packed all(Value value) {
  Packed out;
  for (auto& part : out.part) spread_part(value, part);
  return out;
}

/// To and from memory: one value a lane, in order, of the same size.
template <class Packed, class Value>
inline Packed load(const Value* values) {
  Packed out;
  std::memcpy(static_cast<void*>(&out), static_cast<const void*>(values), sizeof(Packed));
  return out;
}
template <class Packed, class Value>
inline void store(const Packed& packed, Value* values) {
  std::memcpy(static_cast<void*>(values), static_cast<const void*>(&packed), sizeof(Packed));
}

template <class Part, int kParts>
inline auto bits_of(const Pack<Part, kParts>& reals) {
  return each([](const Part& x) { return bits_of_part(x); }, reals);
}
template <class Part, int kParts>
inline auto real_of_bits(const Pack<Part, kParts>& bits) {
  return each([](const Part& x) { return real_of_bits_part(x); }, bits);
}

/// Words as numbers, rounded to nearest. Precondition: words < 2^31 (signed conversion is an instruction of every
/// machine, unsigned is not).
template <class Part, int kParts>
inline auto real_of(const Pack<Part, kParts>& words) {
  return each([](const Part& x) { return real_of_part(x); }, words);
}

/// All ones where the highest bit is set, zeros elsewhere.
template <class Part, int kParts>
inline auto spread_sign(const Pack<Part, kParts>& words) {
  return each([](const Part& x) { return spread_sign_part(x); }, words);
}

/// All ones where two numbers differ, zeros elsewhere.
template <class Part, int kParts>
inline auto differ(const Pack<Part, kParts>& a, const Pack<Part, kParts>& b) {
  return each([](const Part& x, const Part& y) { return differ_part(x, y); }, a, b);
}

/// The larger and the smaller of two numbers; the second where the first is not a number.
template <class Part, int kParts>
inline auto larger(const Pack<Part, kParts>& a, const Pack<Part, kParts>& b) {
  return each([](const Part& x, const Part& y) { return x > y ? x : y; }, a, b);
}
template <class Part, int kParts>
inline auto smaller(const Pack<Part, kParts>& a, const Pack<Part, kParts>& b) {
  return each([](const Part& x, const Part& y) { return x < y ? x : y; }, a, b);
}

/// Held to [low, high].
template <class Part, int kParts>
inline auto hold(const Pack<Part, kParts>& value, const Pack<Part, kParts>& low, const Pack<Part, kParts>& high) {
  return smaller(larger(value, low), high);
}

/// The value where it is a number, else the other.
template <class Part, int kParts>
inline auto number_or(const Pack<Part, kParts>& value, const Pack<Part, kParts>& other) {
  return each([](const Part& x, const Part& y) { return x == x ? x : y; }, value, other);
}

/// State nearer to zero than this is zero, so that an engine that flushes denormals sees the same numbers. States are
/// in units of a power of two near the channel's range; coefficients below kLeastCoefficient are zero too. Products are
/// then multiples of 2^−123 and their sums can't be denormal.
inline constexpr float kLeastState = 1e-20f;
inline constexpr float kLeastCoefficient = 1e-10f;

template <class Part, int kParts>
inline auto settle(const Pack<Part, kParts>& value) {
  return each(
      [](const Part& v) {
        Part zero, least, most;
        spread_part(0.0f, zero);
        spread_part(kLeastState, least);
        spread_part(-kLeastState, most);
        return v < least ? (v > most ? zero : v) : v;
      },
      value);
}

}  // namespace wisp
