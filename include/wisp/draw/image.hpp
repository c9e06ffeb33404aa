#pragma once
// A picture in memory, and its PNG file.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "wisp/base/result.hpp"

namespace wisp {

/// A display colour: sRGB, 8 bits per channel, straight (not premultiplied) opacity.
struct Colour {
  std::uint8_t red = 0;
  std::uint8_t green = 0;
  std::uint8_t blue = 0;
  std::uint8_t opacity = 255;

  friend bool operator==(const Colour&, const Colour&) = default;
};

/// A point of a picture (pixels, y down) or of a model's outline (units, y up), as the function that takes it says.
struct Point {
  float x = 0;
  float y = 0;

  friend bool operator==(const Point&, const Point&) = default;
};

/// A rectangle of pixels; it may extend beyond the picture from which it is cropped.
struct PixelBox {
  int x = 0;
  int y = 0;
  int width = 0;
  int height = 0;
};

/// Largest width and height of an Image, in pixels: Cairo's limit.
inline constexpr int kLargestImageSide = 32767;

/// A picture that owns its pixels: premultiplied ARGB in one 32-bit word each (Cairo's ARGB32; BGRA bytes on
/// little-endian machines), row after row from the top without gaps.
class Image {
 public:
  Image() = default;

  /// Creates a picture of one colour. Precondition: 1 <= width, height <= kLargestImageSide.
  Image(int width, int height, Colour fill = {0, 0, 0, 255});

  /// Creates a picture from 8-bit RGB bytes, with `row_bytes` from one row to the next (0: rows follow without gaps).
  /// Precondition: 1 <= width, height <= kLargestImageSide.
  /// Precondition: rgb.size() >= (height − 1) × row_bytes + 3 × width.
  static Image from_rgb(std::span<const std::uint8_t> rgb, int width, int height, std::size_t row_bytes = 0);

  int width() const { return width_; }
  int height() const { return height_; }
  bool empty() const { return pixels_.empty(); }

  std::span<std::uint32_t> pixels() { return pixels_; }
  std::span<const std::uint32_t> pixels() const { return pixels_; }

  /// Returns one row of pixels. Precondition: 0 <= y < height().
  std::span<std::uint32_t> row(int y) { return pixels().subspan(static_cast<std::size_t>(y) * width_, width_); }
  std::span<const std::uint32_t> row(int y) const {
    return pixels().subspan(static_cast<std::size_t>(y) * width_, width_);
  }

  /// Returns a pixel's straight colour. Precondition: 0 <= x < width() and 0 <= y < height().
  Colour at(int x, int y) const;

  friend bool operator==(const Image&, const Image&) = default;

 private:
  int width_ = 0;
  int height_ = 0;
  std::vector<std::uint32_t> pixels_;
};

/// Returns the part of a picture inside `box`; black outside the picture.
/// Precondition: 1 <= box.width, box.height <= kLargestImageSide.
Image crop(const Image& image, PixelBox box);

/// Returns a picture resampled to another size, smoothly.
/// Precondition: !image.empty(); 1 <= width, height <= kLargestImageSide.
Image resized(const Image& image, int width, int height);

/// Writes a PNG file, completely or not at all.
/// Errors: an empty picture; the folder is missing or not writable, the disk is full.
Result<void> write_png(const std::filesystem::path& path, const Image& image);

}  // namespace wisp
