#pragma once
// Counter-based random numbers, without carried state, equal for every standard library. The mixing function is that of
// G. Steele, D. Lea & C. Flood, Fast splittable pseudorandom number generators (2014), with D. Stafford's constants.

#include <cstdint>

namespace wisp::flow {

inline std::uint64_t random_word(std::uint64_t seed, std::uint64_t stream, std::uint64_t count) {
  std::uint64_t x = seed * 0x9e3779b97f4a7c15U + stream * 0xd1342543de82ef95U + count * 0xa0761d6478bd642fU;
  for (int round = 0; round < 2; ++round) {
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9U;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebU;
    x ^= x >> 31;
  }
  return x;
}

/// A stream of numbers read in order.
class RandomNumbers {
 public:
  RandomNumbers(std::uint64_t seed, std::uint64_t stream) : seed_(seed), stream_(stream) {}

  std::uint64_t word() { return random_word(seed_, stream_, count_++); }

  /// Uniform over [0, 1).
  double uniform() { return static_cast<double>(word() >> 11) * 0x1p-53; }
  double uniform(double lowest, double highest) { return lowest + (highest - lowest) * uniform(); }

  /// Approximately normal, mean 0, standard deviation 1: the sum of twelve 16-bit uniform numbers minus 6, which is
  /// bounded by ±6 and has a kurtosis of 2.9. Only integers and one product: no library's logarithm.
  double normal() {
    std::int64_t sum = 0;
    for (int k = 0; k < 3; ++k) {
      const std::uint64_t bits = word();
      sum +=
          static_cast<std::int64_t>((bits & 0xffff) + ((bits >> 16) & 0xffff) + ((bits >> 32) & 0xffff) + (bits >> 48));
    }
    return (static_cast<double>(sum) + 6.0) * 0x1p-16 - 6.0;
  }

 private:
  std::uint64_t seed_;
  std::uint64_t stream_;
  std::uint64_t count_ = 0;
};

}  // namespace wisp::flow
