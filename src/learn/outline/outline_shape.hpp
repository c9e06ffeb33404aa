#pragma once
// Geometry of an outline: its polyline from control points, its tip, area, and overlap of two filled outlines.

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "model/bspline.hpp"

namespace wisp {

using OutlinePoint = std::array<double, 2>;

/// The outline curve at equally spaced parameters, with precomputed weights.
class OutlineCurve {
 public:
  /// Precondition: valid_knots(knots); samples >= 2.
  explicit OutlineCurve(std::span<const double> knots, std::size_t samples = 200);

  /// Points of the curve for control points x0, y0, x1, y1, …, from the base's left over the tip to the base's right.
  ///
  /// Precondition: two values for each control point of the knots.
  std::vector<OutlinePoint> polyline(std::span<const double> control) const;

 private:
  std::vector<BasisWeights> samples_;
};

/// Points at equal arc lengths of a polyline, including both ends, independent of the curve's parameter. Where the
/// polyline has no length, all are its first point. Precondition: the polyline has points; count >= 2.
std::vector<OutlinePoint> at_equal_lengths(std::span<const OutlinePoint> polyline, std::size_t count);

/// Tip of an outline: the mean of the 2 % of its points that are farthest from the middle of its base (its two ends). A
/// mean, because the single farthest point jumps on a blunt tip. Precondition: the polyline has points.
OutlinePoint tip_of(std::span<const OutlinePoint> polyline);

/// Distance of the tip from the middle of the base.
double height_of(std::span<const OutlinePoint> polyline);

/// Whether the outline, closed along its base, intersects itself. No real flame does.
bool crosses_itself(std::span<const OutlinePoint> polyline);

/// Area enclosed by a polygon without self-intersections.
double enclosed_area(std::span<const OutlinePoint> polygon);

/// Intersection over union of two closed polygons, each filled by the even-odd rule, in [0, 1]; 0 where neither has an
/// area. Both are cut into 1024 horizontal strips over their joint height, with exact intervals at each strip's
/// centre. The error is at most 1e-3 (one strip at a horizontal side), and 1e-4 on round outlines.
double overlap_of(std::span<const OutlinePoint> a, std::span<const OutlinePoint> b);

}  // namespace wisp
