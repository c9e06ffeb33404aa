#include "draw/leaf/leaf_view.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace wisp::drawing {
namespace {

constexpr int kSub = 16;  // sub-pixel positions of a corner per pixel
constexpr float kFarthest = 16000;
constexpr std::uint32_t kEven = 0x00FF00FFU;

// Interpolates two channels at a time: a + (b − a) · share / 256.
std::uint32_t between(std::uint32_t a, std::uint32_t b, std::uint32_t share) {
  const std::uint32_t low = (a & kEven) * (256 - share) + (b & kEven) * share;
  const std::uint32_t high = (a >> 8 & kEven) * (256 - share) + (b >> 8 & kEven) * share;
  return (low >> 8 & kEven) | (high & ~kEven);
}

// Returns a bilinear sample of the texture at a position in 256ths of its pixels, from the first pixel's centre.
std::uint32_t sampled(const Texture::Level& texture, int u, int v) {
  const int x = std::clamp(u >> 8, 0, texture.width - 1), y = std::clamp(v >> 8, 0, texture.height - 1);
  const int right = std::min(x + 1, texture.width - 1), below = std::min(y + 1, texture.height - 1);
  const std::uint32_t* top = texture.pixels.data() + static_cast<std::ptrdiff_t>(y) * texture.width;
  const std::uint32_t* bottom = texture.pixels.data() + static_cast<std::ptrdiff_t>(below) * texture.width;
  const auto across = static_cast<std::uint32_t>(u & 255), down = static_cast<std::uint32_t>(v & 255);
  return between(between(top[x], top[right], across), between(bottom[x], bottom[right], across), down);
}

// Blends a premultiplied colour over a pixel; light and opacity in 256ths.
void lay(std::uint32_t& pixel, std::uint32_t colour, std::uint32_t light, std::uint32_t opacity) {
  const std::uint32_t solid = (colour >> 24) * opacity >> 8;
  const std::uint32_t left = 255 - solid;
  const auto channel = [&](int shift) {
    const std::uint32_t own = std::min((colour >> shift & 255U) * light >> 8, colour >> 24) * opacity >> 8;
    return std::min(255U, own + ((pixel >> shift & 255U) * left + 127) / 255);
  };
  const std::uint32_t behind = ((pixel >> 24) * left + 127) / 255;
  pixel = std::min(255U, solid + behind) << 24 | channel(16) << 16 | channel(8) << 8 | channel(0);
}

// Edge function of one side of a triangle, non-negative inside; increases by `right` per pixel, by `down` per row.
struct Side {
  Side(const std::array<int, 2>& p, const std::array<int, 2>& q, int x, int y) {
    const int dx = q[0] - p[0], dy = q[1] - p[1];
    // A pixel centre exactly on the side belongs to the triangle of which it is a left or upper side.
    const bool owns = dy < 0 || (dy == 0 && dx > 0);
    value = static_cast<long long>(dx) * (y - p[1]) - static_cast<long long>(dy) * (x - p[0]) - (owns ? 0 : 1);
    right = -static_cast<long long>(dy) * kSub;
    down = static_cast<long long>(dx) * kSub;
  }
  long long value, right, down;
};

// A quantity that varies linearly over the triangle, at pixel centres.
struct Slope {
  Slope(const TexturedCorner& a, const TexturedCorner& b, const TexturedCorner& c, float va, float vb, float vc) {
    const float area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
    right = ((vb - va) * (c.y - a.y) - (vc - va) * (b.y - a.y)) / area;
    down = ((vc - va) * (b.x - a.x) - (vb - va) * (c.x - a.x)) / area;
    start = va - right * (a.x - 0.5F) - down * (a.y - 0.5F);
  }
  float at(int x, int y) const { return start + right * static_cast<float>(x) + down * static_cast<float>(y); }
  float right, down, start;
};

void fill(Image& image, const TexturedCorner& a, const TexturedCorner& b, const TexturedCorner& c,
          const Texture::Level& texture, std::uint32_t opacity) {
  const auto sub = [](const TexturedCorner& p) {
    return std::array<int, 2>{static_cast<int>(std::lround(p.x * kSub)), static_cast<int>(std::lround(p.y * kSub))};
  };
  const auto pa = sub(a), pb = sub(b), pc = sub(c);
  const int left = std::max(0, std::min({pa[0], pb[0], pc[0]}) / kSub);
  const int right = std::min(image.width() - 1, std::max({pa[0], pb[0], pc[0]}) / kSub);
  const int top = std::max(0, std::min({pa[1], pb[1], pc[1]}) / kSub);
  const int bottom = std::min(image.height() - 1, std::max({pa[1], pb[1], pc[1]}) / kSub);
  if (left > right || top > bottom) return;
  const int x = left * kSub + kSub / 2, y = top * kSub + kSub / 2;
  std::array<Side, 3> sides{Side(pa, pb, x, y), Side(pb, pc, x, y), Side(pc, pa, x, y)};
  const float wide = 256 * static_cast<float>(texture.width), high = 256 * static_cast<float>(texture.height);
  const Slope u(a, b, c, wide * a.u - 128, wide * b.u - 128, wide * c.u - 128);
  const Slope v(a, b, c, high * a.v - 128, high * b.v - 128, high * c.v - 128);
  const Slope light(a, b, c, 256 * a.light, 256 * b.light, 256 * c.light);
  for (int row = top; row <= bottom; ++row) {
    long long s = sides[0].value, t = sides[1].value, r = sides[2].value;
    std::uint32_t* pixels = image.row(row).data();
    for (int column = left; column <= right; ++column) {
      if ((s | t | r) >= 0) {
        const std::uint32_t colour =
            sampled(texture, static_cast<int>(u.at(column, row)), static_cast<int>(v.at(column, row)));
        if (colour != 0) {
          lay(pixels[column], colour, static_cast<std::uint32_t>(std::clamp(light.at(column, row), 0.0F, 1024.0F)),
              opacity);
        }
      }
      s += sides[0].right, t += sides[1].right, r += sides[2].right;
    }
    for (Side& side : sides) side.value += side.down;
  }
}

}  // namespace

Texture texture_of(Texture::Level picture) {
  Texture texture;
  texture.levels.push_back(std::move(picture));
  while (texture.levels.back().width > 4 && texture.levels.back().height > 4) {
    const Texture::Level& fine = texture.levels.back();
    Texture::Level coarse{fine.width / 2, fine.height / 2, {}};
    coarse.pixels.reserve(static_cast<std::size_t>(coarse.width) * coarse.height);
    for (int y = 0; y < coarse.height; ++y) {
      for (int x = 0; x < coarse.width; ++x) {
        const std::uint32_t* from = fine.pixels.data() + static_cast<std::ptrdiff_t>(2 * y) * fine.width + 2 * x;
        coarse.pixels.push_back(
            between(between(from[0], from[1], 128), between(from[fine.width], from[fine.width + 1], 128), 128));
      }
    }
    texture.levels.push_back(std::move(coarse));
  }
  return texture;
}

void draw_textured(Image& image, const TexturedCorner& a, const TexturedCorner& b, const TexturedCorner& c,
                   const Texture::Level& texture, float opacity) {
  for (const TexturedCorner* corner : {&a, &b, &c}) {
    if (!(std::abs(corner->x) < kFarthest && std::abs(corner->y) < kFarthest)) return;
  }
  const float twice_area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
  if (!(std::abs(twice_area) > 1e-3F)) return;
  const auto solid = static_cast<std::uint32_t>(std::lround(256 * std::clamp(opacity, 0.0F, 1.0F)));
  if (solid == 0) return;
  if (twice_area > 0) {
    fill(image, a, b, c, texture, solid);
  } else {
    fill(image, a, c, b, texture, solid);
  }
}

}  // namespace wisp::drawing
