#pragma once
// How like recorded falls are those that a chain makes, over seconds: windows of two seconds, their spectra, the tails
// of speed and acceleration, and how far falls spread. docs/explanation/fidelity.md says what is measured and why.

#include <array>
#include <cstdint>

#include "learn/chain/motion/motion.hpp"
#include "learn/fidelity/fidelity.hpp"

namespace wisp::chain {

inline constexpr double kLongWindowSeconds = 2;

/// What is told of the extremes of a set of falls, and of their spread.
struct FallExtremes {
  std::array<double, 4> vertical_speed{};  ///< m/s: 0.1, 1, 99 and 99.9 percentile
  std::array<double, 2> acceleration{};    ///< m/s²: 99 and 99.9 percentile of its size
  std::array<double, 3> spread{};          ///< m²: mean squared distance over ground in 0.5, 1 and 2 s
};

/// NaN where recordings are too short for it.
struct SecondsFidelity {
  Bounded spectra;  ///< energy distance of windows of two seconds: of the logarithms of their power in bands;
                    ///< below 0.3 mm and 0.2° nothing counts
  Bounded tails;    ///< largest relative deviation of a percentile; its ceiling is a normal distribution's
  Bounded spread;   ///< relative deviation of the spread in 2 s; its ceiling is that of steps in random order
  FallExtremes real;
  FallExtremes synthesized;
};

/// Compares at most so many windows a side. The real falls' halves are the floor, every other fall to a side.
SecondsFidelity seconds_fidelity(const Motion& real, const Motion& synthesized, std::size_t max_windows,
                                 std::uint64_t seed);

}  // namespace wisp::chain
