#pragma once
// Ground-truth outline of the rig's flame: the contour of its yellow light, its tip, and control points fitted to it.
//
// Source of the contours: W. Lorensen & H. Cline, Marching Cubes (SIGGRAPH 1987), in the plane; saddles are resolved by
// the square's mean.

#include <span>
#include <vector>

#include "simulate/candle/candle_rig.hpp"

namespace wisp {

inline constexpr int kOutlinePoints = 8;  ///< control points of an outline

/// A point in millimetres: x from the candle's axis, y up from its upper rim.
struct PointMm {
  double x = 0;
  double y = 0;
};

/// The outline of one frame. Without a flame, all fields but `area` and `brightness` are empty or zero.
struct FlameOutline {
  bool found = false;
  std::vector<PointMm> contour;  ///< the largest closed contour, cut at the base: from the base's left over the tip to
                                 ///< the base's right, about evenly spaced
  std::vector<PointMm> control_points;  ///< of the open, clamped, uniform cubic B-spline fitted to the contour
  PointMm base;                         ///< midpoint of the contour's ends
  PointMm tip;                          ///< mean of the 2 % of the contour farthest from the base
  double height = 0;                    ///< height of the tip above the base, mm
  double lean = 0;                      ///< angle of the line from base to tip from upright, degrees, positive to +x
  double area = 0;                      ///< area inside the contour, mm²
  double brightness = 0;                ///< light summed over the whole grid, in mm² of unit light
};

/// Extracts a frame's outline. Precondition: light.soot has columns × rows entries; columns and rows are at least 4.
FlameOutline flame_outline(const RigLight& light);

namespace flow {

/// Returns all closed contours at a level, each with the higher values on its right (clockwise around a hill, y up), in
/// the lattice's own units: value (i, j) is at x = i, y = j. Contours that end at the lattice's rim are omitted.
/// Precondition: values.size() == columns × rows.
std::vector<std::vector<PointMm>> closed_contours(std::span<const float> values, int columns, int rows, float level);

/// Returns the area inside a closed polygon, positive if it runs clockwise (y up).
double clockwise_area(std::span<const PointMm> polygon);

}  // namespace flow

}  // namespace wisp
