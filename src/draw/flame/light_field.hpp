#pragma once
// Linear, unbounded light that is added to a picture, one value a pixel and channel.

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

/// One ring of the halo: its width, and its light for each unit of luminance.
struct HaloRing {
  float sigma = 1;  ///< standard deviation of the Gaussian, pixels
  Light tint;
};

/// Adds the field's own luminance, blurred by each ring's Gaussian and tinted, to the field.
void add_halo(LightField& field, std::span<const HaloRing> rings);

/// The same from a given luminance; `field` may be coarser than a picture.
///
/// Precondition: luminance and field have one size.
void add_halo(Plane luminance, std::span<const HaloRing> rings, LightField& field);

/// Returns the finest grid that the rings need, as a number of halvings of the picture's size.
int finest_level(std::span<const HaloRing> rings);

/// Halves the size in both directions, rounded up, about the middle. Outside is dark.
Plane halved(const Plane& fine);

/// Returns the share of the background that stays visible behind light of that strength, about e^(−light).
float transmitted(float light);

/// Adds the light to the picture by the exposure curve 1 − (1 − there)·e^(−light), approximately. Pixels without light
/// keep their bytes.
///
/// Precondition: the field has the picture's size.
void add_light(Image& image, const LightField& field);

}  // namespace wisp::drawing
