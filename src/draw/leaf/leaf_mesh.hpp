#pragma once
// The shape of a leaf: a blade with a pointed tip and toothed margins, curled as leaves dry, and its stalk.

#include <vector>

#include "draw/leaf/leaf_view.hpp"

namespace wisp::drawing {

/// A corner of the surface.
struct LeafVertex {
  Vec3 place;          ///< in the leaf's axes, metres
  Vec3 normal;         ///< out of the upper side
  float u = 0, v = 0;  ///< along the midrib, 0 base … 1 tip (below 0: the stalk), and across, −1 … 1
};

struct LeafMesh {
  std::vector<LeafVertex> vertices;
  std::vector<std::array<int, 3>> triangles;
};

/// Fields of the style are clamped to their ranges.
LeafMesh leaf_mesh(const LeafStyle& style);

/// Whether the blade reaches to v at u: its margin has teeth.
bool on_blade(float u, float v);

}  // namespace wisp::drawing
