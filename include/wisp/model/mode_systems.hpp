#pragma once
// Modes of a chain realised as systems: while a mode lasts, a body's velocities follow a difference equation from where
// the mode before left them. Nothing is joined, so nothing jumps.

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "wisp/base/result.hpp"

namespace wisp {

/// Velocity and angular velocity in the body's own axes: metres and radians a second.
inline constexpr std::size_t kSystemStates = 6;

/// Equally likely durations that a mode keeps.
inline constexpr std::size_t kSystemDurations = 16;

/// Terms of the right-hand side: 1, the six velocities, "up" in the body's axes (3) and, of degree 2, the products of
/// each of those nine with itself and the later ones. 10 or 55.
std::size_t system_terms(int degree);

/// One mode: z(t + 1) = coefficient · terms(z(t), up(t)) + noise · e(t), clamped to [lowest, highest].
struct ModeSystem {
  std::vector<double> coefficient;  ///< 6 × terms, row-major
  std::vector<double> noise;        ///< 6 × 6, lower triangular, row-major: of independent standard normal deviates;
                                    ///< empty: none
  std::array<double, kSystemStates> lowest{};
  std::array<double, kSystemStates> highest{};
  std::array<std::uint16_t, kSystemDurations> steps{};  ///< ≥ 1
};

struct ModeSystems {
  int degree = 1;  ///< 1: linear; 2: a differential equation with products, by its step
  std::vector<ModeSystem> modes;
};

/// Errors: shapes, ranges, numbers that are not finite.
Result<void> check(const ModeSystems& systems, int modes);

}  // namespace wisp
