#pragma once
// Candles in a dark room, at a window's frame rate: a wall and a table, lit by the flames from where they are, the
// candles' shadows on the table, and a little moonlight; over it the picture of draw_flames(). Dithered, so that video
// does not show steps.
//
// Soft light is computed on a grid of a quarter of the picture's size and interpolated as screen codes where only the
// dark room is behind it; memory and room are reused. At 1280 × 800 that takes a seventh of the time of computing all
// pixels, and none differs by more than a few codes.

#include <memory>
#include <span>

#include "wisp/draw/flame.hpp"

namespace wisp {

/// Draws candles in pictures of one size.
class LiveFlames {
 public:
  /// Precondition: 1 <= width, height <= kLargestImageSide.
  LiveFlames(int width, int height, const FlameStyle& style = {});

  LiveFlames(LiveFlames&&) noexcept;
  LiveFlames& operator=(LiveFlames&&) noexcept;
  ~LiveFlames();

  /// Draws the dark room and the candles in it over all of the picture, the first candle farthest; flames as for
  /// draw_flames(). A picture of another size is reallocated.
  void draw(Image& image, std::span<const Flame> flames);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace wisp
