#include "simulate/candle/diffusion.hpp"

#include <utility>

namespace wisp::flow {
namespace {

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
  // The first stage reads the old values twice over, as both of the stages before it.
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
