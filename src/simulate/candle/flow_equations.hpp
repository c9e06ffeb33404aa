#pragma once
// Numerical parts of a step of the flow: grid, advection, diffusion, combustion, pressure.
//
// Sources: F. Harlow & J. Welch, Phys. Fluids 8 (1965) 2182, for the grid of markers and cells: scalars at cell
// centres, velocity on cell faces, in one common padded layout. J. Stam, Stable Fluids (SIGGRAPH 1999), for advection,
// with trajectories by the midpoint rule and bilinear interpolation. C. Meyer, D. Balsara & T. Aslam, J. Comput. Phys.
// 257 (2014) 594, equations 9 to 11, for diffusion: a Runge–Kutta–Legendre super time step of first order (RKL1),
// explicit, stable over many of Euler's steps, without negative lobes. W. Briggs, V. Henson & S. McCormick, A Multigrid
// Tutorial (2nd ed.), chapters 4 and 10, and O. Tatebe, The multigrid preconditioned conjugate gradient method (1993),
// for the pressure.

#include <cstddef>
#include <vector>

namespace wisp::flow {

/// Four scalars of a cell in one vector, advected and diffused together.
using Float4 = float __attribute__((vector_size(16)));

/// Indices of a cell's scalars.
enum Lane { kMixture = 0, kFuel = 1, kTemperature = 2, kSoot = 3 };

inline constexpr float kAmbientTemperature = 300.0F;  ///< K
inline constexpr Float4 kAmbient = {0.0F, 0.0F, kAmbientTemperature, 0.0F};

/// Sizes and layout. Cell (i, j) spans [i h, (i+1) h] × [j h, (j+1) h], y up. Face u(i, j) is the cell's left one and
/// v(i, j) its lower one, so u has one more column and v one more row. All arrays have a border of one cell on the left
/// and below and of at least two on the right and above, so that they share one index and stencils need no bounds test.
struct FlowGrid {
  int nx = 0;
  int ny = 0;
  float h = 0;  ///< metres

  int stride() const { return nx + 4; }
  std::size_t size() const { return static_cast<std::size_t>(stride()) * (ny + 3); }
  int at(int i, int j) const { return (j + 1) * stride() + i + 1; }
};

using Plane = std::vector<float>;
using ScalarPlane = std::vector<Float4>;

/// Computes for each cell the displacement, in cells, of the parcel that reaches the cell's centre at the end of the
/// step; the border gets copies of the rim. `u`, `v` in m/s, `step` in seconds. Each component is clamped to a quarter
/// of the grid's shorter side.
void trace(const FlowGrid& grid, const Plane& u, const Plane& v, float step, Plane& way_x, Plane& way_y,
           Plane& scratch_x, Plane& scratch_y);

/// Advects the cells' scalars. The border of `from` states the scalars of inflowing air.
void advect(const FlowGrid& grid, const Plane& way_x, const Plane& way_y, const ScalarPlane& from, ScalarPlane& to);

/// Advect the velocities. Inflowing air has the velocity of the rim.
void advect_u(const FlowGrid& grid, const Plane& way_x, const Plane& way_y, const Plane& from, Plane& to);
void advect_v(const FlowGrid& grid, const Plane& way_x, const Plane& way_y, const Plane& from, Plane& to);

/// Diffusion equation dX/dt = scale · Σ flux (X_neighbour − X) over the given columns and rows.
struct Diffusion {
  int columns = 0;
  int rows = 0;
  const float* flux_x = nullptr;  ///< between element (i, j) and its left neighbour; 0: wall
  const float* flux_y = nullptr;  ///< between element (i, j) and its lower neighbour; 0: wall
};

/// Returns the number of stages that keep a step stable: odd, as even numbers damp worse, and at least 3. `strength`:
/// largest product of step, scale and flux of a face.
int rkl1_stages(float strength);

/// Diffuses in place. `scale` includes the step's length; `scratch`: as large as `values`, with a finite border.
void diffuse(const FlowGrid& grid, const Diffusion& diffusion, const Plane& scale, int stages, Plane& values,
             Plane& scratch);

/// Makes one step in place for the scalars of cells. Scalars whose component of `lanes` is 0 stay unchanged.
void diffuse(const FlowGrid& grid, const Diffusion& diffusion, const Plane& scale, int stages, Float4 lanes,
             ScalarPlane& values, ScalarPlane& scratch);

/// Combustion: a one-step reaction in terms of mixture fraction, formation and burnout of soot, light.
struct Combustion {
  explicit Combustion(float step);

  /// Burns fuel, forms and burns soot in all hot cells. Adds the fuel burnt per second to `blue`, if given.
  /// Returns the volume of cold fuel burnt, in cells.
  double burn(const FlowGrid& grid, ScalarPlane& cells, Plane* blue) const;

  /// Adds the glow of hot soot to `light`.
  void add_glow(const FlowGrid& grid, const ScalarPlane& cells, Plane& light) const;

 private:
  float burn_cell(Float4& cell) const;
  void soot_cell(Float4& cell, float oxygen) const;
  float glow(float temperature) const;

  float step_;
  Plane glow_;  // table over temperature
};

struct PressureSolve {
  int iterations = 0;
  float residual = 0;  ///< root mean square over cells, in the unit of the right side
};

/// The pressure equation on one grid of the multigrid: coefficients, right side, solution `x`, scratch `other`.
struct PressureLevel {
  FlowGrid grid;
  Plane beta_x, beta_y, diagonal, inverse_diagonal, right_side, x, other;
};

/// The pressure equation −∇·(β∇φ) = b by conjugate gradients, preconditioned with one multigrid V-cycle. A coarser grid
/// has half as many columns and rows, while both numbers are even and above 4. Coefficients of coarse faces are means
/// of fine ones; residuals are summed over the four children and corrections copied to them (transposes of each other,
/// as preconditioners need). The smoother is Chebyshev-weighted Jacobi sweeps, which can be vectorised.
class PressureSolver {
 public:
  explicit PressureSolver(const FlowGrid& grid);

  /// Face coefficients, to be set before prepare(): zero on closed faces. Outside the left, right and upper rim φ is 0;
  /// zeros on the lower rim make it a wall.
  Plane& beta_x() { return levels_.front().beta_x; }
  Plane& beta_y() { return levels_.front().beta_y; }

  /// Right side b, one value per cell; zero in cells that have no open face.
  Plane& right_side() { return levels_.front().right_side; }

  /// The solution, and the initial guess of the next solve.
  const Plane& phi() const { return phi_; }

  /// Updates the coarse grids from new face coefficients.
  void prepare();

  /// Iterates until the residual's root mean square is at most `tolerance`, but at most `most` times.
  PressureSolve solve(float tolerance, int most);

 private:
  void v_cycle(std::size_t level);
  void restrict_residual(const PressureLevel& fine, PressureLevel& coarse);

  std::vector<PressureLevel> levels_;
  Plane phi_, residual_, direction_, product_;
};

}  // namespace wisp::flow
