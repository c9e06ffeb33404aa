#include "simulate/candle/flow_equations.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace wisp::flow {
namespace {

// Jacobi weights from the Chebyshev polynomial of degree 2 on the upper three quarters [0.5, 2] of the spectrum of
// D⁻¹A: error components that the coarse grid cannot represent shrink by 1/T₂(5/3) = 0.22.
constexpr float kWeightLow = 0.5617F;
constexpr float kWeightHigh = 1.3895F;
constexpr int kCoarsestPairs = 4;  // number of pairs of sweeps on the coarsest grid, which has few cells

void sweep(const PressureLevel& level, float weight, const Plane& from, Plane& to) {
  const FlowGrid& grid = level.grid;
  const int stride = grid.stride();
  for (int j = 0; j < grid.ny; ++j) {
    const int row = grid.at(0, j);
    const float* __restrict west = level.beta_x.data() + row;
    const float* __restrict south = level.beta_y.data() + row;
    const float* __restrict inverse = level.inverse_diagonal.data() + row;
    const float* __restrict b = level.right_side.data() + row;
    const float* __restrict x = from.data() + row;
    float* __restrict out = to.data() + row;
    for (int i = 0; i < grid.nx; ++i) {
      const float neighbours = (west[i] * x[i - 1] + west[i + 1] * x[i + 1]) +
                               (south[i] * x[i - stride] + south[i + stride] * x[i + stride]);
      out[i] = x[i] + weight * (inverse[i] * (b[i] + neighbours) - x[i]);
    }
  }
}

// Eight running sums, each over its own columns: a fixed order that can be vectorised.
double dot(const FlowGrid& grid, const Plane& a, const Plane& b) {
  double total = 0;
  for (int j = 0; j < grid.ny; ++j) {
    const float* __restrict p = a.data() + grid.at(0, j);
    const float* __restrict q = b.data() + grid.at(0, j);
    std::array<float, 8> sums{};
    int i = 0;
    for (; i + 8 <= grid.nx; i += 8)
      for (int k = 0; k < 8; ++k) sums[k] += p[i + k] * q[i + k];
    for (; i < grid.nx; ++i) sums[0] += p[i] * q[i];
    total +=
        static_cast<double>(((sums[0] + sums[1]) + (sums[2] + sums[3])) + ((sums[4] + sums[5]) + (sums[6] + sums[7])));
  }
  return total;
}

void add_scaled(const FlowGrid& grid, Plane& to, float factor, const Plane& what) {
  for (int j = 0; j < grid.ny; ++j) {
    float* __restrict out = to.data() + grid.at(0, j);
    const float* __restrict in = what.data() + grid.at(0, j);
    for (int i = 0; i < grid.nx; ++i) out[i] += factor * in[i];
  }
}

// direction = z + factor · direction
void new_direction(const FlowGrid& grid, Plane& direction, float factor, const Plane& z) {
  for (int j = 0; j < grid.ny; ++j) {
    float* __restrict out = direction.data() + grid.at(0, j);
    const float* __restrict in = z.data() + grid.at(0, j);
    for (int i = 0; i < grid.nx; ++i) out[i] = in[i] + factor * out[i];
  }
}

// out = A x, or out = b − A x if a right side is given.
template <bool kResidual>
void apply(const PressureLevel& level, const Plane& from, Plane& to) {
  const FlowGrid& grid = level.grid;
  const int stride = grid.stride();
  for (int j = 0; j < grid.ny; ++j) {
    const int row = grid.at(0, j);
    const float* __restrict west = level.beta_x.data() + row;
    const float* __restrict south = level.beta_y.data() + row;
    const float* __restrict centre = level.diagonal.data() + row;
    const float* __restrict b = level.right_side.data() + row;
    const float* __restrict x = from.data() + row;
    float* __restrict out = to.data() + row;
    for (int i = 0; i < grid.nx; ++i) {
      const float neighbours = (west[i] * x[i - 1] + west[i + 1] * x[i + 1]) +
                               (south[i] * x[i - stride] + south[i + stride] * x[i + stride]);
      const float product = centre[i] * x[i] - neighbours;
      out[i] = kResidual ? b[i] - product : product;
    }
  }
}

void set_diagonal(PressureLevel& level) {
  const int stride = level.grid.stride();
  for (int j = 0; j < level.grid.ny; ++j) {
    const int row = level.grid.at(0, j);
    const float* __restrict west = level.beta_x.data() + row;
    const float* __restrict south = level.beta_y.data() + row;
    float* __restrict sum = level.diagonal.data() + row;
    float* __restrict reciprocal = level.inverse_diagonal.data() + row;
    for (int i = 0; i < level.grid.nx; ++i) {
      const float d = (west[i] + west[i + 1]) + (south[i] + south[i + stride]);
      sum[i] = d;
      reciprocal[i] = d > 0.0F ? 1.0F / d : 0.0F;
    }
  }
}

void coarsen(const PressureLevel& fine, PressureLevel& coarse) {
  const FlowGrid& grid = coarse.grid;
  for (int j = 0; j <= grid.ny; ++j)
    for (int i = 0; i <= grid.nx; ++i) {
      const int child = fine.grid.at(2 * i, 2 * j), up = fine.grid.stride(), cell = grid.at(i, j);
      if (j < grid.ny) coarse.beta_x[cell] = 0.5F * (fine.beta_x[child] + fine.beta_x[child + up]);
      if (i < grid.nx) coarse.beta_y[cell] = 0.5F * (fine.beta_y[child] + fine.beta_y[child + 1]);
    }
}

void smooth_from_zero(PressureLevel& level) {
  for (int j = 0; j < level.grid.ny; ++j) {
    const int row = level.grid.at(0, j);
    const float* __restrict inverse = level.inverse_diagonal.data() + row;
    const float* __restrict b = level.right_side.data() + row;
    float* __restrict out = level.other.data() + row;
    for (int i = 0; i < level.grid.nx; ++i) out[i] = kWeightLow * (inverse[i] * b[i]);
  }
  sweep(level, kWeightHigh, level.other, level.x);
}

void correct(const PressureLevel& coarse, PressureLevel& fine) {
  for (int j = 0; j < coarse.grid.ny; ++j)
    for (int i = 0; i < coarse.grid.nx; ++i) {
      float* x = fine.x.data() + fine.grid.at(2 * i, 2 * j);
      const int up = fine.grid.stride();
      const float correction = coarse.x[coarse.grid.at(i, j)];
      x[0] += correction;
      x[1] += correction;
      x[up] += correction;
      x[up + 1] += correction;
    }
}

}  // namespace

PressureSolver::PressureSolver(const FlowGrid& grid) {
  FlowGrid g = grid;
  while (true) {
    const Plane zero(g.size(), 0.0F);
    levels_.push_back({g, zero, zero, zero, zero, zero, zero, zero});
    if (g.nx % 2 != 0 || g.ny % 2 != 0 || std::min(g.nx, g.ny) <= 4) break;
    g = {g.nx / 2, g.ny / 2, g.h * 2};
  }
  phi_ = residual_ = direction_ = product_ = Plane(grid.size(), 0.0F);
}

void PressureSolver::reset() { std::fill(phi_.begin(), phi_.end(), 0.0F); }

void PressureSolver::prepare() {
  for (std::size_t l = 0; l < levels_.size(); ++l) {
    if (l > 0) coarsen(levels_[l - 1], levels_[l]);
    set_diagonal(levels_[l]);
  }
}

void PressureSolver::restrict_residual(const PressureLevel& fine, PressureLevel& coarse) {
  apply<true>(fine, fine.x, product_);
  for (int j = 0; j < coarse.grid.ny; ++j)
    for (int i = 0; i < coarse.grid.nx; ++i) {
      const float* r = product_.data() + fine.grid.at(2 * i, 2 * j);
      const int up = fine.grid.stride();
      coarse.right_side[coarse.grid.at(i, j)] = (r[0] + r[1]) + (r[up] + r[up + 1]);
    }
}

void PressureSolver::v_cycle(std::size_t index) {
  PressureLevel& level = levels_[index];
  smooth_from_zero(level);
  const bool coarsest = index + 1 == levels_.size();
  if (!coarsest) {
    restrict_residual(level, levels_[index + 1]);
    v_cycle(index + 1);
    correct(levels_[index + 1], level);
  }
  for (int pair = 0; pair < (coarsest ? kCoarsestPairs : 1); ++pair) {
    sweep(level, kWeightLow, level.x, level.other);
    sweep(level, kWeightHigh, level.other, level.x);
  }
}

PressureSolve PressureSolver::solve(float tolerance, int most) {
  PressureLevel& top = levels_.front();
  const FlowGrid& grid = top.grid;
  const double cells = static_cast<double>(grid.nx) * grid.ny;
  apply<true>(top, phi_, residual_);
  PressureSolve result;
  double rz_before = 0;
  while (true) {
    result.residual = static_cast<float>(std::sqrt(dot(grid, residual_, residual_) / cells));
    if (!(result.residual > tolerance) || result.iterations == most) break;
    top.right_side.swap(residual_);
    v_cycle(0);
    top.right_side.swap(residual_);
    const double rz = dot(grid, residual_, top.x);
    new_direction(grid, direction_, result.iterations == 0 ? 0.0F : static_cast<float>(rz / rz_before), top.x);
    rz_before = rz;
    apply<false>(top, direction_, product_);
    const double curvature = dot(grid, direction_, product_);
    if (!(curvature > 0)) break;
    const auto step = static_cast<float>(rz / curvature);
    add_scaled(grid, phi_, step, direction_);
    add_scaled(grid, residual_, -step, product_);
    ++result.iterations;
  }
  return result;
}

}  // namespace wisp::flow
