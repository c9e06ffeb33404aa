#pragma once
// An outline as a shape at rest and a few components of its deviation from it: principal components in the space of
// shape coordinates (T. Cootes and C. Taylor, "Active shape models", Computer Vision and Image Understanding 61
// (1995)).
//
// Shape coordinates pair the control points of the left flank with those of the right one: half their distance and
// their mean height are the same in the mirror image, their mean x and half the difference of their heights change
// sign. Of N points the first N coordinates are the symmetric ones, the next N the antisymmetric ones.
//
// In the round, turned about the vertical, symmetric coordinates are numbers and antisymmetric ones vectors of the
// level plane: the first N of these are their x, in the plane of the picture, and N more their z, towards who looks.

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

/// The most components of a kind that a shape has.
inline constexpr std::size_t kMaxShapeComponents = 256;

/// Shape coordinates = rest + basis · components, each clamped to the range that was recorded, so that flanks neither
/// cross each other nor leave the base.
struct ShapeComponents {
  std::size_t symmetric = 0;            ///< components that are the same in the mirror image; they come first
  std::size_t antisymmetric = 0;        ///< components that change sign there
  std::vector<double> rest;             ///< 2N shape coordinates; 3N in the round
  std::vector<double> basis;            ///< N × symmetric, then N × antisymmetric, row-major
  std::vector<ValueRange> coordinates;  ///< one a coordinate
  std::vector<ValueRange> components;   ///< one a component: to this and half of it more a component is clamped
  std::size_t across = 0;               ///< in the round as many more as are antisymmetric: the z of vectors whose x
                                        ///< these are

  bool empty() const { return rest.empty(); }
  std::size_t count() const { return symmetric + antisymmetric + across; }
  std::size_t points() const { return rest.size() / (across > 0 ? 3 : 2); }

  friend bool operator==(const ShapeComponents&, const ShapeComponents&) = default;
};

/// Control points x0, y0, x1, y1, … as shape coordinates, and back.
///
/// Precondition: an even number of values.
std::vector<double> shape_coordinates(std::span<const double> control_points);
std::vector<double> control_points(std::span<const double> shape_coordinates);

/// The control points of a shape whose components have these values; in the round as they are seen in the plane of the
/// picture.
///
/// Precondition: the shape has passed check(); one value a component.
std::vector<double> control_points(const ShapeComponents& shape, std::span<const double> components);

/// Checks that everything is finite and of the size that the others make, and that ranges are some, for an outline of
/// so many points. Nothing is checked of an empty one.
Result<void> check(const ShapeComponents& shape, std::size_t points);

}  // namespace wisp
