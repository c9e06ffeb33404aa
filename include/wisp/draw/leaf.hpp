#pragma once
// Leaves in the air over a floor, from poses: shaded, with a midrib, two sides and a soft shadow.
//
// A leaf is a curled surface of triangles, lit by a lamp and by the room; light from behind shines through. Its shadow
// is the same surface seen from the lamp, blurred the more the higher the leaf is. Where it comes from, a simulator, a
// model or a recording, is not the picture's affair. The same call draws the same bytes.

#include <array>
#include <span>

#include "wisp/draw/image.hpp"

namespace wisp {

/// Where a leaf is. Its body's axes: x along the midrib towards the tip, y across, z out of the upper side.
struct LeafPose {
  std::array<float, 3> position{};            ///< metres, z up; the floor is z = 0
  std::array<float, 4> attitude{1, 0, 0, 0};  ///< quaternion, w first, leaf to world; its direction counts
};

/// How a leaf looks.
struct LeafStyle {
  float length = 0.073F;        ///< of the blade, metres, 0.001 … 100
  float width = 0.049F;         ///< metres, 0.001 … 100
  float scale = 1;              ///< drawn this much larger than it is, 0.1 … 20: a leaf in a room is a few pixels
  float curl = 1;               ///< 0 is flat, 1 a leaf that has lain in the sun for a day, up to 3
  Colour upper{214, 92, 36};    ///< between the veins, near the midrib
  Colour margin{150, 38, 24};   ///< towards the edge
  Colour under{206, 158, 112};  ///< the other side: paler and dull
  Colour vein{240, 200, 120};   ///< midrib and veins
};

/// A leaf of the picture, with the way that it came.
struct DrawnLeaf {
  LeafPose pose{};
  LeafStyle style{};
  float opacity = 1;                  ///< of leaf and shadow, 0 … 1
  std::span<const LeafPose> trail{};  ///< oldest first, up to now; drawn as a line that fades, none where empty
};

/// Where the picture is taken from.
struct LeafCamera {
  std::array<float, 3> eye{};     ///< metres
  std::array<float, 3> target{};  ///< what is in the picture's middle
  float view_height = 1.5F;       ///< metres at the target that fill the picture's height, 0.01 … 1000
};

/// From the side, a little from above: `height` metres over the floor fill the picture, the floor in view below.
LeafCamera leaf_camera_from_side(float height);
/// From straight above: x to the right, y up, the given place of the floor in the middle.
LeafCamera leaf_camera_from_above(std::array<float, 3> middle, float view_height);

/// The room: floor and backdrop.
struct LeafRoom {
  Colour floor{219, 216, 209};
  Colour backdrop{243, 241, 236};
  std::array<float, 3> lamp{-0.35F, -0.45F, 1};  ///< towards the light; need not be of length 1, z > 0
};

/// An empty room, to be copied for every frame of a camera that stands still.
///
/// Precondition: 1 <= width, height <= kLargestImageSide.
Image draw_leaf_room(int width, int height, const LeafCamera& camera, const LeafRoom& room = {});

/// Draws leaves, their shadows on the floor and their trails over the picture. What is behind is drawn first.
/// Poses that are not finite are left out; styles and camera are clamped to their ranges.
///
/// Precondition: !image.empty().
void draw_leaves(Image& image, std::span<const DrawnLeaf> leaves, const LeafCamera& camera, const LeafRoom& room = {});

}  // namespace wisp
