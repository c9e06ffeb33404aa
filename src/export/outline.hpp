#pragma once
// Outlines of a take: points of the spline, Bézier curves, operating point.

#include <array>
#include <span>
#include <vector>

#include "wisp/base/result.hpp"
#include "wisp/export/export.hpp"
#include "wisp/model/model.hpp"

namespace wisp::exporting {

/// Points of the spline at equal steps of its parameter, as x, y, 0.
std::vector<float> outline_points(const std::vector<double>& knots, std::span<const double> control, int points);

/// The spline as cubic Bézier curves, one after the other: 3 · curves + 1 points, each curve's last the next one's
/// first.
std::vector<std::array<double, 2>> bezier_points(const std::vector<double>& knots, std::span<const float> control);

/// Returns the operating point of the outputs of an ARX or switched model.
std::vector<double> operating_point(const Model& model);

/// Errors: the take has other outputs than the model, or no frames.
Result<void> check_take(const Model& model, const Take& take);

}  // namespace wisp::exporting
