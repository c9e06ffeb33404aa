#pragma once
// How solid a shape is: 1 where it is convex, less the deeper its notches.

#include <vector>

#include "capture/vision/spline_table.hpp"

namespace wisp {

/// The area of a closed polygon over the area of its convex hull.
double solidity(const std::vector<CurvePoint>& polygon);

}  // namespace wisp
