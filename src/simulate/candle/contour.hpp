#pragma once
// Closed contours of a lattice of values, by marching squares.
//
// Source: W. Lorensen & H. Cline, Marching Cubes (SIGGRAPH 1987), in the plane; saddles are resolved by the square's
// mean.

#include <span>
#include <vector>

#include "simulate/candle/flame_outline.hpp"

namespace wisp::flow {

/// All closed contours at a level, each with the higher values on its right (clockwise around a hill, y up), in the
/// lattice's own units: value (i, j) is at x = i, y = j. Contours that end at the lattice's rim are left out.
///
/// Precondition: values.size() == columns × rows.
std::vector<std::vector<PointMm>> closed_contours(std::span<const float> values, int columns, int rows, float level);

/// Area inside a closed polygon, positive if it runs clockwise (y up).
double clockwise_area(std::span<const PointMm> polygon);

}  // namespace wisp::flow
