#pragma once
// The room in which candles stand: a wall and a table, lit by the flames from where they are, and a little by the moon.

#include <span>
#include <vector>

#include "draw/flame/candle.hpp"
#include "draw/flame/light_field.hpp"

namespace wisp::drawing {

/// A flame, and the candle under it that shades the table.
struct Stand {
  Lamp lamp;
  Point foot;        ///< pixel of the middle of the candle's foot, on the table
  float unit = 1;    ///< pixels of the mean flame height
  float half = 0;    ///< half the candle's width, model units
  float height = 0;  ///< of the candle, model units; 0: there is none
};

Stand stand_of(const FlameScene& scene, const FlameStyle& style, const Lamp& lamp);

class Room {
 public:
  /// Of a picture of that size, on its cells (draw/flame/cells.hpp).
  Room(int width, int height);

  /// Light that the room sends to the eye, in cells.
  const LightField& lit(std::span<const Stand> stands);

 private:
  void light_wall(std::span<const Stand> stands);
  void light_table(const Stand& stand);

  int width_, height_;
  LightField wood_;  // how much of a flame's light comes back
  LightField moon_;  // what is there without flames
  Plane flames_;     // light of all flames, on a grid twice as coarse
  LightField light_;
};

}  // namespace wisp::drawing
