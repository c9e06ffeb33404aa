#pragma once
// The true outline of the rig's flame: the contour of its yellow light, its tip, and control points fitted to it.
//
// Source of the contours: W. Lorensen & H. Cline, Marching Cubes (SIGGRAPH 1987), in the plane; saddles are resolved by
// the square's mean.

#include <array>
#include <span>
#include <vector>

#include "simulate/candle/candle_rig.hpp"
#include "wisp/simulate/candle_clip.hpp"

namespace wisp {

inline constexpr int kOutlinePoints = 8;  ///< control points

/// A point in millimetres: x from the candle's axis, y up from its upper rim.
struct PointMm {
  double x = 0;
  double y = 0;
};

/// The outline of one frame. All empty or zero where there is no flame.
struct FlameOutline {
  bool found = false;
  std::vector<PointMm> contour;  ///< the largest closed contour, cut at the base: from the base's left over the tip to
                                 ///< the base's right, about evenly spaced
  std::vector<PointMm> control_points;  ///< of an open, clamped, uniform cubic B-spline along it, least squares
  PointMm base;                         ///< middle between the contour's ends
  PointMm tip;                          ///< mean of the 2 % of the contour farthest from the base
  double height = 0;                    ///< mm, of the tip above the base
  double lean = 0;                      ///< degrees from upright, positive towards +x
  double area = 0;                      ///< mm² inside the contour
  double brightness = 0;                ///< light summed over the whole grid, in mm² of unit light
};

/// Takes the outline of a frame's light.
///
/// Precondition: light.soot has columns × rows entries, each of at least 4.
FlameOutline flame_outline(const RigLight& light);

namespace flow {

/// All closed contours at a level, each with the higher values on its right (clockwise around a hill, y up), in the
/// lattice's own units: value (i, j) is at x = i, y = j. Contours that end at the lattice's rim are left out.
///
/// Precondition: values.size() == columns × rows.
std::vector<std::vector<PointMm>> closed_contours(std::span<const float> values, int columns, int rows, float level);

/// Area inside a closed polygon, positive if it runs clockwise (y up).
double clockwise_area(std::span<const PointMm> polygon);

}  // namespace flow

}  // namespace wisp
