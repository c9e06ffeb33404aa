#pragma once
// A leaf's triangles as samples of the picture: which are covered, by what part of the leaf, and by what light.

#include <vector>

#include "draw/leaf/leaf_mesh.hpp"
#include "draw/leaf/leaf_surface.hpp"

namespace wisp::drawing {

/// Light over a part of the picture, with how much of each pixel it covers.
struct LeafPatch {
  int x = 0, y = 0;  ///< its corner in the picture
  int width = 0, height = 0;
  std::vector<Light> light;  ///< premultiplied by the cover
  std::vector<float> cover;  ///< 0 … 1

  bool empty() const { return width <= 0 || height <= 0; }
};

inline constexpr float kLampRadius = 0.10F;  ///< of the lamp over its distance: how soft shadows are
inline constexpr float kDarkest = 0.62F;     ///< of the floor's light that a shadow takes away

/// Whether a leaf is somewhere, and turned somehow.
bool is_drawable(const LeafPose& pose);

/// A mesh placed in the room.
struct PlacedLeaf {
  Vec3 position;
  Turn turn;
};

/// The leaf as the camera sees it, cut to the picture; empty where nothing of it is in view.
LeafPatch leaf_patch(const LeafMesh& mesh, const PlacedLeaf& leaf, const LeafSurface& surface, const LeafView& view,
                     int width, int height);

/// Its shadow on the floor z = 0: only the cover is filled, with `margin` empty pixels around it for a blur.
LeafPatch shadow_patch(const LeafMesh& mesh, const PlacedLeaf& leaf, Vec3 towards_lamp, const LeafView& view, int width,
                       int height, int margin);

}  // namespace wisp::drawing
