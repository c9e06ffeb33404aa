#pragma once
// Whether a curve runs over itself, as no outline does.

#include <span>

#include "capture/vision/spline_table.hpp"

namespace wisp {

/// Whether two pieces of an open polyline that are not neighbours cross.
bool crosses_itself(std::span<const CurvePoint> polyline);

}  // namespace wisp
