#pragma once
// Constants shared by several folders.

#include <limits>

namespace wisp {

inline constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

/// Half width of the central 95 % of a normal distribution, in standard deviations.
inline constexpr double kNormal95 = 1.959963985;

}  // namespace wisp
