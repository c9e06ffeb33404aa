#pragma once
// The layers of a picture of candles, which draw_flames() and LiveFlames compose: flame, wick, wax, smoke and glow.
// Emitted light (LightField) is linear and unbounded, one value per pixel and channel. Room is the dark room in which
// candles stand: a wall and a table, lit by the flames and a little by the moon. Soft light is computed on a grid of
// cells of 4 × 4 pixels and interpolated, a sixteenth of the work.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "draw/tone.hpp"
#include "wisp/draw/flame.hpp"
#include "wisp/draw/image.hpp"

namespace wisp::drawing {

inline constexpr Colour kCore{255, 248, 224};  ///< the bright middle, where the glow is thickest
inline constexpr Colour kBody{255, 196, 74};   ///< soot at about 1800 K seen through a camera
inline constexpr Colour kRim{255, 134, 30};  ///< the translucent outer layer and the tip, where soot is thin and cooler
inline constexpr Colour kBase{84, 168, 255};  ///< the blue of burning gas without soot, around the base
inline constexpr Colour kHalo{255, 140, 52};  ///< light scattered in the air and the lens around the flame

// Lengths are in model units.
inline constexpr float kCandleHeight = 0.95F;  ///< candle height; the part below the picture is cut off
inline constexpr float kWickGap = 0.12F;       ///< distance from the candle's top to the flame's base
inline constexpr float kWickHeight = 0.24F;    ///< distance from the candle's top to the wick's end
inline constexpr float kAmbient = 0.06F;       ///< room light on the candle, which keeps it visible without a flame

/// Returns a number in [0, 1) for a seed and an index (the finaliser of SplitMix64; G. Steele, D. Lea, C. Flood 2014).
inline float random_at(std::uint64_t seed, std::uint64_t index) {
  std::uint64_t z = seed + 0x9E3779B97F4A7C15U * (index + 1);
  z = (z ^ z >> 30) * 0xBF58476D1CE4E5B9U;
  z = (z ^ z >> 27) * 0x94D049BB133111EBU;
  return static_cast<float>((z ^ z >> 31) >> 40) / 16777216.0F;
}

/// One channel of floats over a grid.
struct Plane {
  Plane() = default;
  Plane(int columns, int rows) : width(columns), height(rows), values(static_cast<std::size_t>(columns) * rows) {}

  float* row(int y) { return values.data() + static_cast<std::size_t>(y) * width; }
  const float* row(int y) const { return values.data() + static_cast<std::size_t>(y) * width; }

  int width = 0;
  int height = 0;
  std::vector<float> values;
};

/// Returns the share of each cell of a grid inside a polygon whose coordinates are cells; `fine`: best antialiasing.
Plane coverage_of(std::span<const Point> polygon, int columns, int rows, bool fine);

/// Bounding box of points, pixels.
struct Bounds {
  float left = 0, top = 0, right = 0, bottom = 0;
  float width() const { return right - left; }
  float height() const { return bottom - top; }
};

/// Returns the bounding box of points. Precondition: at least one point.
Bounds bounds_of(std::span<const Point> points);

/// Returns the pixels of a picture within bounds, extended by `margin` on each side; zero width: none.
PixelBox visible_box(const Bounds& bounds, int margin, int width, int height);

struct LightField {
  LightField(int width, int height) : red(width, height), green(width, height), blue(width, height) {}

  int width() const { return red.width; }
  int height() const { return red.height; }
  void add(int x, int y, Light light) {
    red.row(y)[x] += light.red;
    green.row(y)[x] += light.green;
    blue.row(y)[x] += light.blue;
  }

  Plane red;
  Plane green;
  Plane blue;
};

/// Returns the luminance of a part of a field.
Plane luminance_in(const LightField& field, PixelBox box);

/// One ring of the halo: its width, and its light for each unit of luminance.
struct HaloRing {
  float sigma = 1;  ///< standard deviation of the Gaussian, pixels
  Light tint;
};

/// Adds the field's own luminance, blurred by each ring's Gaussian and tinted, to the field.
void add_halo(LightField& field, std::span<const HaloRing> rings);

/// Adds a halo computed from a given luminance of the size of `field`, which may be coarser than the picture.
void add_halo(Plane luminance, std::span<const HaloRing> rings, LightField& field);

/// Returns the finest grid that the rings need, as a number of halvings of the picture's size.
int finest_level(std::span<const HaloRing> rings);

/// Returns the plane at half its width and height, rounded up. The plane counts as dark beyond its edges.
Plane halved(const Plane& fine);

/// Returns the share of the background visible through light of that strength, about e^(−light).
float transmitted(float light);

/// Adds the light to the picture by the exposure curve 1 − (1 − p)·e^(−light), approximately, with p the pixel's value.
/// Pixels without light keep their bytes. Precondition: the field has the picture's size.
void add_light(Image& image, const LightField& field);

/// A flame rasterised over a picture, in its pixels; `thickness` and `coverage` hold only the box.
struct FlameShape {
  PixelBox box;        ///< the part of the picture that the flame touches; zero width: there is no flame
  Plane coverage;      ///< share of each pixel inside the outline, 0 … 1
  Plane thickness;     ///< half the chord of glowing gas behind each pixel, in model units
  float thickest = 0;  ///< maximum of thickness
  Point base;          ///< middle of the outline's base, pixels
  Point middle;        ///< mean of the outline's points, pixels: where the flame's light comes from
  float reach = 0;     ///< distance in pixels from the base to the farthest point
  float height = 0;    ///< reach in model units
  float area = 0;      ///< area in square model units

  bool empty() const { return box.width == 0; }
};

/// Rasterises an outline (model units), scaled by `scale` about the origin. Points that are not finite are left out;
/// the base is drawn as a drop around the wick, down to `cap` units under the base's middle.
FlameShape flame_shape(std::span<const Point> outline, const FlameScene& scene, float scale, float cap, int width,
                       int height);

struct FlameMood {
  float brightness = 1;
  float soot = 1;  ///< 0: blue gas only (re-ignition, decay, tiny), 1: a full yellow flame
};

/// The wick, a short, bent, tapering cord between candle and flame, rasterised over a picture.
struct Wick {
  PixelBox box;     ///< part of the picture that the wick touches; zero width: no wick
  Plane coverage;   ///< share of each pixel of the box inside the wick
  Point root;       ///< where the wick leaves the wax, pixels
  Point end;        ///< upper end, pixels
  float width = 0;  ///< width at the root, pixels

  bool empty() const { return box.width == 0; }
};

Wick make_wick(const FlameScene& scene, int width, int height);

/// Returns the wick's coverage at a pixel of the picture; 0 outside the wick's box.
float wick_at(const Wick& wick, int x, int y);

/// A flame as a source of light for other candles, smoke and the room.
struct Lamp {
  Point place;      ///< pixel of the centre of the light
  float power = 0;  ///< light relative to a calm flame's
};

/// Draws a candle (wax that lets light through, a melted pool, the wick) lit by its own flame and by the others.
/// Precondition: the fields of scene and style are in their ranges.
void draw_candle(Image& image, const FlameScene& scene, const FlameStyle& style, const Wick& wick, const Lamp& own,
                 std::span<const Lamp> others);

/// Draws the smoke of an extinguished wick, lit by room and lamps: a ribbon that rises straight, then folds and curls
/// as it slows and spreads; nothing once all smoke has gone. Precondition: the scene's fields are in range.
void draw_smoke(Image& image, const FlameScene& scene, Point wick_end, std::span<const Lamp> lamps);

/// Data of one candle, computed before drawing.
struct Candle {
  FlameScene scene;
  FlameShape shape;
  FlameMood mood;
  Wick wick;
  Lamp lamp;
};

FlameStyle clamped(FlameStyle style);

/// Rasterises a flame for a picture of that size.
Candle prepared(const Flame& flame, int width, int height);

/// Returns the largest pixels_per_unit among the candles, at least 1.
float largest_unit(std::span<const Candle> candles);

/// Draws every candle, lit by all flames, then all smoke.
void draw_behind(Image& image, std::span<const Candle> candles, const FlameStyle& style);

/// Adds the light of a candle's flame, dimmed by its wick, and of its ember.
void add_own_light(LightField& field, const Candle& candle, const FlameStyle& style);

/// Returns the rings of the glow around flames whose model unit is `unit` pixels.
std::array<HaloRing, 4> glow_rings(const FlameStyle& style, float unit);

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

/// Interpolates a row of cells linearly between cell centres to pixels; `scratch` has the grid's columns + 2 values.
void spread(const LightField& grid, const Between& y, std::vector<float>& scratch, Row& row, int width);

/// Writes fractional screen codes of the pixels [first, last), rounded by `dither`.
void write_codes(const Row& codes, const float* dither, std::uint32_t* out, int first, int last);

/// A flame and its candle, which casts a shadow on the table.
struct Stand {
  Lamp lamp;
  Point foot;        ///< pixel of the centre of the candle's foot, on the table
  float unit = 1;    ///< mean flame height in pixels
  float half = 0;    ///< half the candle's width, model units
  float height = 0;  ///< candle height, model units; 0: no candle
};

Stand stand_of(const FlameScene& scene, const FlameStyle& style, const Lamp& lamp);

class Room {
 public:
  Room(int width, int height);

  /// Returns the light that each cell of the room sends to the eye, lit by the flames and the moon.
  const LightField& lit(std::span<const Stand> stands);

 private:
  void light_wall(std::span<const Stand> stands);
  void light_table(const Stand& stand);

  int width_, height_;
  LightField wood_;  // reflectance of wall and table for a flame's light
  LightField moon_;  // light of wall and table without flames
  Plane flames_;     // light of all flames that arrives there, on a grid twice as coarse
  LightField light_;
};

}  // namespace wisp::drawing
