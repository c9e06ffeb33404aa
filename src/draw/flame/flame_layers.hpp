#pragma once
// The layers of a picture of candles: flame, wick, wax, smoke and glow. draw_flames() and LiveFlames compose them.

#include <array>
#include <span>

#include "draw/flame/light_field.hpp"
#include "wisp/draw/flame.hpp"

namespace wisp::drawing {

/// A flame laid over a picture. Positions are the picture's pixels; `thickness` and `coverage` hold only the box.
struct FlameShape {
  PixelBox box;        ///< the part of the picture that the flame touches; zero width: there is no flame
  Plane coverage;      ///< share of each pixel inside the outline, 0 … 1
  Plane thickness;     ///< half the chord of glowing gas behind each pixel, in model units
  float thickest = 0;  ///< its largest value
  Point base;          ///< middle of the outline's base
  Point middle;        ///< centre of its light
  float reach = 0;     ///< pixels from the base to the farthest point
  float height = 0;    ///< the same in model units
  float area = 0;      ///< in square model units

  bool empty() const { return box.width == 0; }
};

/// Returns the measures of an outline without rasterising it: base, middle, reach, height and area.
FlameShape measured_shape(std::span<const Point> outline, const FlameScene& scene, float scale);

/// Rasterises an outline (model units), scaled by `scale` about its base. Points that are not finite are left out; the
/// base is drawn as a drop around the wick, down to `cap` units under the base's middle.
FlameShape flame_shape(std::span<const Point> outline, const FlameScene& scene, float scale, float cap, int width,
                       int height);

/// Brightness and colour of a whole flame.
struct FlameMood {
  float brightness = 1;
  float soot = 1;  ///< 0: blue gas only (re-ignition, decay, tiny), 1: a full yellow flame
};

/// A short, bent, tapering cord between the candle and the flame, laid over a picture.
struct Wick {
  PixelBox box;     ///< the part of the picture that it touches; zero width: none
  Plane coverage;   ///< share of each pixel of the box inside it
  Point root;       ///< where it leaves the wax, pixels
  Point end;        ///< its upper end, pixels
  float width = 0;  ///< pixels, at its root

  bool empty() const { return box.width == 0; }
};

Wick make_wick(const FlameScene& scene, const FlameStyle& style, int width, int height);

/// The wick's coverage at a pixel of the picture; 0 outside its box.
float wick_at(const Wick& wick, int x, int y);

/// A flame as a source of light for other candles, smoke and the room.
struct Lamp {
  Point place;      ///< pixel of its middle
  float power = 0;  ///< light relative to a calm flame's
};

/// Draws a candle (wax that lets light through, a melted pool, the wick) lit by its own flame and by the others.
///
/// Precondition: the fields of scene and style are in their ranges.
void draw_candle(Image& image, const FlameScene& scene, const FlameStyle& style, const Wick& wick, const Lamp& own,
                 std::span<const Lamp> others);

/// Draws the smoke that left the wick since the flame went out, lit by the room and by the lamps: a ribbon that rises
/// straight, then folds and curls as it slows and spreads. Draws nothing once all smoke has gone.
///
/// Precondition: the scene's fields are in their ranges.
void draw_smoke(Image& image, const FlameScene& scene, Point wick_end, std::span<const Lamp> lamps);

/// Everything that is known of one candle before drawing.
struct Candle {
  FlameScene scene;
  FlameShape shape;
  FlameMood mood;
  Wick wick;
  Lamp lamp;
};

/// Returns the style with its fields clamped to their ranges.
FlameStyle clamped(FlameStyle style);

/// Lays a flame over a picture of that size. Precondition: the style is in its ranges.
Candle prepared(const Flame& flame, const FlameStyle& style, int width, int height);

/// Returns the flame as a light source without rasterising it.
Lamp lamp_of(const Flame& flame);

/// Returns the pixels of the largest model unit among the candles, at least 1.
float largest_unit(std::span<const Candle> candles);

/// Draws every candle, lit by all flames, then all smoke.
void draw_behind(Image& image, std::span<const Candle> candles, const FlameStyle& style);

/// Adds the light of a candle's flame, dimmed by its wick, and of its ember.
void add_own_light(LightField& field, const Candle& candle, const FlameStyle& style);

/// Returns the rings of the glow around flames whose model unit is `unit` pixels.
std::array<HaloRing, 4> glow_rings(const FlameStyle& style, float unit);

}  // namespace wisp::drawing
