#pragma once
// A marker-and-cell grid: scalars at cell centres, velocity on cell faces, in one common padded layout.
//
// Source: F. Harlow & J. Welch, Phys. Fluids 8 (1965) 2182.

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
/// and below and of at least two on the right and above, so that one index serves all and no stencil needs a test.
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

}  // namespace wisp::flow
