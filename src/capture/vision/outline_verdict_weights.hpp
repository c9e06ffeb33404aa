#pragma once
// Fitted by tools/fit_verdict.py: do not edit.

#include <array>
#include <cstddef>

namespace wisp {

inline constexpr std::size_t kVerdictKnots = 5;

/// A fact's knots, and how much it lowers the two log odds at each of them.
struct VerdictCurve {
  std::array<double, kVerdictKnots> knots;
  std::array<double, kVerdictKnots> against_flame;
  std::array<double, kVerdictKnots> against_right;
};

// One fact per row; its name is in the comment.
// clang-format off
inline constexpr double kFlameOdds = 4.963;
inline constexpr double kRightOdds = 3.282;

inline constexpr std::array<VerdictCurve, 19> kVerdictCurves{{
    {{0.003, 0.008, 0.016, 0.03, 0.06}, {4.09, 4.09, 1.998, 1.018, 0}, {3.526, 3.526, 0, 0, 0}},  // movement
    {{1, 2, 4, 8, 16}, {1.103, 1.103, 1.103, 0, 0}, {0.9461, 0.9461, 0, 0, 0}},  // over_noise
    {{0.3, 0.8, 1.5, 3, 6}, {0, 1.93, 2.338, 2.342, 2.342}, {0, 0.2585, 0.2586, 0.2586, 0.2586}},  // wander
    {{0, 0.15, 0.3, 0.45, 0.6}, {0, 0, 0, 0, 0}, {0, 1.542, 3.024, 4.297, 4.297}},  // still
    {{0.48, 0.54, 0.6, 0.7, 0.8}, {1.897, 1.897, 0, 0, 0}, {0.8485, 0.8485, 0, 0, 0}},  // steadiness
    {{0, 0.2, 0.32, 0.42, 0.52}, {0, 0, 0, 0, 0}, {4.453, 4.453, 3.325, 0.4565, 0}},  // taper
    {{0.75, 0.85, 0.9, 0.94, 0.97}, {4.161, 4.161, 4.161, 3.276, 0}, {0.162, 0.162, 0.162, 0.162, 0}},  // light
    {{10, 25, 50, 80, 120}, {2.401, 2.401, 2.401, 2.401, 0}, {0, 0, 0, 0, 0}},  // contrast
    {{0.5, 0.65, 0.8, 1, 1.3}, {0, 0, 0, 0, 0}, {0, 0.1108, 4.6, 4.6, 4.6}},  // width
    {{0, 0.04, 0.1, 0.2, 0.35}, {0, 0.7898, 3.376, 4.192, 4.192}, {0, 0, 4.345, 4.345, 4.345}},  // misfit
    {{10, 25, 45, 60, 80}, {0, 0, 0, 0, 0}, {0, 1.136, 3.409, 4.328, 4.328}},  // lean
    {{0, 0.04, 0.08, 0.15, 0.3}, {0, 0, 0, 0, 0}, {0, 0, 0, 5.251, 5.251}},  // lost
    {{0.05, 0.15, 0.25, 0.35, 0.5}, {0, 0, 0, 0, 0}, {0, 0, 2.711, 4.671, 4.671}},  // repeated
    {{0, 0.05, 0.1, 0.2, 0.4}, {0, 0, 0, 0, 0}, {0, 2.22, 4.4, 4.4, 4.4}},  // elsewhere
    {{0, 0.02, 0.04, 0.08, 0.2}, {0, 0, 0, 0, 0}, {0, 0, 4.38, 4.38, 4.38}},  // missing
    {{0, 0.01, 0.03, 0.06, 0.15}, {0, 0, 0, 0, 0}, {0, 0, 0.6877, 4.284, 4.284}},  // jumps
    {{0, 0.03, 0.06, 0.15, 0.4}, {0, 0, 0, 0, 0}, {0, 0, 0, 5.816, 5.816}},  // border
    {{6, 9, 12, 18, 30}, {0, 0, 0, 0, 0}, {4.18, 4.18, 0, 0, 0}},  // height
    {{10, 15, 20, 30, 50}, {0, 0, 0, 0, 0}, {4.296, 4.296, 4.296, 0.382, 0}},  // tracked
}};
// clang-format on

}  // namespace wisp
