#pragma once
// Objects before a wall in one frame of a film; the wall is estimated from the film's other frames.

#include <cstdint>
#include <span>
#include <vector>

namespace wisp::fall {

/// A reduced luma picture, row by row; empty: the frame is lost.
using Frame = std::vector<std::uint8_t>;

/// The static background, and its variation.
struct Wall {
  int width = 0;
  int height = 0;
  std::vector<float> brightness;  ///< median over the film
  std::vector<float> tolerance;   ///< maximum difference of the background; a larger one is an object
  double noise = 0;               ///< standard deviation of the median pixel, grey levels
  double shake = 0;               ///< RMS shift in reduced pixels; 0 also for a wall without texture
  double unsteady = 0;            ///< share of pixels that change in most frames, which shows a moving camera
};

/// Estimates the wall. Precondition: at least one frame is not empty, and each such has width × height pixels.
Wall wall_of(std::span<const Frame> frames, int width, int height);

/// An object before the wall. Units: pixels of the reduced picture, y down.
struct Thing {
  double x = 0;         ///< centroid
  double y = 0;         ///<
  double area = 0;      ///< covered area in pixels
  double contrast = 0;  ///< difference from the wall, grey levels
  double angle = 0;     ///< of its long axis to the horizontal, anticlockwise, −π/2 to π/2
  double aspect = 1;    ///< length / width
  double left = 0;      ///< bounding box
  double right = 0;     ///<
  double bottom = 0;    ///<
};

/// Objects seen in a frame.
struct Seen {
  std::vector<Thing> things{};  ///< objects that touch no border of the picture
  bool at_border = false;       ///< whether another object touches the border
};

/// Finds the objects of a frame. Precondition: the frame has the wall's size.
Seen seen_in(const Frame& frame, const Wall& wall);

}  // namespace wisp::fall
