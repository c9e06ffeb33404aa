#pragma once
// Semi-Lagrangian advection: every value is looked up where its parcel was one step ago.
//
// Source: J. Stam, Stable Fluids (SIGGRAPH 1999), with the parcel's way by the midpoint rule and bilinear look-up.

#include "simulate/candle/flow_grid.hpp"

namespace wisp::flow {

/// How far the parcel that is now in the middle of each cell moved during the step, in cells. The border holds copies
/// of the rim. `u`, `v` in metres a second, `step` in seconds; ways are held to a quarter of the grid.
void trace(const FlowGrid& grid, const Plane& u, const Plane& v, float step, Plane& way_x, Plane& way_y,
           Plane& scratch_x, Plane& scratch_y);

/// The cells' scalars moved. The border of `from` is what flows in.
void advect(const FlowGrid& grid, const Plane& way_x, const Plane& way_y, const ScalarPlane& from, ScalarPlane& to);

/// The velocities moved; what flows in is like the rim.
void advect_u(const FlowGrid& grid, const Plane& way_x, const Plane& way_y, const Plane& from, Plane& to);
void advect_v(const FlowGrid& grid, const Plane& way_x, const Plane& way_y, const Plane& from, Plane& to);

}  // namespace wisp::flow
