#pragma once
// Advection and diffusion of the cells' scalars and of velocity.
//
// Sources: J. Stam, Stable Fluids (SIGGRAPH 1999), with trajectories by the midpoint rule and bilinear interpolation;
// C. Meyer, D. Balsara & T. Aslam, J. Comput. Phys. 257 (2014) 594, equations 9 to 11: a Runge–Kutta–Legendre super
// time step of first order (RKL1), explicit, stable over many of Euler's steps, without negative lobes.

#include "simulate/candle/flow_grid.hpp"

namespace wisp::flow {

/// Computes the displacement, in cells, during the step, of the parcel that ends at each cell's centre. The border
/// holds copies of the rim. `u`, `v` in metres per second, `step` in seconds; displacements are clamped to a quarter of
/// the grid.
void trace(const FlowGrid& grid, const Plane& u, const Plane& v, float step, Plane& way_x, Plane& way_y,
           Plane& scratch_x, Plane& scratch_y);

/// Advects the cells' scalars. The border of `from` is the inflow.
void advect(const FlowGrid& grid, const Plane& way_x, const Plane& way_y, const ScalarPlane& from, ScalarPlane& to);

/// Advects the velocities. The inflow equals the rim.
void advect_u(const FlowGrid& grid, const Plane& way_x, const Plane& way_y, const Plane& from, Plane& to);
void advect_v(const FlowGrid& grid, const Plane& way_x, const Plane& way_y, const Plane& from, Plane& to);

/// Diffusion equation dX/dt = scale · Σ flux (X_neighbour − X) over the given columns and rows.
struct Diffusion {
  int columns = 0;
  int rows = 0;
  const float* flux_x = nullptr;  ///< at element (i, j): between it and its left neighbour; 0 is a wall
  const float* flux_y = nullptr;  ///< at element (i, j): between it and its lower neighbour
};

/// Returns the number of stages that keep a step stable when `strength` is the largest step × scale × flux of a face:
/// an odd number of at least 3 (even numbers damp worse).
int rkl1_stages(float strength);

/// Makes one step in place. `scale` includes the step's length; `scratch` is as large as `values` and its border must
/// hold finite numbers.
void diffuse(const FlowGrid& grid, const Diffusion& diffusion, const Plane& scale, int stages, Plane& values,
             Plane& scratch);

/// Makes one step for the scalars of cells; those where `lanes` is 0 stay unchanged.
void diffuse(const FlowGrid& grid, const Diffusion& diffusion, const Plane& scale, int stages, Float4 lanes,
             ScalarPlane& values, ScalarPlane& scratch);

}  // namespace wisp::flow
