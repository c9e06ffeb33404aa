#pragma once
// 8-bit image planes, borrowed, as input of the vision stage.
//
// Coordinates are in pixels from the top left, y down, with pixel centres at whole numbers: the first pixel covers
// [−0.5, 0.5] in both directions (OpenCV's convention; a drawing library with corners at whole numbers adds 0.5).

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace wisp {

/// One borrowed 8-bit plane, row by row.
struct ImageView {
  const std::uint8_t* pixels = nullptr;
  int width = 0;
  int height = 0;
  std::ptrdiff_t stride = 0;  ///< bytes from one row to the next

  const std::uint8_t* row(int y) const { return pixels + y * stride; }
  std::uint8_t at(int x, int y) const { return row(y)[x]; }
};

/// A rectangle of pixels: columns [x, x + width), rows [y, y + height).
struct Region {
  int x = 0;
  int y = 0;
  int width = 0;
  int height = 0;

  int right() const { return x + width; }
  int bottom() const { return y + height; }
  bool empty() const { return width <= 0 || height <= 0; }
  /// Returns the area in pixels.
  double area() const { return empty() ? 0 : static_cast<double>(width) * height; }
  friend bool operator==(const Region&, const Region&) = default;
};

/// Returns the overlap of two rectangles; empty if they do not overlap.
Region intersection(const Region& a, const Region& b);

/// Returns the smallest rectangle that contains both; an empty rectangle is ignored.
Region enclosing(const Region& a, const Region& b);

/// Returns the rectangle enlarged by `margin` pixels on every side.
Region grown(const Region& region, int margin);

/// Returns a view of an image's part inside `region`, without copying. Precondition: region lies inside the image.
ImageView crop(const ImageView& image, const Region& region);

/// Channel of a picture whose brightness is analysed.
enum class PixelChannel { kLuma, kRed, kGreen, kBlue };

/// Returns "luma", "red", "green" or "blue".
std::string_view channel_name(PixelChannel channel);

/// Returns the channel of that name, or nothing.
std::optional<PixelChannel> channel_from_name(std::string_view name);

/// Side of an object on which it is held, so that its outline is open there.
enum class BaseSide { kBottom, kLeft, kTop, kRight };

/// Number of pixels at each brightness level.
using Histogram = std::array<std::uint64_t, 256>;

}  // namespace wisp
