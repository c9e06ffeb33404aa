#pragma once
// Light to be added to a picture: linear, unbounded, one value a pixel and channel.

#include <span>
#include <vector>

#include "draw/tone.hpp"
#include "wisp/draw/image.hpp"

namespace wisp::drawing {

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

/// Emission over the pixels of a picture.
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

/// One ring of the halo: how wide, and what light it spreads for each unit of luminance.
struct HaloRing {
  float sigma = 1;  ///< standard deviation of the Gaussian, pixels
  Light tint;
};

/// Adds the field's own luminance, blurred by each ring's Gaussian and tinted, to the field.
void add_halo(LightField& field, std::span<const HaloRing> rings);

/// The same from a luminance that is already there, added to `field`, which may be coarser than a picture.
///
/// Precondition: luminance and field have one size.
void add_halo(Plane luminance, std::span<const HaloRing> rings, LightField& field);

/// The finest grid that the rings need, as halvings of the picture's: they are as smooth on it as on the picture's own.
int finest_level(std::span<const HaloRing> rings);

/// Half the size in both directions, rounded up; its middle stays in place. What lies outside is dark.
Plane halved(const Plane& fine);

/// What light of that strength leaves of what is behind it: e^(−light) or nearly so.
float transmitted(float light);

/// Shows the light on the picture: what is there already is seen through the film's curve, 1 − (1 − there)·e^(−light)
/// or nearly so. Pixels that get no light keep their bytes.
///
/// Precondition: the field has the picture's size.
void add_light(Image& image, const LightField& field);

}  // namespace wisp::drawing
