#pragma once
// The cartoon candle: a flame filled from its outline, its glow, its candle, and the smoke of an extinguished one.
//
// Light is summed in linear intensities and shown through one exposure curve, so that glows overlap as real ones do and
// nothing clips. The thickness of the glowing body at each pixel follows from the outline alone (the chord of a body of
// revolution, from a Poisson equation inside the outline), so layers move as smoothly as the outline. The same call
// draws the same bytes.

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

/// How a candle and its flame look. Lengths are in model units: 1 is the mean height of the calm flame.
struct FlameStyle {
  float glow = 1.0F;        ///< strength of the halo, 0 … 4; 0 leaves it out
  float glow_reach = 1.0F;  ///< size of the halo, 0.25 … 4; 1 reaches about one flame height

  bool candle = true;          ///< draw the candle; without it only the flame's light and smoke
  Colour wax{240, 226, 200};   ///< the candle's colour by daylight
  float candle_width = 0.62F;  ///< 0.05 … 4; 22 mm under a flame of 35 mm
};

/// The age of an event that never happened.
inline constexpr float kLongAgo = std::numeric_limits<float>::infinity();

/// Where a candle stands in the picture and what happens to it.
///
/// It burns unless it went out more recently than it was lit. Dying and catching are drawn over a few tenths of a
/// second (keep giving the outline for that long), or by `size`. Smoke rises from the wick until it is lit again, and
/// drifts on afterwards.
struct FlameScene {
  Point base{};                 ///< pixel of the outline's origin, the middle of the flame's base; y down
  float pixels_per_unit = 200;  ///< pixels of the mean flame height, 1 … 10000
  float seconds_since_lit = kLongAgo;
  float seconds_since_out = kLongAgo;
  std::optional<float> size{};  ///< 0 … 1, of a flame whose outline shrinks and grows by itself, as a bank's does
                                ///< (LitState::size); unset: the outline is the full flame's and is scaled by the
                                ///< times above
  float wind = 0;               ///< carries all smoke alike (a slow mean): units a second, to the right, −8 … 8
  std::uint64_t seed = 1;       ///< chooses the smoke's curls and the wick's bend
};

/// Whether the scene's flame burns: it never went out, or was lit since.
bool burns(const FlameScene& scene);

/// Copies a bank's state of a flame into its scene: since when it burns or is out, and its size.
void show_state(const LitState& state, FlameScene& scene);

/// The mean wind since a flame went out, which carries its smoke.
class SmokeDrift {
 public:
  /// Adds the wind of one step of the bank, in the model's units, and sets the scene's wind.
  void blow(float wind, const LitState& state, std::chrono::nanoseconds step_time, FlameScene& scene);

 private:
  float sum_ = 0;
  float count_ = 0;
};

/// A candle of a picture with several: its outline is a polyline in model units (origin at the middle of the base,
/// x right, y up, mean height 1) from the base's left over the tip to the base's right. Its lowest sixth is
/// drawn as a drop around the wick, since a camera's outline there is unreliable.
struct Flame {
  std::span<const Point> outline{};
  FlameScene scene{};
};

/// Draws candles over what the picture holds, the first one farthest: first every candle, lit by all flames, then
/// smoke, then the light of all flames. Points that are not finite are left out; an outline of fewer than three points
/// or without area draws a candle that does not burn. Fields outside their range are clamped to it.
void draw_flames(Image& image, std::span<const Flame> flames, const FlameStyle& style = {});

/// Whether a model is drawn as a flame: it is an outline that can go out, or that stands on its base and tapers
/// upwards, in the middle of its range.
bool is_flame(const Model& model);

/// The style of a model's own candle: wax and width as the film showed them; the default where it showed none.
FlameStyle candle_style(const Model& model);

/// Draws outlines of other things as filled shapes on a plain ground, each at its scene's place. Times, smoke and size
/// are ignored.
void draw_shapes(Image& image, std::span<const Flame> shapes);

/// A scene that frames one candle well in a picture of that size: the flame in the upper middle with room to lean and
/// grow to twice its mean height, the candle standing on the table of LiveFlames' room.
FlameScene framed(int width, int height);

/// Where a camera stands that looks at the base of a flame from afar: degrees anticlockwise round it, from above, from
/// where it was filmed; and degrees above the level, from −80 to 80.
struct Camera {
  double azimuth = 0;
  double elevation = 0;
};

/// The outline of a body in model units, from the base's left over the tip to the base's right: two points a ring. From
/// a level camera it is the outline that the model says; from a raised one the outer edge of its rings.
///
/// Precondition: `rings` are those of one instance (BodyFacet::read_rings()), twice as many points as rings.
void see_body(std::span<const float> rings, const Camera& camera, std::span<Point> outline);

/// How much of a level vector, the wind's x and z, is to the camera's right.
float to_the_right(const Camera& camera, float x, float z);

}  // namespace wisp
