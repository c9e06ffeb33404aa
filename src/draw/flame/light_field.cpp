#include "draw/flame/light_field.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

namespace wisp::drawing {
namespace {

// A Gaussian needs no more than this many grid cells a standard deviation to look smooth, so wide ones are blurred on
// coarse grids: each level halves the one before.
constexpr float kCellsPerSigma = 1.6F;
constexpr int kMaxLevels = 12;

Plane luminance_of(const LightField& field) {
  Plane plane(field.width(), field.height());
  for (std::size_t k = 0; k < plane.values.size(); ++k) {
    plane.values[k] = luminance({field.red.values[k], field.green.values[k], field.blue.values[k]});
  }
  return plane;
}

// Twice the size, bilinear: the inverse placement of halved(). Added to `fine`, scaled.
void add_doubled(const Plane& coarse, Plane& fine) {
  std::vector<float> blend(coarse.width + 2);
  for (int y = 0; y < fine.height; ++y) {
    const int near = y / 2;
    const int far = std::clamp(near + (y % 2 != 0 ? 1 : -1), 0, coarse.height - 1);
    const float* a = coarse.row(near);
    const float* b = coarse.row(far);
    for (int x = 0; x < coarse.width; ++x) blend[x + 1] = 0.75F * a[x] + 0.25F * b[x];
    blend.front() = blend[1];
    blend.back() = blend[coarse.width];
    float* out = fine.row(y);
    for (int x = 0; x + 1 < fine.width; x += 2) {
      const float* middle = blend.data() + x / 2 + 1;
      out[x] += 0.75F * middle[0] + 0.25F * middle[-1];
      out[x + 1] += 0.75F * middle[0] + 0.25F * middle[1];
    }
    if (fine.width % 2 != 0) {
      const float* middle = blend.data() + fine.width / 2 + 1;
      out[fine.width - 1] += 0.75F * middle[0] + 0.25F * middle[-1];
    }
  }
}

std::vector<float> gaussian_kernel(float sigma) {
  const int radius = std::max(1, static_cast<int>(std::ceil(3 * sigma)));
  std::vector<float> kernel(radius + 1);
  float sum = 0;
  for (int k = 0; k <= radius; ++k) {
    kernel[k] = std::exp(-0.5F * static_cast<float>(k * k) / (sigma * sigma));
    sum += k == 0 ? kernel[k] : 2 * kernel[k];
  }
  for (float& weight : kernel) weight /= sum;
  return kernel;
}

Plane blurred(const Plane& plane, float sigma) {
  const std::vector<float> kernel = gaussian_kernel(sigma);
  const int radius = static_cast<int>(kernel.size()) - 1;
  Plane across(plane.width, plane.height);
  std::vector<float> padded(plane.width + 2 * radius);
  for (int y = 0; y < plane.height; ++y) {
    std::copy_n(plane.row(y), plane.width, padded.begin() + radius);
    float* out = across.row(y);
    for (int k = -radius; k <= radius; ++k) {
      const float weight = kernel[std::abs(k)];
      const float* from = padded.data() + radius + k;
      for (int x = 0; x < plane.width; ++x) out[x] += weight * from[x];
    }
  }
  Plane result(plane.width, plane.height);
  for (int y = 0; y < plane.height; ++y) {
    float* out = result.row(y);
    for (int k = std::max(-radius, -y); k <= std::min(radius, plane.height - 1 - y); ++k) {
      const float weight = kernel[std::abs(k)];
      const float* from = across.row(y + k);
      for (int x = 0; x < plane.width; ++x) out[x] += weight * from[x];
    }
  }
  return result;
}

void add_scaled(const Plane& from, float scale, Plane& to) {
  for (std::size_t k = 0; k < from.values.size(); ++k) to.values[k] += scale * from.values[k];
}

int level_of(const HaloRing& ring) {
  const float cells = std::max(1.0F, ring.sigma / kCellsPerSigma);
  return std::clamp(static_cast<int>(std::floor(std::log2(cells))), 0, kMaxLevels);
}

}  // namespace

// Uses the kernel 1-3-3-1 over 8, which keeps the centre in place, so that the halo follows a swaying flame smoothly
// and not from cell to cell.
Plane halved(const Plane& fine) {
  Plane across((fine.width + 1) / 2, fine.height);
  std::vector<float> padded(2 * across.width + 2);
  for (int y = 0; y < fine.height; ++y) {
    std::copy_n(fine.row(y), fine.width, padded.begin() + 1);
    float* out = across.row(y);
    for (int x = 0; x < across.width; ++x) {
      const float* from = padded.data() + 2 * x;
      out[x] = 0.125F * (from[0] + from[3]) + 0.375F * (from[1] + from[2]);
    }
  }
  Plane coarse(across.width, (fine.height + 1) / 2);
  for (int y = 0; y < coarse.height; ++y) {
    float* out = coarse.row(y);
    for (int k = 0; k < 4; ++k) {
      const int from = 2 * y + k - 1;
      if (from < 0 || from >= across.height) continue;
      const float weight = k == 0 || k == 3 ? 0.125F : 0.375F;
      const float* row = across.row(from);
      for (int x = 0; x < across.width; ++x) out[x] += weight * row[x];
    }
  }
  return coarse;
}

// 1/(1 + x + x²/2 + x³/6 + x⁴/24): within 1 % of full scale of e^(−x), and quick.
float transmitted(float light) {
  const float x = light;
  return 1 / (1 + x * (1 + x * (1.0F / 2 + x * (1.0F / 6 + x * (1.0F / 24)))));
}

int finest_level(std::span<const HaloRing> rings) {
  int finest = kMaxLevels;
  for (const HaloRing& ring : rings) finest = std::min(finest, level_of(ring));
  return finest;
}

void add_halo(LightField& field, std::span<const HaloRing> rings) { add_halo(luminance_of(field), rings, field); }

void add_halo(Plane luminance, std::span<const HaloRing> rings, LightField& field) {
  int top = 0;
  for (const HaloRing& ring : rings) top = std::max(top, level_of(ring));
  std::vector<Plane> levels;
  levels.push_back(std::move(luminance));
  while (static_cast<int>(levels.size()) <= top) levels.push_back(halved(levels.back()));

  // From the coarsest grid down, each level's rings are added to the sum of the coarser levels.
  LightField sum(levels.back().width, levels.back().height);
  for (int level = top;; --level) {
    const Plane& plane = levels[level];
    LightField here = level == 0 ? LightField(0, 0) : LightField(plane.width, plane.height);
    LightField& into = level == 0 ? field : here;
    if (level != top) {
      add_doubled(sum.red, into.red);
      add_doubled(sum.green, into.green);
      add_doubled(sum.blue, into.blue);
    }
    for (const HaloRing& ring : rings) {
      if (level_of(ring) != level) continue;
      const Plane soft = blurred(plane, ring.sigma / static_cast<float>(1 << level));
      add_scaled(soft, ring.tint.red, into.red);
      add_scaled(soft, ring.tint.green, into.green);
      add_scaled(soft, ring.tint.blue, into.blue);
    }
    if (level == 0) return;
    sum = std::move(here);
  }
}

void add_light(Image& image, const LightField& field) {
  assert(image.width() == field.width() && image.height() == field.height());
  // A thousandth of the darkest code, which is invisible.
  constexpr float kDarkest = 3e-7F;
  const Tone& tone = Tone::get();
  for (int y = 0; y < image.height(); ++y) {
    const auto pixels = image.row(y);
    const float* red = field.red.row(y);
    const float* green = field.green.row(y);
    const float* blue = field.blue.row(y);
    for (int x = 0; x < image.width(); ++x) {
      if (red[x] + green[x] + blue[x] < kDarkest) continue;
      const std::uint32_t before = pixels[x];
      const float dither = dither_at(x, y);
      const auto lit = [&](int shift, float light) {
        const float there = tone.linear(before >> shift & 0xFFU);
        return dithered(tone.code(1 - (1 - there) * transmitted(light)), dither);
      };
      const std::uint32_t r = lit(16, red[x]);
      const std::uint32_t g = lit(8, green[x]);
      const std::uint32_t b = lit(0, blue[x]);
      // On a transparent picture the opacity is at least the brightest channel.
      const std::uint32_t opacity = std::max({before >> 24, r, g, b});
      pixels[x] = opacity << 24 | r << 16 | g << 8 | b;
    }
  }
}

}  // namespace wisp::drawing
