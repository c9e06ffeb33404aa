#pragma once
// Transposes rows of tables, one row per lane, to columns of one number per lane, and back.

#include <cstddef>
#include <cstdint>
#include <cstring>

#include "run/lanes/lanes.hpp"

namespace wisp {

// Four numbers of a row, read at once as a vector of 16 bytes.
#ifdef WISP_VECTOR_LANES
using Quad = float __attribute__((vector_size(16)));

inline Quad quad_at(const float* row) {
  Quad quad;
  std::memcpy(&quad, row, sizeof quad);
  return quad;
}

/// Reads four successive numbers of every lane's row, as columns.
inline void columns_part(const float* const* row, std::size_t first, RealPart (&column)[4]) {
  const auto row_of = [&](int lane) { return quad_at(row[lane] + first); };
#ifdef __AVX2__
  const auto rows = [&](int lane) {
    return __builtin_shufflevector(row_of(lane), row_of(lane + 4), 0, 1, 2, 3, 4, 5, 6, 7);
  };
  const auto r0 = rows(0), r1 = rows(1), r2 = rows(2), r3 = rows(3);
  const auto ab01 = __builtin_shufflevector(r0, r1, 0, 8, 1, 9, 4, 12, 5, 13);
  const auto ab23 = __builtin_shufflevector(r2, r3, 0, 8, 1, 9, 4, 12, 5, 13);
  const auto cd01 = __builtin_shufflevector(r0, r1, 2, 10, 3, 11, 6, 14, 7, 15);
  const auto cd23 = __builtin_shufflevector(r2, r3, 2, 10, 3, 11, 6, 14, 7, 15);
  column[0] = __builtin_shufflevector(ab01, ab23, 0, 1, 8, 9, 4, 5, 12, 13);
  column[1] = __builtin_shufflevector(ab01, ab23, 2, 3, 10, 11, 6, 7, 14, 15);
  column[2] = __builtin_shufflevector(cd01, cd23, 0, 1, 8, 9, 4, 5, 12, 13);
  column[3] = __builtin_shufflevector(cd01, cd23, 2, 3, 10, 11, 6, 7, 14, 15);
#else
  const Quad r0 = row_of(0), r1 = row_of(1), r2 = row_of(2), r3 = row_of(3);
  const Quad ab01 = __builtin_shufflevector(r0, r1, 0, 4, 1, 5), ab23 = __builtin_shufflevector(r2, r3, 0, 4, 1, 5);
  const Quad cd01 = __builtin_shufflevector(r0, r1, 2, 6, 3, 7), cd23 = __builtin_shufflevector(r2, r3, 2, 6, 3, 7);
  column[0] = __builtin_shufflevector(ab01, ab23, 0, 1, 4, 5);
  column[1] = __builtin_shufflevector(ab01, ab23, 2, 3, 6, 7);
  column[2] = __builtin_shufflevector(cd01, cd23, 0, 1, 4, 5);
  column[3] = __builtin_shufflevector(cd01, cd23, 2, 3, 6, 7);
#endif
}

// Writes four columns to every lane's row.
inline void rows_part(const RealPart (&column)[4], std::size_t first, float* const* row) {
  const auto put = [&](int lane, const Quad& quad) { std::memcpy(row[lane] + first, &quad, sizeof quad); };
#ifdef __AVX2__
  const auto ab01 = __builtin_shufflevector(column[0], column[1], 0, 8, 1, 9, 4, 12, 5, 13);
  const auto ab23 = __builtin_shufflevector(column[0], column[1], 2, 10, 3, 11, 6, 14, 7, 15);
  const auto cd01 = __builtin_shufflevector(column[2], column[3], 0, 8, 1, 9, 4, 12, 5, 13);
  const auto cd23 = __builtin_shufflevector(column[2], column[3], 2, 10, 3, 11, 6, 14, 7, 15);
  const auto put_two = [&](int lane, const RealPart& two) {
    put(lane, __builtin_shufflevector(two, two, 0, 1, 2, 3));
    put(lane + 4, __builtin_shufflevector(two, two, 4, 5, 6, 7));
  };
  put_two(0, __builtin_shufflevector(ab01, cd01, 0, 1, 8, 9, 4, 5, 12, 13));
  put_two(1, __builtin_shufflevector(ab01, cd01, 2, 3, 10, 11, 6, 7, 14, 15));
  put_two(2, __builtin_shufflevector(ab23, cd23, 0, 1, 8, 9, 4, 5, 12, 13));
  put_two(3, __builtin_shufflevector(ab23, cd23, 2, 3, 10, 11, 6, 7, 14, 15));
#else
  const Quad ab01 = __builtin_shufflevector(column[0], column[1], 0, 4, 1, 5);
  const Quad ab23 = __builtin_shufflevector(column[0], column[1], 2, 6, 3, 7);
  const Quad cd01 = __builtin_shufflevector(column[2], column[3], 0, 4, 1, 5);
  const Quad cd23 = __builtin_shufflevector(column[2], column[3], 2, 6, 3, 7);
  put(0, __builtin_shufflevector(ab01, cd01, 0, 1, 4, 5));
  put(1, __builtin_shufflevector(ab01, cd01, 2, 3, 6, 7));
  put(2, __builtin_shufflevector(ab23, cd23, 0, 1, 4, 5));
  put(3, __builtin_shufflevector(ab23, cd23, 2, 3, 6, 7));
#endif
}
#else
inline void columns_part(const float* const* row, std::size_t first, RealPart (&column)[4]) {
  for (std::size_t k = 0; k < 4; ++k) column[k] = row[0][first + k];
}
inline void rows_part(const RealPart (&column)[4], std::size_t first, float* const* row) {
  for (std::size_t k = 0; k < 4; ++k) row[0][first + k] = column[k];
}
#endif

/// Reads four successive numbers, from `first` on, of every lane's row.
template <class N, class Number>
inline void columns_of(const Number* const (&row)[N::kLanes], std::size_t first, Reals<N> (&columns)[4]) {
  unrolled<N::kParts>([&](auto i) {
    typename N::RealPart part[4];
    columns_part(row + i * N::kPartLanes, first, part);
    unrolled<4>([&](auto k) { columns[k].part[i] = part[k]; });
  });
}

/// Writes four columns to every lane's row.
template <class N>
inline void rows_of(const Reals<N> (&columns)[4], std::size_t first, typename N::Real* const (&row)[N::kLanes]) {
  unrolled<N::kParts>([&](auto i) {
    typename N::RealPart part[4];
    unrolled<4>([&](auto k) { part[k] = columns[k].part[i]; });
    rows_part(part, first, row + i * N::kPartLanes);
  });
}

#ifdef WISP_VECTOR_LANES
using Eight = std::int16_t __attribute__((vector_size(16)));

inline void real_parts(const Eight& words, RealPart* parts) {
#ifdef __AVX2__
  parts[0] = (RealPart)_mm256_cvtepi32_ps(_mm256_cvtepi16_epi32((__m128i)words));
#else
  const auto real = [](const Eight& twice) { return __builtin_convertvector((SignedPart)twice >> 16, RealPart); };
  parts[0] = real(__builtin_shufflevector(words, words, 0, 0, 1, 1, 2, 2, 3, 3));
  parts[1] = real(__builtin_shufflevector(words, words, 4, 4, 5, 5, 6, 6, 7, 7));
#endif
}
#endif

/// Reads eight successive 16-bit integers of every lane's row, as real numbers in columns.
template <class N>
inline void columns_of(const std::int16_t* const (&row)[N::kLanes], Reals<N> (&columns)[8]) {
#ifdef WISP_VECTOR_LANES
  // Each round interleaves rows that are half of the lanes apart. After log2(lanes) rounds the vectors hold columns
  // instead of rows; with four lanes, two columns each.
  if constexpr (N::kPartLanes > 1) {
    constexpr int kRows = N::kLanes, kHalf = kRows / 2;
    static_assert(kRows == 8 || kRows == 4);
    Eight words[kRows], mixed[kRows];
    unrolled<kRows>([&](auto lane) { std::memcpy(&words[lane], row[lane], sizeof words[lane]); });
    unrolled<kRows == 8 ? 3 : 2>([&](auto) {
      unrolled<kHalf>([&](auto k) {
        mixed[2 * k] = __builtin_shufflevector(words[k], words[k + kHalf], 0, 8, 1, 9, 2, 10, 3, 11);
        mixed[2 * k + 1] = __builtin_shufflevector(words[k], words[k + kHalf], 4, 12, 5, 13, 6, 14, 7, 15);
      });
      unrolled<kRows>([&](auto k) { words[k] = mixed[k]; });
    });
    if constexpr (kRows == 8) {
      unrolled<8>([&](auto k) { real_parts(words[k], columns[k].part); });
    } else {
      unrolled<4>([&](auto k) {
        typename N::RealPart both[2];
        real_parts(words[k], both);
        columns[2 * k].part[0] = both[0];
        columns[2 * k + 1].part[0] = both[1];
      });
    }
  }
#endif
  if constexpr (N::kPartLanes == 1) {
    for (int lane = 0; lane < N::kLanes; ++lane) {
      for (int k = 0; k < 8; ++k) columns[k].part[lane] = typename N::Real(static_cast<float>(row[lane][k]));
    }
  }
}

}  // namespace wisp
