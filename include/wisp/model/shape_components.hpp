#pragma once
// An outline as a shape at rest and a few components of its deviation from it: principal components in the space of
// shape coordinates (T. Cootes and C. Taylor, "Active shape models", Comput. Vision Image Understanding 61, 1995).
//
// Shape coordinates pair the control points of the left flank with those of the right one: half the difference of their
// x and their mean height are invariant under reflection (symmetric), their mean x and half the difference of their
// heights change sign (antisymmetric). N points have N symmetric coordinates, then N antisymmetric ones.
//
// For a three-dimensional body, antisymmetric coordinates are vectors of the horizontal plane: the N antisymmetric
// coordinates are their x, in the picture's plane, and N more coordinates their z, towards the viewer.

#include <cstddef>
#include <span>
#include <vector>

#include "wisp/base/result.hpp"

namespace wisp {

/// Closed range of a number.
struct ValueRange {
  double lowest = 0;
  double highest = 0;

  friend bool operator==(const ValueRange&, const ValueRange&) = default;
};

/// Largest number of symmetric components, and of antisymmetric ones.
inline constexpr std::size_t kMaxShapeComponents = 256;

/// Shape coordinates = rest + basis · components, each clamped to the recorded range, so that flanks neither cross each
/// other nor leave the base.
struct ShapeComponents {
  std::size_t symmetric = 0;            ///< number of components invariant under reflection; they come first
  std::size_t antisymmetric = 0;        ///< number of components that change sign under reflection
  std::vector<double> rest;             ///< 2N shape coordinates; 3N for a body
  std::vector<double> basis;            ///< N × symmetric, then N × antisymmetric, row-major
  std::vector<ValueRange> coordinates;  ///< one range per coordinate
  std::vector<ValueRange> components;   ///< one range per component; banks clamp to it, extended by half its width
  std::size_t across = 0;               ///< number of z components: for a body as `antisymmetric`, else 0

  bool empty() const { return rest.empty(); }
  std::size_t count() const { return symmetric + antisymmetric + across; }
  std::size_t points() const { return rest.size() / (across > 0 ? 3 : 2); }

  friend bool operator==(const ShapeComponents&, const ShapeComponents&) = default;
};

/// Convert control points x0, y0, x1, y1, … to shape coordinates, and back. Precondition: an even number of values.
std::vector<double> shape_coordinates(std::span<const double> control_points);
std::vector<double> control_points(std::span<const double> shape_coordinates);

/// Returns the control points of a shape with these component values; for a body, projected to the picture's plane.
/// Precondition: the shape has passed check(); one value per component.
std::vector<double> control_points(const ShapeComponents& shape, std::span<const double> components);

/// Checks that all numbers are finite, sizes consistent and ranges not empty, for an outline of `points` points. An
/// empty shape passes.
Result<void> check(const ShapeComponents& shape, std::size_t points);

}  // namespace wisp
