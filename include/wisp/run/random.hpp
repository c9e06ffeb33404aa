#pragma once
// Counter-based random numbers: each is computed from its key, without carried state.
//
// Source: J. Salmon, M. Moraes, R. Dror & D. Shaw, Parallel random numbers: as easy as 1, 2, 3, SC11: Philox4x32 with 7
// rounds, the fewest that pass every test of their battery.

#include <array>
#include <cstdint>

namespace wisp {

/// Key of a random number. Keys that differ in any field give independent numbers.
struct RandomKey {
  std::uint64_t seed = 1;    ///< seed of the bank
  std::uint64_t stream = 0;  ///< stream number of the instance
  std::uint64_t step = 0;    ///< steps since the instance was spawned or reset; below 2^48
  std::uint32_t group = 0;   ///< index of the group of four words; below 2^16
};

/// Returns four random words.
std::array<std::uint32_t, 4> random_words(const RandomKey& key);

/// Converts a word to two independent standard normal deviates, within 4e-5 of the exact polar form and within ±5.396.
/// docs/reference/model-file.md has the form for a player in another language.
std::array<float, 2> normal_pair(std::uint32_t word);

}  // namespace wisp
