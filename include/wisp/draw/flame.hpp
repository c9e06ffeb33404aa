#pragma once
// The cartoon candle: a flame filled from its outline, its glow, its candle, and the smoke of an extinguished one.
//
// Light is summed in linear intensities and mapped through one exposure curve, so that glows overlap as real ones do
// and nothing clips. The thickness of the glowing body at each pixel follows from the outline alone (the chord of a
// body of revolution, from a Poisson equation inside the outline), so layers move as smoothly as the outline. Equal
// calls draw equal bytes.

#include <chrono>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>

#include "wisp/draw/image.hpp"
#include "wisp/run/body_facet.hpp"
#include "wisp/run/extinction_facet.hpp"

namespace wisp {

struct Model;

/// Appearance of a candle and its flame. Lengths are in model units: 1 is the mean height of the calm flame.
struct FlameStyle {
  float glow = 1.0F;        ///< strength of the halo, 0 … 4; 0: no halo
  float glow_reach = 1.0F;  ///< size of the halo, 0.25 … 4; 1 reaches about one flame height

  bool candle = true;          ///< draw the candle; false: only the flame's light and smoke
  Colour wax{240, 226, 200};   ///< the candle's colour in daylight
  float candle_width = 0.62F;  ///< candle width, 0.05 … 4; 22 mm under a flame of 35 mm
};

/// Age of an event that never happened, seconds.
inline constexpr float kLongAgo = std::numeric_limits<float>::infinity();

/// Position and state of one candle in the picture.
///
/// The flame burns unless it was extinguished more recently than lit. Decay and ignition are drawn over a few tenths of
/// a second (keep passing the outline for that long), or by `size`. Smoke rises from the wick until it is relit, and
/// existing smoke then drifts on.
struct FlameScene {
  Point base{};                 ///< pixel of the outline's origin, the middle of the flame's base; y down
  float pixels_per_unit = 200;  ///< pixels per mean flame height, 1 … 10000
  float seconds_since_lit = kLongAgo;
  float seconds_since_out = kLongAgo;
  std::optional<float> size{};  ///< 0 … 1, for a flame whose outline itself shrinks and grows, as a bank's does
                                ///< (LitState::size); unset: the times above scale the full flame's outline
  float wind = 0;               ///< velocity of all smoke (a slow mean): units per second to the right, −8 … 8
  std::uint64_t seed = 1;       ///< seed of the smoke's curls and the wick's bend
};

/// Returns whether the scene's flame burns: never extinguished, or relit since.
bool burns(const FlameScene& scene);

/// Copies a bank's flame state into a scene: the time since it was lit or extinguished, and its size.
void show_state(const LitState& state, FlameScene& scene);

/// A mean of the wind since a flame was extinguished, which advects the flame's smoke.
class SmokeDrift {
 public:
  /// Adds the wind of a step, in the model's units, and sets the scene's wind to 1.5 times the mean since extinction.
  void blow(float wind, const LitState& state, std::chrono::nanoseconds step_time, FlameScene& scene);

 private:
  float sum_ = 0;
  float count_ = 0;
};

/// One candle of a picture: its outline is a polyline in model units (origin at the middle of the base, x right, y up,
/// mean height 1) from the base's left over the tip to the base's right. Its lowest sixth is drawn as a drop around the
/// wick, since a camera's outline there is unreliable.
struct Flame {
  std::span<const Point> outline{};
  FlameScene scene{};
};

/// Draws candles over the existing picture, the first one farthest: first every candle, lit by all flames, then smoke,
/// then the light of all flames. Points that are not finite are skipped; an outline of fewer than three points or
/// without area draws a candle without a flame. Fields outside their range are clamped to it.
void draw_flames(Image& image, std::span<const Flame> flames, const FlameStyle& style = {});

/// Returns whether a model is drawn as a flame: it is an outline that can be extinguished, or that stands on its base
/// and tapers upwards, in the middle of its range.
bool is_flame(const Model& model);

/// Returns the style of a model's own candle: wax and width measured from the film; the default if none was measured.
FlameStyle candle_style(const Model& model);

/// Draws outlines of other objects as filled shapes on a plain ground, each at its scene's position. Times, smoke and
/// size are ignored.
void draw_shapes(Image& image, std::span<const Flame> shapes);

/// Returns a scene that frames one candle in a picture of that size: the flame in the upper middle with room to lean
/// and grow to twice its mean height, the candle standing on the table of LiveFlames' room.
FlameScene framed(int width, int height);

/// Direction of a distant camera that looks at the base of a flame: azimuth in degrees anticlockwise, seen from above,
/// from the filming direction; elevation in degrees above the level, −80 to 80.
struct Camera {
  double azimuth = 0;
  double elevation = 0;
};

/// Computes the outline of a body in model units, from the base's left over the tip to the base's right: two points per
/// ring. A level camera sees each ring's left and right end, at azimuth 0 the model's own outline; a raised one sees
/// the silhouette.
/// Precondition: `rings` are those of one instance (BodyFacet::read_rings()), and `outline` has two points per ring.
void see_body(std::span<const float> rings, const Camera& camera, std::span<Point> outline);

/// Returns how far a level vector, x and z in the wind's axes, points to the camera's right.
float to_the_right(const Camera& camera, float x, float z);

}  // namespace wisp
