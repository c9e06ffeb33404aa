#pragma once
// Random numbers that are counted, not carried: any of them can be computed alone.
//
// Source: J. Salmon, M. Moraes, R. Dror & D. Shaw, Parallel random numbers: as easy as 1, 2, 3, SC11: Philox4x32 with
// 7 rounds, the fewest that pass every test of their battery.

#include <array>
#include <cstdint>

namespace wisp {

/// What a random number belongs to. Every field that differs gives an independent number.
struct RandomKey {
  std::uint64_t seed = 1;    ///< of the bank
  std::uint64_t stream = 0;  ///< of the instance
  std::uint64_t step = 0;    ///< since the instance was spawned; below 2^48
  std::uint32_t group = 0;   ///< of four words; below 2^16
};

/// Four random words.
std::array<std::uint32_t, 4> random_words(const RandomKey& key);

/// The two independent standard normal deviates that a word stands for, within 4e-5 of the exact polar form and none
/// beyond ±5.396. docs/reference/model-file.md has the form for a player in another language.
std::array<float, 2> normal_pair(std::uint32_t word);

}  // namespace wisp
