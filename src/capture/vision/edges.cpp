#include "capture/vision/edges.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "capture/vision/region.hpp"

namespace wisp {
namespace {

struct Gradient {
  double x = 0;
  double y = 0;
};

// Sobel's operator, the picture continued beyond its border by its border.
Gradient sobel(const ImageView& image, int x, int y) {
  const int left = std::max(x - 1, 0), right = std::min(x + 1, image.width - 1);
  const std::uint8_t* above = image.row(std::max(y - 1, 0));
  const std::uint8_t* here = image.row(y);
  const std::uint8_t* below = image.row(std::min(y + 1, image.height - 1));
  const int gx = above[right] + 2 * here[right] + below[right] - above[left] - 2 * here[left] - below[left];
  const int gy = below[left] + 2 * below[x] + below[right] - above[left] - 2 * above[x] - above[right];
  return {static_cast<double>(gx), static_cast<double>(gy)};
}

double bilinear(const ImageView& image, double x, double y) {
  x = std::clamp(x, 0.0, image.width - 1.0);
  y = std::clamp(y, 0.0, image.height - 1.0);
  const int x0 = std::min(static_cast<int>(x), std::max(image.width - 2, 0));
  const int y0 = std::min(static_cast<int>(y), std::max(image.height - 2, 0));
  const int x1 = std::min(x0 + 1, image.width - 1), y1 = std::min(y0 + 1, image.height - 1);
  const double fx = x - x0, fy = y - y0;
  const double top = image.at(x0, y0) + fx * (image.at(x1, y0) - image.at(x0, y0));
  const double low = image.at(x0, y1) + fx * (image.at(x1, y1) - image.at(x0, y1));
  return top + fy * (low - top);
}

// A bright pixel on the picture's border: the outline runs along the border itself.
EdgePoint border_edge(const ImageView& image, PixelPosition pixel) {
  EdgePoint edge{static_cast<double>(pixel.x), static_cast<double>(pixel.y), 0, 0};
  if (pixel.x == 0) edge.normal_x = -1;
  if (pixel.x == image.width - 1) edge.normal_x = 1;
  if (edge.normal_x == 0) edge.normal_y = pixel.y == 0 ? -1 : 1;
  edge.x += 0.5 * edge.normal_x;
  edge.y += 0.5 * edge.normal_y;
  return edge;
}

bool on_border(const ImageView& image, PixelPosition pixel) {
  return pixel.x == 0 || pixel.y == 0 || pixel.x == image.width - 1 || pixel.y == image.height - 1;
}

}  // namespace

EdgePoint locate_edge(const ImageView& image, int level, PixelPosition pixel) {
  assert(image.at(pixel.x, pixel.y) > level);
  // A diagonal neighbour that is dark lies √2 away, and the gradient's direction is not quite the profile's.
  constexpr double kStep = 0.75;
  constexpr int kSteps = 3;
  const double target = level + 0.5;
  const Gradient gradient = sobel(image, pixel.x, pixel.y);
  const double size = length(gradient.x, gradient.y);
  if (size == 0) return border_edge(image, pixel);
  const double nx = -gradient.x / size, ny = -gradient.y / size;
  double before = image.at(pixel.x, pixel.y);
  for (int k = 1; k <= kSteps; ++k) {
    const double after = bilinear(image, pixel.x + nx * kStep * k, pixel.y + ny * kStep * k);
    if (after < target) {
      const double along = kStep * (k - 1 + (before - target) / (before - after));
      return {pixel.x + nx * along, pixel.y + ny * along, nx, ny};
    }
    before = after;
  }
  if (on_border(image, pixel)) return border_edge(image, pixel);
  return {pixel.x + 0.5 * nx, pixel.y + 0.5 * ny, nx, ny};
}

}  // namespace wisp
