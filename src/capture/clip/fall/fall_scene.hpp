#pragma once
// What stands before a wall in one frame of a film: the wall is known from the film's other frames.

#include <cstdint>
#include <span>
#include <vector>

namespace wisp::fall {

/// A small luma picture, row by row; empty: the frame is lost.
using Frame = std::vector<std::uint8_t>;

/// What does not move, and how much it changes nevertheless.
struct Wall {
  int width = 0;
  int height = 0;
  std::vector<float> brightness;  ///< median of the film
  std::vector<float> tolerance;   ///< what differs by more is something else
  double noise = 0;               ///< standard deviation of the median pixel, grey levels
  double shake = 0;     ///< small pixels by which it stands off, root mean square; 0 too where it has no marks
  double unsteady = 0;  ///< share of pixels that change in most of the film: a camera that shakes
};

/// Precondition: every frame that is not empty has width × height pixels, and one is not empty.
Wall wall_of(std::span<const Frame> frames, int width, int height);

/// Something that stands before the wall. Pixels of the small picture, y down.
struct Thing {
  double x = 0;         ///< its middle
  double y = 0;         ///<
  double area = 0;      ///< pixels that it covers
  double contrast = 0;  ///< how far it differs from the wall, grey levels
  double angle = 0;     ///< of its long axis against the picture's lower border, anticlockwise, −π/2 to π/2
  double aspect = 1;    ///< how many times as long as it is wide
  double left = 0;      ///< its box
  double right = 0;     ///<
  double bottom = 0;    ///<
};

/// What is seen in a frame.
struct Seen {
  std::vector<Thing> things{};  ///< that touch no border of the picture
  bool at_border = false;       ///< something else does
};

/// Precondition: the frame has the wall's size.
Seen seen_in(const Frame& frame, const Wall& wall);

}  // namespace wisp::fall
