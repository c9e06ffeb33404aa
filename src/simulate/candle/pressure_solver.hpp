#pragma once
// The pressure equation −∇·(β∇φ) = b by conjugate gradients, preconditioned with one multigrid V-cycle.
//
// Source: W. Briggs, V. Henson & S. McCormick, A Multigrid Tutorial (2nd ed.), chapters 4 and 10; O. Tatebe, The
// multigrid preconditioned conjugate gradient method (1993). Cells are halved while both sides are even, coefficients
// of coarse faces are means of fine ones, residuals are summed over and corrections copied to the four children (each
// the other's transpose, as a preconditioner needs), smoothed by Chebyshev-weighted Jacobi sweeps, which treat all
// cells alike and so can be vectorised.

#include <vector>

#include "simulate/candle/flow_grid.hpp"

namespace wisp::flow {

/// Result of a solve.
struct PressureSolve {
  int iterations = 0;
  float residual = 0;  ///< root mean square over cells, in the unit of the right side
};

/// The equation on one of the grids, with its coefficients.
struct PressureLevel {
  FlowGrid grid;
  Plane beta_x, beta_y, diagonal, inverse_diagonal, right_side, x, other;
};

class PressureSolver {
 public:
  explicit PressureSolver(const FlowGrid& grid);

  /// Face coefficients, to be set before prepare(): zero on closed faces. Outside the left, right and upper rim φ is 0;
  /// a lower rim of zeros is a wall.
  Plane& beta_x() { return levels_.front().beta_x; }
  Plane& beta_y() { return levels_.front().beta_y; }

  /// Right side b, one value per cell; zero in cells that have no open face.
  Plane& right_side() { return levels_.front().right_side; }

  /// The solution, and the initial guess of the next solve.
  const Plane& phi() const { return phi_; }

  /// Updates the coarse grids from new face coefficients.
  void prepare();

  /// Iterates until the residual's root mean square is at most `tolerance`, at most `most` times.
  PressureSolve solve(float tolerance, int most);

  /// Resets the initial guess to zero.
  void reset();

 private:
  void v_cycle(std::size_t level);
  void restrict_residual(const PressureLevel& fine, PressureLevel& coarse);

  std::vector<PressureLevel> levels_;
  Plane phi_, residual_, direction_, product_;
};

}  // namespace wisp::flow
