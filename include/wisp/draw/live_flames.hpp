#pragma once
// Candles in a dark room, at a window's frame rate: wall and table lit by the flames, the candles' shadows on the
// table, and a little moonlight, overlaid with the picture of draw_flames(). Dithered against banding in video.
//
// Soft light is computed on a grid of a quarter of the picture's width and height and, over the plain dark room,
// interpolated in screen codes; memory and room are reused. At 1280 × 800 that takes a seventh of the time of computing
// all pixels, and no pixel differs by more than a few codes.

#include <memory>
#include <span>

#include "wisp/draw/flame.hpp"

namespace wisp {

/// Draws candles in pictures of one size.
class LiveFlames {
 public:
  /// Creates the room. Precondition: 1 <= width, height <= kLargestImageSide.
  LiveFlames(int width, int height, const FlameStyle& style = {});

  LiveFlames(LiveFlames&&) noexcept;
  LiveFlames& operator=(LiveFlames&&) noexcept;
  ~LiveFlames();

  /// Draws the dark room and its candles over the whole picture, the first candle farthest; flames as in draw_flames().
  /// A picture of another size is reallocated.
  void draw(Image& image, std::span<const Flame> flames);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace wisp
