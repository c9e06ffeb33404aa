#pragma once
// Diffusion by a Runge–Kutta–Legendre super time step of first order (RKL1): explicit, stable over many times the step
// of Euler's method, no negative lobes.
//
// Source: C. Meyer, D. Balsara & T. Aslam, J. Comput. Phys. 257 (2014) 594, equations 9 to 11.

#include "simulate/candle/flow_grid.hpp"

namespace wisp::flow {

/// dX/dt = scale · Σ flux (X_neighbour − X) over the columns and rows given.
struct Diffusion {
  int columns = 0;
  int rows = 0;
  const float* flux_x = nullptr;  ///< at element (i, j): between it and its left neighbour; 0 is a wall
  const float* flux_y = nullptr;  ///< at element (i, j): between it and its lower neighbour
};

/// Stages that keep a step stable when `strength` is the largest step × scale × flux of a face.
/// Returns an odd number of at least 3 (even numbers damp worse).
int rkl1_stages(float strength);

/// One step in place. `scale` already holds the step's length; `scratch` is as large as `values` and its border must
/// hold finite numbers.
void diffuse(const FlowGrid& grid, const Diffusion& diffusion, const Plane& scale, int stages, Plane& values,
             Plane& scratch);

/// The same for the scalars of cells; lanes where `lanes` is 0 stay as they are.
void diffuse(const FlowGrid& grid, const Diffusion& diffusion, const Plane& scale, int stages, Float4 lanes,
             ScalarPlane& values, ScalarPlane& scratch);

}  // namespace wisp::flow
