#pragma once
// Length of a vector in the picture. std::hypot guards against overflow, which pixels cannot reach, and costs ten times
// as much.

#include <cmath>

namespace wisp {

inline double length(double x, double y) { return std::sqrt(x * x + y * y); }

}  // namespace wisp
