#pragma once
// The dark room in which candles stand: a wall and a table, lit by the flames and a little by the moon. Soft light is
// computed on a grid of cells of 4 × 4 pixels and interpolated, a sixteenth of the work.

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "draw/flame/flame_layers.hpp"

namespace wisp::drawing {

inline constexpr int kHalvings = 2;
inline constexpr int kCell = 1 << kHalvings;

inline int cells(int pixels) { return (pixels + kCell - 1) / kCell; }

/// Interpolation position of a picture's row between two rows of the grid.
struct Between {
  Between(int pixel, int count) {
    const float at = (static_cast<float>(pixel) + 0.5F) / kCell - 0.5F;
    const int below = static_cast<int>(std::floor(at));
    share = at - static_cast<float>(below);
    first = std::clamp(below, 0, count - 1);
    second = std::clamp(below + 1, 0, count - 1);
  }
  int first = 0, second = 0;
  float share = 0;
};

/// The three channels of a row of a picture, with a margin for groups of pixels that extend over the edges.
struct Row {
  explicit Row(int width) {
    for (auto& channel : channels) channel.resize(static_cast<std::size_t>(width) + 2 * kCell);
  }
  const float* operator[](int channel) const { return channels[channel].data() + kCell / 2; }
  std::array<std::vector<float>, 3> channels;
};

/// Spreads a row of cells over pixels, linear between the middles of cells. `scratch` has two values more than the grid
/// has columns.
void spread(const LightField& grid, const Between& y, std::vector<float>& scratch, Row& row, int width);

/// Writes codes with their fraction as pixels, rounded by `dither`.
void write_codes(const Row& codes, const float* dither, std::uint32_t* out, int first, int last);

/// A flame and its candle, which shades the table.
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
  /// Of a picture of that size.
  Room(int width, int height);

  /// Returns the light from the room, in cells.
  const LightField& lit(std::span<const Stand> stands);

 private:
  void light_wall(std::span<const Stand> stands);
  void light_table(const Stand& stand);

  int width_, height_;
  LightField wood_;  // reflectance for a flame's light
  LightField moon_;  // light without flames
  Plane flames_;     // light of all flames, on a grid twice as coarse
  LightField light_;
};

}  // namespace wisp::drawing
