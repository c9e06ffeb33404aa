#include "simulate/candle/flow_equations.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace wisp::flow {
namespace {

// Bilinear interpolation position: index of the lower left value and the weights of its right and upper neighbours.
struct Place {
  int index;
  float right;
  float up;
};

// Returns the position of x, y, clamped to [lowest, highest]. NaN becomes `lowest`, so that every index is in the grid.
Place place(const FlowGrid& grid, float x, float y, float lowest, float highest_x, float highest_y) {
  x = x > lowest ? std::min(x, highest_x) : lowest;
  y = y > lowest ? std::min(y, highest_y) : lowest;
  // Truncation rounds down, since adding 1 makes the border's −1 non-negative.
  const int i = static_cast<int>(x + 1.0F) - 1;
  const int j = static_cast<int>(y + 1.0F) - 1;
  return {grid.at(i, j), x - static_cast<float>(i), y - static_cast<float>(j)};
}

template <class T>
T look_up(const T* values, int stride, Place p) {
  const T* corner = values + p.index;
  const T lower = corner[0] + p.right * (corner[1] - corner[0]);
  const T upper = corner[stride] + p.right * (corner[stride + 1] - corner[stride]);
  return lower + p.up * (upper - lower);
}

void copy_rim(const FlowGrid& grid, Plane& plane) {
  for (int j = 0; j < grid.ny; ++j) {
    plane[grid.at(-1, j)] = plane[grid.at(0, j)];
    plane[grid.at(grid.nx, j)] = plane[grid.at(grid.nx - 1, j)];
  }
  const std::size_t row = grid.stride();
  std::copy_n(plane.begin() + grid.at(-1, 0), row, plane.begin() + grid.at(-1, -1));
  std::copy_n(plane.begin() + grid.at(-1, grid.ny - 1), row, plane.begin() + grid.at(-1, grid.ny));
}

void centre_velocity(const FlowGrid& grid, const Plane& u, const Plane& v, float cells_per_speed, Plane& x, Plane& y) {
  const int stride = grid.stride();
  const float half = 0.5F * cells_per_speed;
  for (int j = 0; j < grid.ny; ++j) {
    const int row = grid.at(0, j);
    const float* __restrict left = u.data() + row;
    const float* __restrict low = v.data() + row;
    float* __restrict out_x = x.data() + row;
    float* __restrict out_y = y.data() + row;
    for (int i = 0; i < grid.nx; ++i) {
      out_x[i] = half * (left[i] + left[i + 1]);
      out_y[i] = half * (low[i] + low[i + stride]);
    }
  }
  copy_rim(grid, x);
  copy_rim(grid, y);
}

// Sets to = mu · from + nu · to + rate · scale · L(from), where L sums flux times difference over the four neighbours.
template <class T>
void stage(const FlowGrid& grid, const Diffusion& d, const Plane& scale, float mu, float nu, T rate, const T* from,
           T* to) {
  const int stride = grid.stride();
  for (int j = 0; j < d.rows; ++j) {
    const int row = grid.at(0, j);
    const float* __restrict west = d.flux_x + row;
    const float* __restrict south = d.flux_y + row;
    const float* __restrict c = scale.data() + row;
    const T* __restrict x = from + row;
    T* __restrict out = to + row;
    for (int i = 0; i < d.columns; ++i) {
      const T inflow = (west[i] * (x[i - 1] - x[i]) + west[i + 1] * (x[i + 1] - x[i])) +
                       (south[i] * (x[i - stride] - x[i]) + south[i + stride] * (x[i + stride] - x[i]));
      out[i] = mu * x[i] + nu * out[i] + rate * (c[i] * inflow);
    }
  }
}

template <class T>
void step(const FlowGrid& grid, const Diffusion& d, const Plane& scale, int stages, T lanes, std::vector<T>& values,
          std::vector<T>& scratch) {
  const float width = 2.0F / static_cast<float>(stages * stages + stages);
  // From the second stage on, `to` holds the stage before the previous one and is overwritten.
  stage(grid, d, scale, 1.0F, 0.0F, width * lanes, values.data(), scratch.data());
  for (int j = 2; j <= stages; ++j) {
    const auto order = static_cast<float>(j);
    const float mu = (2.0F * order - 1.0F) / order;
    stage(grid, d, scale, mu, (1.0F - order) / order, mu * width * lanes, scratch.data(), values.data());
    std::swap(values, scratch);
  }
  std::swap(values, scratch);
}

constexpr float kGlowFrom = 900.0F;  // K: a camera sees colder soot as black
constexpr float kGlowTo = 2500.0F;
constexpr float kGlowStep = 5.0F;
constexpr double kGlowActivation = 9000;  // K: second radiation constant over a wavelength of orange-red light,
                                          // including a soot absorption proportional to 1/wavelength; calibrated
constexpr double kGlowUnit = 1800;        // K: temperature at which soot of unit density has glow 1
constexpr float kMaxSoot = 1.2F;
constexpr float kStoichiometric = 0.08F;         // mixture fraction of stoichiometric combustion
constexpr float kHeat = 1700 / 0.08;             // K per unit of fuel burnt: 1700 K at stoichiometry
constexpr float kReactionRate = 2000.0F;         // 1/s at the full rate
constexpr float kIgnitionLow = 900.0F;           // K: no reaction below; soot burns from 1000 K, forms from 1250 K
constexpr float kIgnitionWidth = 400.0F;         // K: width of the rise to the full rate
constexpr float kSootRate = 60, kBurnout = 400;  // 1/s, calibrated: maximum rates of formation and burnout

// Returns a smooth step: 0 up to a, 1 from a + width.
float smoothstep(float x, float a, float width) {
  const float t = std::clamp((x - a) / width, 0.0F, 1.0F);
  return t * t * (3.0F - 2.0F * t);
}

// About 1 − e^(−x), x ≥ 0: to 0.2 % at 1, never above 1, without a library's exp, whose bits differ between machines.
float share_of_step(float x) {
  return 1.0F - 1.0F / (1.0F + x * (1.0F + x * (0.5F + x * (1.0F / 6 + x * (1.0F / 24)))));
}

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

// Returns the dot product, by eight running sums, each over its own columns: a fixed order that can be vectorised.
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

// Sets direction = z + factor · direction.
void new_direction(const FlowGrid& grid, Plane& direction, float factor, const Plane& z) {
  for (int j = 0; j < grid.ny; ++j) {
    float* __restrict out = direction.data() + grid.at(0, j);
    const float* __restrict in = z.data() + grid.at(0, j);
    for (int i = 0; i < grid.nx; ++i) out[i] = in[i] + factor * out[i];
  }
}

// Sets `to` to A · from, or with kResidual to b − A · from.
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

void trace(const FlowGrid& grid, const Plane& u, const Plane& v, float step, Plane& way_x, Plane& way_y,
           Plane& scratch_x, Plane& scratch_y) {
  centre_velocity(grid, u, v, step / grid.h, scratch_x, scratch_y);
  const auto right = static_cast<float>(grid.nx - 1);
  const auto top = static_cast<float>(grid.ny - 1);
  const float longest = 0.25F * static_cast<float>(std::min(grid.nx, grid.ny));
  for (int j = 0; j < grid.ny; ++j)
    for (int i = 0; i < grid.nx; ++i) {
      const int cell = grid.at(i, j);
      const Place middle = place(grid, static_cast<float>(i) - 0.5F * scratch_x[cell],
                                 static_cast<float>(j) - 0.5F * scratch_y[cell], 0.0F, right, top);
      way_x[cell] = std::clamp(look_up(scratch_x.data(), grid.stride(), middle), -longest, longest);
      way_y[cell] = std::clamp(look_up(scratch_y.data(), grid.stride(), middle), -longest, longest);
    }
  copy_rim(grid, way_x);
  copy_rim(grid, way_y);
}

void advect(const FlowGrid& grid, const Plane& way_x, const Plane& way_y, const ScalarPlane& from, ScalarPlane& to) {
  const auto right = static_cast<float>(grid.nx);
  const auto top = static_cast<float>(grid.ny);
  // Rounded to zero: fuel decays for ever, down to denormal numbers, which are a hundred times slower than others.
  constexpr float kNothing = 1e-12F;
  for (int j = 0; j < grid.ny; ++j)
    for (int i = 0; i < grid.nx; ++i) {
      const int cell = grid.at(i, j);
      const Float4 moved = look_up(
          from.data(), grid.stride(),
          place(grid, static_cast<float>(i) - way_x[cell], static_cast<float>(j) - way_y[cell], -1.0F, right, top));
      to[cell] = (moved + kNothing) - kNothing;
    }
}

void advect_u(const FlowGrid& grid, const Plane& way_x, const Plane& way_y, const Plane& from, Plane& to) {
  const auto right = static_cast<float>(grid.nx);
  const auto top = static_cast<float>(grid.ny - 1);
  for (int j = 0; j < grid.ny; ++j)
    for (int i = 0; i <= grid.nx; ++i) {
      const int face = grid.at(i, j);
      const float x = static_cast<float>(i) - 0.5F * (way_x[face - 1] + way_x[face]);
      const float y = static_cast<float>(j) - 0.5F * (way_y[face - 1] + way_y[face]);
      to[face] = look_up(from.data(), grid.stride(), place(grid, x, y, 0.0F, right, top));
    }
}

void advect_v(const FlowGrid& grid, const Plane& way_x, const Plane& way_y, const Plane& from, Plane& to) {
  const int stride = grid.stride();
  const auto right = static_cast<float>(grid.nx - 1);
  const auto top = static_cast<float>(grid.ny);
  for (int j = 0; j <= grid.ny; ++j)
    for (int i = 0; i < grid.nx; ++i) {
      const int face = grid.at(i, j);
      const float x = static_cast<float>(i) - 0.5F * (way_x[face - stride] + way_x[face]);
      const float y = static_cast<float>(j) - 0.5F * (way_y[face - stride] + way_y[face]);
      to[face] = look_up(from.data(), grid.stride(), place(grid, x, y, 0.0F, right, top));
    }
}

int rkl1_stages(float strength) {
  // Euler is stable up to a strength of 1/4 (two dimensions, five points); s stages reach (s² + s)/2 times as far.
  int stages = 3;
  while (0.25F * 0.5F * static_cast<float>(stages * stages + stages) < strength) stages += 2;
  return stages;
}

void diffuse(const FlowGrid& grid, const Diffusion& diffusion, const Plane& scale, int stages, Plane& values,
             Plane& scratch) {
  step(grid, diffusion, scale, stages, 1.0F, values, scratch);
}

void diffuse(const FlowGrid& grid, const Diffusion& diffusion, const Plane& scale, int stages, Float4 lanes,
             ScalarPlane& values, ScalarPlane& scratch) {
  step(grid, diffusion, scale, stages, lanes, values, scratch);
}

Combustion::Combustion(float step) : step_(step) {
  for (float t = kGlowFrom; t <= kGlowTo + 2 * kGlowStep; t += kGlowStep)
    glow_.push_back(static_cast<float>(std::exp(-kGlowActivation * (1.0 / static_cast<double>(t) - 1.0 / kGlowUnit))));
}

float Combustion::burn_cell(Float4& cell) const {
  const float oxygen_per_fuel = kStoichiometric / (1.0F - kStoichiometric);
  const float oxygen = (1.0F - cell[kMixture]) - (cell[kMixture] - cell[kFuel]) / oxygen_per_fuel;
  const float burnable = std::min(cell[kFuel], std::max(oxygen, 0.0F) * oxygen_per_fuel);
  const float hot = smoothstep(cell[kTemperature], kIgnitionLow, kIgnitionWidth);
  const float burnt = burnable * share_of_step(kReactionRate * step_ * hot);
  cell[kFuel] -= burnt;
  cell[kTemperature] += kHeat * burnt;
  soot_cell(cell, oxygen - burnt / oxygen_per_fuel);
  return burnt;
}

void Combustion::soot_cell(Float4& cell, float oxygen) const {
  const float richness = cell[kMixture] / kStoichiometric;
  const float temperature = cell[kTemperature];
  const float made = kSootRate * smoothstep(richness, 1.05F, 0.75F) * smoothstep(temperature, 1250.0F, 300.0F);
  const float lost = kBurnout * smoothstep(oxygen, 0.02F, 0.1F) * smoothstep(temperature, 1000.0F, 400.0F);
  cell[kSoot] = (cell[kSoot] + step_ * made * kMaxSoot) / (1.0F + step_ * (made + lost));
}

double Combustion::burn(const FlowGrid& grid, ScalarPlane& cells, Plane* blue) const {
  double total = 0;
  for (int j = 0; j < grid.ny; ++j) {
    float row_total = 0;
    for (int k = grid.at(0, j), end = k + grid.nx; k < end; ++k) {
      if (cells[k][kTemperature] <= kIgnitionLow) continue;
      const float burnt = burn_cell(cells[k]);
      row_total += burnt * kAmbientTemperature / cells[k][kTemperature];
      if (blue) (*blue)[k] += burnt / step_;
    }
    total += static_cast<double>(row_total);
  }
  return total;
}

float Combustion::glow(float temperature) const {
  const float place = (std::min(temperature, kGlowTo) - kGlowFrom) / kGlowStep;
  const int index = static_cast<int>(place);
  return glow_[index] + (place - static_cast<float>(index)) * (glow_[index + 1] - glow_[index]);
}

void Combustion::add_glow(const FlowGrid& grid, const ScalarPlane& cells, Plane& light) const {
  for (int j = 0; j < grid.ny; ++j)
    for (int k = grid.at(0, j), end = k + grid.nx; k < end; ++k)
      if (cells[k][kTemperature] > kGlowFrom && cells[k][kSoot] > 1e-5F)
        light[k] += cells[k][kSoot] * glow(cells[k][kTemperature]);
}

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
