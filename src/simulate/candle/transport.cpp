#include "simulate/candle/flow_equations.hpp"

#include <algorithm>
#include <utility>

namespace wisp::flow {
namespace {

// Bilinear interpolation position: index of the lower left value and the weights of its right and upper neighbours.
struct Place {
  int index;
  float right;
  float up;
};

// Clamps x and y to [lowest, highest]; NaN becomes the lower limit, so that every index is in the grid.
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

// to = mu · from + nu · to + rate · scale · L(from), over rows of elements of one float or of four.
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
  // The first stage reads the initial values as both of its predecessors.
  stage(grid, d, scale, 1.0F, 0.0F, width * lanes, values.data(), scratch.data());
  for (int j = 2; j <= stages; ++j) {
    const auto order = static_cast<float>(j);
    const float mu = (2.0F * order - 1.0F) / order;
    stage(grid, d, scale, mu, (1.0F - order) / order, mu * width * lanes, scratch.data(), values.data());
    std::swap(values, scratch);
  }
  std::swap(values, scratch);
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
  // Fuel decays for ever, down to denormal numbers, which are a hundred times slower than others. Negligible values are
  // rounded to zero.
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

}  // namespace wisp::flow
