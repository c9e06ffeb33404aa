#pragma once
// Random numbers that are counted, not carried: any of them can be computed alone.
//
// Source: J. Salmon, M. Moraes, R. Dror & D. Shaw, Parallel random numbers: as easy as 1, 2, 3, SC11: Philox4x32 with
// 7 rounds, the fewest that pass every test of their battery.

#include <array>
#include <cstdint>
#include <span>

namespace wisp {

/// What a random number belongs to. Every field that differs gives an independent number.
struct RandomKey {
  std::uint64_t seed = 1;    ///< of the bank
  std::uint64_t stream = 0;  ///< of the instance
  std::uint64_t step = 0;    ///< since the instance was spawned; below 2^48
  std::uint32_t group = 0;   ///< four channels make a group; below 2^16
};

/// Four random words.
std::array<std::uint32_t, 4> random_words(const RandomKey& key);

/// The standard normal deviate that a word stands for: the inverse of the normal distribution at (word + ½)/2³², within
/// 1.5e-6. Rises with the word, from −6.338 to 6.338; symmetric.
float normal(std::uint32_t word);

/// The quadratics that normal() is made of, c0 + t (c1 + t c2), for a player in another language:
/// docs/reference/model-file.md says how.
std::span<const std::array<float, 3>> normal_table();

}  // namespace wisp
