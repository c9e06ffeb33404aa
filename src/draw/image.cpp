#include "wisp/draw/image.hpp"

#include <algorithm>
#include <cassert>

#include "draw/cairo.hpp"
#include "wisp/base/file.hpp"

namespace wisp {

using namespace drawing;

namespace {

constexpr std::uint32_t kOpaque = 0xFF000000U;

std::uint32_t premultiplied(Colour colour) {
  const auto scaled = [&](std::uint32_t channel) { return (channel * colour.opacity + 127) / 255; };
  return static_cast<std::uint32_t>(colour.opacity) << 24 | scaled(colour.red) << 16 | scaled(colour.green) << 8 |
         scaled(colour.blue);
}

}  // namespace

Image::Image(int width, int height, Colour fill)
    : width_(width), height_(height), pixels_(static_cast<std::size_t>(width) * height, premultiplied(fill)) {
  assert(width >= 1 && height >= 1 && width <= kLargestImageSide && height <= kLargestImageSide);
}

Image Image::from_rgb(std::span<const std::uint8_t> rgb, int width, int height, std::size_t row_bytes) {
  Image image(width, height);
  if (row_bytes == 0) row_bytes = static_cast<std::size_t>(width) * 3;
  assert(rgb.size() >= (height - 1) * row_bytes + static_cast<std::size_t>(width) * 3);
  for (int y = 0; y < height; ++y) {
    const std::uint8_t* from = rgb.data() + y * row_bytes;
    for (std::uint32_t& pixel : image.row(y)) {
      pixel = kOpaque | static_cast<std::uint32_t>(from[0]) << 16 | static_cast<std::uint32_t>(from[1]) << 8 | from[2];
      from += 3;
    }
  }
  return image;
}

Colour Image::at(int x, int y) const {
  const std::uint32_t pixel = row(y)[static_cast<std::size_t>(x)];
  const std::uint32_t opacity = pixel >> 24;
  if (opacity == 0) return {0, 0, 0, 0};
  const auto straight = [&](int shift) {
    const std::uint32_t channel = pixel >> shift & 0xFFU;
    return static_cast<std::uint8_t>(std::min<std::uint32_t>(255, (channel * 255 + opacity / 2) / opacity));
  };
  return {straight(16), straight(8), straight(0), static_cast<std::uint8_t>(opacity)};
}

Image crop(const Image& image, PixelBox box) {
  Image part(box.width, box.height);
  const auto end = [](int begin, int size, int limit) {
    return static_cast<int>(std::min<std::int64_t>(limit, static_cast<std::int64_t>(begin) + size));
  };
  const int first = std::max(0, box.x);
  const int last = end(box.x, box.width, image.width());
  if (first >= last) return part;
  for (int y = std::max(0, box.y); y < end(box.y, box.height, image.height()); ++y) {
    const auto from = image.row(y).subspan(first, last - first);
    std::ranges::copy(from, part.row(y - box.y).begin() + (first - box.x));
  }
  return part;
}

Image resized(const Image& image, int width, int height) {
  assert(!image.empty());
  Image result(width, height, {0, 0, 0, 0});
  Image source = image;
  const CairoSurface surface = surface_of(source);
  const CairoContext context = context_of(result);
  cairo_scale(context.get(), static_cast<double>(width) / image.width(), static_cast<double>(height) / image.height());
  cairo_set_source_surface(context.get(), surface.get(), 0, 0);
  cairo_pattern_set_filter(cairo_get_source(context.get()), CAIRO_FILTER_GOOD);
  cairo_pattern_set_extend(cairo_get_source(context.get()), CAIRO_EXTEND_PAD);
  cairo_paint(context.get());
  return result;
}

Result<void> write_png(const std::filesystem::path& path, const Image& image) {
  if (image.empty()) return Error{path.string() + ": cannot be written: the picture has no pixels"};
  Image source = image;
  const CairoSurface surface = surface_of(source);
  std::string bytes;
  const cairo_status_t status = cairo_surface_write_to_png_stream(surface.get(), append_bytes, &bytes);
  if (status != CAIRO_STATUS_SUCCESS) {
    return Error{path.string() + ": cannot be written as PNG: " + cairo_status_to_string(status)};
  }
  return write_file(path, bytes);
}

}  // namespace wisp
