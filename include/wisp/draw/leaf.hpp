#pragma once
// Leaves in the air over a floor, from poses: with a midrib, two sides, soft shadows and the way that they came.
//
// A leaf is painted once, large and flat; in the air it is a bent card of a few triangles with that picture on it, lit
// by how it turns. Shadows are soft ellipses of as much darkness as the leaf takes from the lamp, gathered on a coarse
// grid. So hundreds are drawn in a few milliseconds. Where poses come from, a simulator, a model or a recording, is not
// the picture's affair. The same call draws the same bytes.

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "wisp/draw/image.hpp"

namespace wisp {

/// Where a leaf is. Its body's axes: x along the midrib towards the tip, y across, z out of the upper side.
struct LeafPose {
  std::array<float, 3> position{};            ///< metres, z up; the floor is z = 0
  std::array<float, 4> attitude{1, 0, 0, 0};  ///< quaternion, w first, leaf to world; its direction counts
};

/// How leaves look.
struct LeafStyle {
  float length = 0.073F;        ///< of the blade, metres, 0.001 … 100
  float width = 0.049F;         ///< metres, 0.001 … 100
  float curl = 1;               ///< 0 is flat, 1 a leaf that has lain in the sun for a day, up to 3
  Colour upper{214, 92, 36};    ///< between the veins, near the midrib
  Colour margin{150, 38, 24};   ///< towards the edge
  Colour under{206, 158, 112};  ///< the other side: paler and dull
  Colour vein{240, 200, 120};   ///< midrib and veins
};

/// Where the picture is taken from.
struct LeafCamera {
  std::array<float, 3> eye{};     ///< metres
  std::array<float, 3> target{};  ///< what is in the picture's middle
  float view_height = 1.5F;       ///< metres at the target that fill the picture's height, 0.01 … 1000
};

/// From the side, a little from above: `height` metres over the floor fill the picture, the floor in view below.
LeafCamera leaf_camera_from_side(float height);

/// The room: floor and backdrop.
struct LeafRoom {
  Colour floor{219, 216, 209};
  Colour backdrop{243, 241, 236};
  std::array<float, 3> lamp{-0.35F, -0.45F, 1};  ///< towards the light; need not be of length 1, z > 0
};

/// One leaf of a picture.
struct FlockLeaf {
  LeafPose pose{};
  std::uint8_t look = 0;              ///< which of the flock's colours it has, counted round
  float size = 1;                     ///< times the style's, 0.1 … 4
  float opacity = 1;                  ///< of leaf and shadow, 0 … 1
  std::span<const LeafPose> trail{};  ///< oldest first, up to now; drawn as a line that fades, none where empty
};

/// Draws leaves in pictures of one size, from a camera that stands still.
class LeafFlock {
 public:
  /// `style` gives size, curl and the first of the colours; the others are the same leaf in other weeks of autumn.
  /// Style and camera are clamped to their ranges.
  ///
  /// Precondition: 1 <= width, height <= kLargestImageSide.
  LeafFlock(int width, int height, const LeafCamera& camera, const LeafStyle& style = {}, const LeafRoom& room = {});

  LeafFlock(LeafFlock&&) noexcept;
  LeafFlock& operator=(LeafFlock&&) noexcept;
  ~LeafFlock();

  /// Draws the room and the leaves in it over all of the picture, which is made anew where it has another size; what is
  /// behind is drawn first. Poses that are not finite are left out.
  void draw(Image& image, std::span<const FlockLeaf> leaves);

  /// Where a place of the room is in the picture; nothing where it is behind the camera.
  std::optional<Point> pixel_of(const std::array<float, 3>& place) const;

  /// Pixels of one metre at the camera's target.
  float pixels_per_metre() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace wisp
