#include "simulate/candle/flow_equations.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "simulate/random_numbers.hpp"

namespace wisp::flow::pressure_solver_test {
namespace {

// Hot gas in the middle, a solid block below it, walls at the bottom, open elsewhere: what a candle makes of it.
void set_candle_like(const FlowGrid& grid, PressureSolver& solver) {
  for (int j = 0; j <= grid.ny; ++j)
    for (int i = 0; i <= grid.nx; ++i) {
      const double x = (i - 0.5 * grid.nx) / grid.nx;
      const auto hot = static_cast<float>(1 + 6 * std::exp(-100 * x * x));
      const auto solid = [&](int a, int b) { return std::abs(a - grid.nx / 2) < grid.nx / 8 && b < grid.ny / 8; };
      solver.beta_x()[grid.at(i, j)] = j < grid.ny && !solid(i, j) && !solid(i - 1, j) ? hot : 0.0F;
      solver.beta_y()[grid.at(i, j)] = i < grid.nx && j > 0 && !solid(i, j) && !solid(i, j - 1) ? hot : 0.0F;
    }
}

float open_faces(const FlowGrid& grid, PressureSolver& solver, int k) {
  return solver.beta_x()[k] + solver.beta_x()[k + 1] + solver.beta_y()[k] + solver.beta_y()[k + grid.stride()];
}

// The right side that a known answer has.
void set_right_side(const FlowGrid& grid, PressureSolver& solver, const Plane& answer) {
  const int up = grid.stride();
  const Plane& bx = solver.beta_x();
  const Plane& by = solver.beta_y();
  for (int j = 0; j < grid.ny; ++j)
    for (int i = 0; i < grid.nx; ++i) {
      const int k = grid.at(i, j);
      solver.right_side()[k] = bx[k] * (answer[k] - answer[k - 1]) + bx[k + 1] * (answer[k] - answer[k + 1]) +
                               by[k] * (answer[k] - answer[k - up]) + by[k + up] * (answer[k] - answer[k + up]);
    }
}

Plane random_answer(const FlowGrid& grid, PressureSolver& solver) {
  Plane answer(grid.size(), 0.0F);
  RandomNumbers numbers(3, 0);
  for (int j = 0; j < grid.ny; ++j)
    for (int i = 0; i < grid.nx; ++i) {
      const int k = grid.at(i, j);
      answer[k] = open_faces(grid, solver, k) > 0 ? static_cast<float>(numbers.normal()) : 0.0F;
    }
  return answer;
}

TEST(PressureSolver, FindsAKnownAnswer) {
  const FlowGrid grid{48, 64, 1.0F};
  PressureSolver solver(grid);
  set_candle_like(grid, solver);
  const Plane answer = random_answer(grid, solver);
  set_right_side(grid, solver, answer);
  solver.prepare();
  const PressureSolve solve = solver.solve(1e-4F, 60);
  EXPECT_LE(solve.residual, 1e-4F);
  // Multigrid: a factor of about three an iteration, whatever the grid.
  EXPECT_LE(solve.iterations, 25);
  for (int j = 0; j < grid.ny; ++j)
    for (int i = 0; i < grid.nx; ++i) {
      const int k = grid.at(i, j);
      if (open_faces(grid, solver, k) > 0) {
        ASSERT_NEAR(solver.phi()[k], answer[k], 0.02F) << i << ", " << j;
      }
    }
}

TEST(PressureSolver, NeedsHardlyMoreIterationsOnAGridFourTimesAsFine) {
  int iterations[2] = {};
  for (int k = 0; k < 2; ++k) {
    const FlowGrid grid{32 << (2 * k), 64 << (2 * k), 1.0F};
    PressureSolver solver(grid);
    set_candle_like(grid, solver);
    set_right_side(grid, solver, random_answer(grid, solver));
    solver.prepare();
    iterations[k] = solver.solve(1e-3F, 200).iterations;
  }
  EXPECT_LE(iterations[1], 2 * iterations[0]);
}

TEST(PressureSolver, StartsFromItsLastAnswer) {
  const FlowGrid grid{32, 32, 1.0F};
  PressureSolver solver(grid);
  set_candle_like(grid, solver);
  set_right_side(grid, solver, random_answer(grid, solver));
  solver.prepare();
  EXPECT_GT(solver.solve(1e-3F, 60).iterations, 3);
  EXPECT_EQ(solver.solve(2e-3F, 60).iterations, 0);
}

TEST(PressureSolver, WorksOnSidesThatCannotBeHalved) {
  const FlowGrid grid{33, 47, 1.0F};
  PressureSolver solver(grid);
  set_candle_like(grid, solver);
  set_right_side(grid, solver, random_answer(grid, solver));
  solver.prepare();
  EXPECT_LE(solver.solve(1e-3F, 400).residual, 1e-3F);
}

}  // namespace
}  // namespace wisp::flow::pressure_solver_test
