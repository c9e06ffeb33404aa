#pragma once
// Draws leaves in the air over a floor, from poses: with midrib, two sides, soft shadows and trails.
//
// A leaf is painted once, large and flat; in the air it is a bent card of a few triangles textured with that picture
// and shaded by its attitude. Shadows are soft ellipses, as dark as the leaf blocks light, summed on a coarse grid.
// Hundreds are drawn in a few milliseconds. Poses: from a simulator, model or recording. Equal calls draw equal bytes.

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "wisp/draw/image.hpp"

namespace wisp {

/// Position and attitude of a leaf. Body axes: x along the midrib towards the tip, y across, z out of the upper side.
struct LeafPose {
  std::array<float, 3> position{};            ///< metres, z up; the floor is z = 0
  std::array<float, 4> attitude{1, 0, 0, 0};  ///< quaternion, w first, leaf to world; its norm is ignored
};

/// Shape and colours of leaves.
struct LeafStyle {
  float length = 0.073F;        ///< blade length, metres, 0.001 … 100
  float width = 0.049F;         ///< blade width, metres, 0.001 … 100
  float curl = 1;               ///< 0 is flat, 1 a leaf after a day in the sun, up to 3
  Colour upper{214, 92, 36};    ///< colour between the veins, near the midrib
  Colour margin{150, 38, 24};   ///< colour towards the edge
  Colour under{206, 158, 112};  ///< colour of the underside: paler and dull
  Colour vein{240, 200, 120};   ///< colour of midrib and veins
};

/// Position, direction and zoom of the camera.
struct LeafCamera {
  std::array<float, 3> eye{};     ///< metres
  std::array<float, 3> target{};  ///< point in the middle of the picture, metres
  float view_height = 1.5F;       ///< height of the picture at the target's distance, metres, 0.01 … 1000
};

/// Returns a slightly raised side camera whose picture shows `height` metres above the floor, and the floor below.
LeafCamera leaf_camera_from_side(float height);

/// The room: floor and backdrop.
struct LeafRoom {
  Colour floor{219, 216, 209};
  Colour backdrop{243, 241, 236};
  std::array<float, 3> lamp{-0.35F, -0.45F, 1};  ///< direction towards the light; any length, z > 0
};

/// One leaf of a picture.
struct FlockLeaf {
  LeafPose pose{};
  std::uint8_t look = 0;              ///< which of the flock's five sets of colours, modulo 5; 0: the style's own
  float size = 1;                     ///< scale factor of the style's size, 0.1 … 4
  float opacity = 1;                  ///< opacity of leaf and shadow, 0 … 1
  std::span<const LeafPose> trail{};  ///< past poses, oldest first; drawn as a fading line, none if empty
};

/// Draws leaves in pictures of one size, seen by a fixed camera.
class LeafFlock {
 public:
  /// `style` gives size, curl and the first set of colours; the other sets are those of other weeks of autumn. Style
  /// and camera are clamped to their ranges. Precondition: 1 <= width, height <= kLargestImageSide.
  LeafFlock(int width, int height, const LeafCamera& camera, const LeafStyle& style = {}, const LeafRoom& room = {});

  LeafFlock(LeafFlock&&) noexcept;
  LeafFlock& operator=(LeafFlock&&) noexcept;
  ~LeafFlock();

  /// Draws the room and its leaves over the whole picture, farthest first; a picture of another size is reallocated.
  /// Poses that are not finite, or whose quaternion is 0, are skipped.
  void draw(Image& image, std::span<const FlockLeaf> leaves);

  /// Returns the pixel of a position in the room; nothing if it is behind the camera.
  std::optional<Point> pixel_of(const std::array<float, 3>& place) const;

  /// Returns the pixels per metre at the camera's target.
  float pixels_per_metre() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace wisp
