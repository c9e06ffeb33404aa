#pragma once
// Number types of kernels, and the number of instances that a kernel processes in parallel. A block is kLanes
// instances. All its data is laid out as [variable][lane], and a kernel does the same operations in the same order in
// every lane. Lanes are elements of the compilers' vector types, since gcc 12 and clang 14 unroll plain loops over
// eight lanes first and then vectorise the pieces poorly (measured: three times slower). The width of the machine's
// vectors changes no bit of a result.

#include <bit>
#include <cfloat>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <type_traits>
#include <utility>

#if defined(__GNUC__) && !defined(WISP_PLAIN_LANES)
#define WISP_VECTOR_LANES 1
#endif
#if defined(WISP_VECTOR_LANES) && defined(__SSE2__)
#define WISP_LONG_WORDS 1
#include <immintrin.h>
#endif

#ifdef __FAST_MATH__
#error "wisp's run layer gives the same bits on every machine and can't be compiled with -ffast-math"
#endif
static_assert(FLT_EVAL_METHOD == 0, "float must be computed as float: the frame path gives the same bits everywhere");

namespace wisp {

#ifdef WISP_LONG_WORDS
inline constexpr int kVectorRegisters = 16;
#else
inline constexpr int kVectorRegisters = 32;
#endif

// A "part" is the operand of one machine instruction: a vector, or one number where there are no vectors.

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
template <int bits>
inline WordPart signed_shift_part(WordPart word) {
  return (WordPart)((SignedPart)word >> bits);
}
inline WordPart whole_part(RealPart real) { return (WordPart) __builtin_convertvector(real, SignedPart); }
inline RealPart next_part(RealPart real) { return real + 1.0f; }
inline WordPart differ_part(RealPart a, RealPart b) { return (WordPart)(a != b); }
inline RealPart magnitude_part(RealPart a) { return (RealPart)((WordPart)a & 0x7fffffffU); }
inline RealPart square_root_part(RealPart a) {
#if defined(__AVX2__)
  return (RealPart)_mm256_sqrt_ps((__m256)a);
#elif defined(WISP_LONG_WORDS)
  return (RealPart)_mm_sqrt_ps((__m128)a);
#else
  for (int k = 0; k < kPartLanes; ++k) a[k] = std::sqrt(a[k]);
  return a;
#endif
}
inline void spread_part(float value, RealPart& part) { part = value - RealPart{}; }  // x − 0 is x, without rounding
inline void spread_part(std::uint32_t value, WordPart& part) { part = value - WordPart{}; }
inline void first_part(float value, RealPart& part) { part = RealPart{value}; }  // 0 in the other lanes
#else
inline constexpr int kPartLanes = 1;
using RealPart = float;
using WordPart = std::uint32_t;

inline RealPart real_of_part(WordPart word) { return static_cast<float>(static_cast<std::int32_t>(word)); }
inline WordPart bits_of_part(RealPart real) { return std::bit_cast<std::uint32_t>(real); }
inline RealPart real_of_bits_part(WordPart bits) { return std::bit_cast<float>(bits); }
template <int bits>
inline WordPart signed_shift_part(WordPart word) {
  return static_cast<std::uint32_t>(static_cast<std::int32_t>(word) >> bits);
}
inline WordPart whole_part(RealPart real) { return static_cast<std::uint32_t>(static_cast<std::int32_t>(real)); }
inline RealPart next_part(RealPart real) { return real + 1.0f; }
inline WordPart differ_part(RealPart a, RealPart b) { return a != b ? 0xffffffffU : 0U; }
inline RealPart magnitude_part(RealPart a) { return std::fabs(a); }
inline RealPart square_root_part(RealPart a) { return std::sqrt(a); }
inline void spread_part(float value, RealPart& part) { part = value; }
inline void spread_part(std::uint32_t value, WordPart& part) { part = value; }
inline void first_part(float value, RealPart& part) { part = value; }
#endif

/// The high and low words of a product of two words.
template <class Part>
struct WideProduct {
  Part high;
  Part low;
};

#ifdef WISP_VECTOR_LANES
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

inline float square_root(float a) { return std::sqrt(a); }
inline float value_of(float a) { return a; }
inline std::uint32_t value_of(std::uint32_t a) { return a; }

#ifdef WISP_LONG_WORDS
// The words of a part, each in the lower half of 64 bits, as x86 multiplies words. The upper halves are ignored, so
// successive products need no shuffles in between.
using LongPart = std::uint64_t __attribute__((vector_size(4 * kPartLanes)));
struct LongWords {
  LongPart even, odd;
};

inline LongWords high_half(LongWords a) { return {a.even >> 32, a.odd >> 32}; }
inline LongWords long_words(WordPart words) { return {(LongPart)words, (LongPart)words >> 32}; }
inline LongWords differing(LongWords a, LongWords b, std::uint32_t key) {
  const auto keys = (LongPart)(WordPart{} + key);
  return {a.even ^ b.even ^ keys, a.odd ^ b.odd ^ keys};
}
#ifdef __AVX2__
inline WordPart words_of(LongWords a) {
  return (WordPart)_mm256_blend_epi32((__m256i)a.even, (__m256i)(a.odd << 32), 0xAA);
}
inline LongWords product(LongWords a, std::uint32_t b) {
  const __m256i factor = _mm256_set1_epi64x(b);
  return {(LongPart)_mm256_mul_epu32((__m256i)a.even, factor), (LongPart)_mm256_mul_epu32((__m256i)a.odd, factor)};
}
#else
inline WordPart words_of(LongWords a) {
  return (WordPart)_mm_unpacklo_epi32(_mm_shuffle_epi32((__m128i)a.even, 0x08),
                                      _mm_shuffle_epi32((__m128i)a.odd, 0x08));
}
inline LongWords product(LongWords a, std::uint32_t b) {
  const __m128i factor = _mm_set1_epi64x(b);
  return {(LongPart)_mm_mul_epu32((__m128i)a.even, factor), (LongPart)_mm_mul_epu32((__m128i)a.odd, factor)};
}
#endif
#endif

struct LiveNumbers {
  using Real = float;
  using Word = std::uint32_t;
  using RealPart = wisp::RealPart;
  using WordPart = wisp::WordPart;
  static constexpr int kLanes = 8;
  static constexpr int kPartLanes = wisp::kPartLanes;
  static constexpr int kParts = kLanes / kPartLanes;
};

template <class N>
struct OnePart : N {
  static constexpr int kLanes = N::kPartLanes;
  static constexpr int kParts = 1;
};

/// The number types of N with as many lanes as one machine vector. On machines without vectors N itself, with the lanes
/// of a block: functions on N are compiled anyway, so no further code is generated.
template <class N>
using PartNumbers = std::conditional_t<(N::kPartLanes > 1), OnePart<N>, N>;

// GCC does not inline long unrolled bodies by itself, and then passes their values through memory.
#if defined(__GNUC__) && !defined(__wasm__)
#define WISP_UNROLLED __attribute__((always_inline))
#else
#define WISP_UNROLLED
#endif

/// Calls function(0), …, function(count − 1) with constants, so that an array indexed by the loop stays in registers.
template <int count, class Function>
WISP_UNROLLED inline void unrolled(Function function) {
#ifdef __wasm__
  for (int k = 0; k < count; ++k) function(k);  // a web page must download the code: prefer small to fast
#else
  [&]<int... k>(std::integer_sequence<int, k...>) WISP_UNROLLED { (function(std::integral_constant<int, k>()), ...); }
  (std::make_integer_sequence<int, count>());
#endif
}

/// Values side by side, one per lane. Arithmetic is lane by lane.
template <class Part, int kParts>
struct Pack {
  Part part[kParts];
};
template <class N>
using Reals = Pack<typename N::RealPart, N::kParts>;
template <class N>
using Words = Pack<typename N::WordPart, N::kParts>;

/// Applies a function to corresponding parts of packs.
template <class Function, class Part, int kParts, class... More>
inline auto each(Function function, const Pack<Part, kParts>& first, const More&... more) {
  Pack<decltype(function(first.part[0], more.part[0]...)), kParts> out;
  unrolled<kParts>([&](auto i) { out.part[i] = function(first.part[i], more.part[i]...); });
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
inline auto operator/(const Pack<Part, kParts>& a, const Pack<Part, kParts>& b) {
  return each([](const Part& x, const Part& y) { return x / y; }, a, b);
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
inline auto operator<<(const Pack<Part, kParts>& a, int bits) {
  return each([bits](const Part& x) { return x << bits; }, a);
}

template <class Packed, class Value>
inline Packed all(Value value) {
  Packed out;
  for (auto& part : out.part) spread_part(value, part);
  return out;
}

/// Load and store: one value per lane, in order.
template <class Packed, class Value>
inline Packed load(const Value* values) {
  Packed out;
  constexpr int kParts = sizeof out.part / sizeof out.part[0], kStep = sizeof out.part[0] / sizeof(Value);
  unrolled<kParts>([&](auto i) {
    std::memcpy(static_cast<void*>(&out.part[i]), static_cast<const void*>(values + i * kStep), sizeof out.part[i]);
  });
  return out;
}
template <class Packed, class Value>
inline void store(const Packed& packed, Value* values) {
  constexpr int kParts = sizeof packed.part / sizeof packed.part[0], kStep = sizeof packed.part[0] / sizeof(Value);
  unrolled<kParts>([&](auto i) {
    std::memcpy(static_cast<void*>(values + i * kStep), static_cast<const void*>(&packed.part[i]),
                sizeof packed.part[i]);
  });
}

/// Keeps a loaded value in a register, where the compiler would otherwise reload it for every use.
template <class Part>
inline void hold_in_register([[maybe_unused]] Part& part) {
#if defined(WISP_LONG_WORDS) && !defined(__wasm__)
  if constexpr (sizeof(Part) >= 16) asm("" : "+x"(part));
#endif
}

template <class Part, int kParts>
inline auto bits_of(const Pack<Part, kParts>& reals) {
  return each([](const Part& x) { return bits_of_part(x); }, reals);
}
template <class Part, int kParts>
inline auto real_of_bits(const Pack<Part, kParts>& bits) {
  return each([](const Part& x) { return real_of_bits_part(x); }, bits);
}

/// Converts words, as signed integers, to numbers, rounded to nearest.
template <class Part, int kParts>
inline auto real_of(const Pack<Part, kParts>& words) {
  return each([](const Part& x) { return real_of_part(x); }, words);
}

/// Converts whole numbers in [0, 2³¹) to words.
template <class Part, int kParts>
inline auto whole(const Pack<Part, kParts>& reals) {
  return each([](const Part& x) { return whole_part(x); }, reals);
}

/// Adds 1 to row numbers of a table. As part of indexing, this does not count as arithmetic (counting.hpp).
template <class Part, int kParts>
inline auto next_of(const Pack<Part, kParts>& reals) {
  return each([](const Part& x) { return next_part(x); }, reals);
}

template <int bits, class Part, int kParts>
inline auto signed_shift(const Pack<Part, kParts>& words) {
  return each([](const Part& x) { return signed_shift_part<bits>(x); }, words);
}

/// Returns all ones where two numbers differ, zeros elsewhere.
template <class Part, int kParts>
inline auto differ(const Pack<Part, kParts>& a, const Pack<Part, kParts>& b) {
  return each([](const Part& x, const Part& y) { return differ_part(x, y); }, a, b);
}

template <class Part, int kParts>
inline auto magnitude(const Pack<Part, kParts>& reals) {
  return each([](const Part& x) { return magnitude_part(x); }, reals);
}

/// Returns whether any bit of any lane of a part is set.
template <class Part>
inline bool any_part(const Part& set) {
  std::uint32_t lanes[sizeof set / sizeof(std::uint32_t)], any = 0;
  std::memcpy(lanes, static_cast<const void*>(&set), sizeof set);
  for (const std::uint32_t lane : lanes) any |= lane;
  return any != 0;
}
#if defined(__AVX2__)
inline bool any_part(const WordPart& set) { return _mm256_testz_si256((__m256i)set, (__m256i)set) == 0; }
#elif defined(WISP_LONG_WORDS)
inline bool any_part(const WordPart& set) {
  return _mm_movemask_epi8(_mm_cmpeq_epi32((__m128i)set, _mm_setzero_si128())) != 0xffff;
}
#endif

/// Returns whether any bit of any lane is set.
template <class Part, int kParts>
inline bool any(const Pack<Part, kParts>& words) {
  Part set = words.part[0];
  for (int i = 1; i < kParts; ++i) set = set | words.part[i];
  return any_part(set);
}

template <class Part, int kParts>
inline auto square_root(const Pack<Part, kParts>& reals) {
  return each([](const Part& x) { return square_root_part(x); }, reals);
}

/// Selects the first value where the mask is above 0, else the second.
template <class Part, int kParts>
inline auto chosen(const Pack<Part, kParts>& mask, const Pack<Part, kParts>& yes, const Pack<Part, kParts>& no) {
  return each([](const Part& m, const Part& zero, const Part& x, const Part& y) { return m > zero ? x : y; }, mask,
              all<Pack<Part, kParts>>(0.0f), yes, no);
}

/// Return the larger and the smaller of two numbers; the second if either is NaN.
template <class Part, int kParts>
inline auto larger(const Pack<Part, kParts>& a, const Pack<Part, kParts>& b) {
  return each([](const Part& x, const Part& y) { return x > y ? x : y; }, a, b);
}
template <class Part, int kParts>
inline auto smaller(const Pack<Part, kParts>& a, const Pack<Part, kParts>& b) {
  return each([](const Part& x, const Part& y) { return x < y ? x : y; }, a, b);
}

/// Clamps to [low, high]; NaN becomes `low`.
template <class Part, int kParts>
inline auto hold(const Pack<Part, kParts>& value, const Pack<Part, kParts>& low, const Pack<Part, kParts>& high) {
  return smaller(larger(value, low), high);
}

/// Returns the value, or `other` where it is NaN.
template <class Part, int kParts>
inline auto number_or(const Pack<Part, kParts>& value, const Pack<Part, kParts>& other) {
  return each([](const Part& x, const Part& y) { return x == x ? x : y; }, value, other);
}

/// State below kMinState in magnitude is set to zero, and so are coefficients below kMinCoefficient. Their rounded
/// products are multiples of 2^−123, so no sum is denormal, and an engine that flushes denormals gets the same numbers.
inline constexpr float kMinState = 1e-20f;
inline constexpr float kMinCoefficient = 1e-10f;

template <class Part, int kParts>
inline auto settle(const Pack<Part, kParts>& value) {
  return each(
      [](const Part& v) {
        Part zero, least;
        spread_part(0.0f, zero);
        spread_part(kMinState, least);
        return magnitude_part(v) < least ? zero : v;
      },
      value);
}

}  // namespace wisp
