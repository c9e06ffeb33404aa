#pragma once
// Many leaves at once, for a window: hundreds in a few milliseconds, where draw_leaves() takes its time for each.
//
// A leaf is drawn once, large and flat, by draw_leaves()' own means; in the air it is a bent card of a few triangles
// with that picture on it, lit by how it turns. Shadows are soft ellipses of as much darkness as the leaf takes from
// the lamp, gathered on a coarse grid. The same call draws the same bytes.

#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "wisp/draw/leaf.hpp"

namespace wisp {

/// One leaf of a flock.
struct FlockLeaf {
  LeafPose pose{};
  std::uint8_t look = 0;  ///< which of the flock's colours it has, counted round
  float size = 1;         ///< times the style's, 0.1 … 4
  float opacity = 1;      ///< of leaf and shadow, 0 … 1
};

/// Draws flocks in pictures of one size, from a camera that stands still.
class LeafFlock {
 public:
  /// `style` gives size, curl and the first of the colours; the others are the same leaf in other weeks of autumn.
  ///
  /// Precondition: 1 <= width, height <= kLargestImageSide.
  LeafFlock(int width, int height, const LeafCamera& camera, const LeafStyle& style = {}, const LeafRoom& room = {});

  LeafFlock(LeafFlock&&) noexcept;
  LeafFlock& operator=(LeafFlock&&) noexcept;
  ~LeafFlock();

  /// Draws the room and the leaves in it over all of the picture, which is made anew where it has another size. Poses
  /// that are not finite are left out.
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
