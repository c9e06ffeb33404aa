#pragma once
// A video frame as borrowed planes, and extraction of one of its channels over a region.
//
// A decoder delivers luma and two planes of colour difference; a picture file or a browser delivers packed RGB. Both
// are borrowed unchanged; only the pixels that are analysed are converted.

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "wisp/capture/vision/image.hpp"

namespace wisp {

/// Colour model of the planes.
enum class PictureLayout {
  kGrey,  ///< one plane: brightness
  kYuv,   ///< luma, blue difference, red difference; the latter two perhaps at lower resolution
  kRgb,   ///< red, green, blue
};

/// One borrowed plane of a picture.
struct PicturePlane {
  const std::uint8_t* pixels = nullptr;
  std::ptrdiff_t stride = 0;  ///< bytes from one row to the next
  int step = 1;               ///< bytes from one pixel to the next: 1 planar, 2 to 4 packed
};

/// A borrowed picture.
struct Picture {
  PictureLayout layout = PictureLayout::kGrey;
  int width = 0;
  int height = 0;
  std::array<PicturePlane, 3> planes;
  int chroma_shift_x = 0;  ///< kYuv: log2 of the horizontal subsampling of the colour planes
  int chroma_shift_y = 0;  ///< kYuv: log2 of their vertical subsampling
  bool full_range = true;  ///< kYuv and kGrey: black is 0 and white 255; else 16 and 235, as in video
  bool bt709 = false;      ///< kYuv: colour matrix ITU-R BT.709; else BT.601

  Region frame() const { return {0, 0, width, height}; }
};

/// Returns a grey picture over one plane.
Picture grey_picture(const ImageView& image);

/// Returns a picture over packed RGB (`step` 3) or RGBA (`step` 4).
Picture rgb_picture(const ImageView& first_channel, int step);

/// Returns whether `channel` exists in the picture: a grey one has luma only.
bool has_channel(const Picture& picture, PixelChannel channel);

/// Returns the channel as a plane of the picture itself, without copying; `pixels` is null where it must be computed.
ImageView plane_in_place(const Picture& picture, PixelChannel channel);

/// Computes `channel` over `region` into `out`, row by row, `region.width` bytes per row, in the stored range: limited
/// for luma of a picture without full range, 0 to 255 for red, green and blue. Of a grey picture any channel is luma.
/// Precondition: region lies inside the picture and `out` holds region.width × region.height bytes.
void extract_channel(const Picture& picture, PixelChannel channel, const Region& region, std::uint8_t* out);

/// Like extract_channel(), for every `step`-th pixel of every `step`-th row, beginning with the region's first.
/// Precondition: those of extract_channel(), and step >= 1; `out` holds the number of pixels taken.
void sample_channel(const Picture& picture, PixelChannel channel, const Region& region, int step, std::uint8_t* out);

/// Converts a stored value of `channel` to brightness from 0 (black) to 255 (white).
double brightness(const Picture& picture, PixelChannel channel, double stored);

/// Inverts a camera's transfer function (ITU-R BT.709-6, item 1.2): signal to light, white 1.
double linear_light(double signal);

/// A picture that owns its planes.
class OwnedPicture {
 public:
  /// Copies a picture; packed planes become planar.
  explicit OwnedPicture(const Picture& picture);
  OwnedPicture(OwnedPicture&&) noexcept = default;
  OwnedPicture& operator=(OwnedPicture&&) noexcept = default;

  const Picture& picture() const { return picture_; }
  std::size_t bytes() const { return pixels_.size(); }

 private:
  std::vector<std::uint8_t> pixels_;
  Picture picture_;
};

}  // namespace wisp
