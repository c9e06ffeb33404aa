#pragma once
// Pseudo-random numbers that are a pure function of a seed and an index.

#include <cstdint>

namespace wisp::drawing {

/// A number in [0, 1) for a seed and an index (the finaliser of SplitMix64; G. Steele, D. Lea, C. Flood 2014).
inline float random_at(std::uint64_t seed, std::uint64_t index) {
  std::uint64_t z = seed + 0x9E3779B97F4A7C15U * (index + 1);
  z = (z ^ z >> 30) * 0xBF58476D1CE4E5B9U;
  z = (z ^ z >> 27) * 0x94D049BB133111EBU;
  return static_cast<float>((z ^ z >> 31) >> 40) / 16777216.0F;
}

}  // namespace wisp::drawing
