#pragma once
// Constants that several folders use.

#include <limits>

namespace wisp {

/// A value that is missing.
inline constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

/// Standard deviations to either side of a normal variable's 95 %.
inline constexpr double kNormal95 = 1.959963985;

}  // namespace wisp
