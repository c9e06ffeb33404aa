#pragma once
// Pictures as the vision stage sees them: borrowed 8-bit planes, nothing more.
//
// Coordinates are in pixels from the top left, y down, and a pixel's centre is at whole numbers: the first pixel covers
// [−0.5, 0.5] in both directions (as OpenCV counts; a drawing library that puts corners at whole numbers adds 0.5).

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

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
  /// Pixels.
  double area() const { return empty() ? 0 : static_cast<double>(width) * height; }
  friend bool operator==(const Region&, const Region&) = default;
};

/// What two rectangles share; empty where they share nothing.
Region intersection(const Region& a, const Region& b);

/// The smallest rectangle around both; an empty one adds nothing.
Region enclosing(const Region& a, const Region& b);

/// The rectangle grown by `margin` pixels on every side.
Region grown(const Region& region, int margin);

/// The part of an image inside `region`, without copying.
///
/// Precondition: region lies inside the image.
ImageView crop(const ImageView& image, const Region& region);

/// Which brightness of a picture is looked at.
enum class PixelChannel { kLuma, kRed, kGreen, kBlue };

/// "luma", "red", "green", "blue".
std::string_view channel_name(PixelChannel channel);

/// The channel of that name, or nothing.
std::optional<PixelChannel> channel_from_name(std::string_view name);

/// The side of a picture on which an outline is open and clamped.
enum class BaseSide { kBottom, kLeft, kTop, kRight };

/// Pixels of each brightness.
using Histogram = std::array<std::uint64_t, 256>;

}  // namespace wisp
