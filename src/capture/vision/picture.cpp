#include "wisp/capture/vision/picture.hpp"

#include <algorithm>
#include <array>
#include <cassert>

namespace wisp {
namespace {

// Luma to RGB in fixed point with 13 bits after the point, so that factors and samples are 16 bits wide: products of
// those are what processors multiply widest. value = scale (Y − black) + blue (Cb − 128) + red (Cr − 128).
struct Conversion {
  int black = 0;
  int scale = 1 << 13;
  int from_cb = 0;
  int from_cr = 0;
};

constexpr int kFixedBits = 13;
constexpr int kFixedOne = 1 << kFixedBits;

int fixed(double value) { return static_cast<int>(value * kFixedOne + (value < 0 ? -0.5 : 0.5)); }

// ITU-R BT.601 and BT.709, section 3: Kr and Kb; Kg is the rest.
Conversion conversion(const Picture& picture, PixelChannel channel) {
  const double kr = picture.bt709 ? 0.2126 : 0.299, kb = picture.bt709 ? 0.0722 : 0.114, kg = 1 - kr - kb;
  const double luma = picture.full_range ? 1.0 : 255.0 / 219.0;
  const double chroma = picture.full_range ? 1.0 : 255.0 / 224.0;
  Conversion out{picture.full_range ? 0 : 16, fixed(luma), 0, 0};
  if (channel == PixelChannel::kRed) out.from_cr = fixed(2 * (1 - kr) * chroma);
  if (channel == PixelChannel::kBlue) out.from_cb = fixed(2 * (1 - kb) * chroma);
  if (channel == PixelChannel::kGreen) {
    out.from_cr = fixed(-2 * (1 - kr) * kr / kg * chroma);
    out.from_cb = fixed(-2 * (1 - kb) * kb / kg * chroma);
  }
  return out;
}

std::uint8_t to_byte(int value) { return static_cast<std::uint8_t>(std::clamp(value, 0, 255)); }

const std::uint8_t* plane_row(const PicturePlane& plane, int x, int y) {
  return plane.pixels + y * plane.stride + static_cast<std::ptrdiff_t>(x) * plane.step;
}

void copy_row(const PicturePlane& plane, int x, int y, int width, std::uint8_t* out) {
  const std::uint8_t* in = plane_row(plane, x, y);
  if (plane.step == 1) {
    std::copy_n(in, width, out);
    return;
  }
  for (int i = 0; i < width; ++i) out[i] = in[static_cast<std::ptrdiff_t>(i) * plane.step];
}

void luma_row_of_rgb(const Picture& picture, int x, int y, int width, std::uint8_t* out) {
  const auto& [red, green, blue] = picture.planes;
  const std::uint8_t *r = plane_row(red, x, y), *g = plane_row(green, x, y), *b = plane_row(blue, x, y);
  for (int i = 0; i < width; ++i) {
    // BT.601 weights in 2^-14; they sum to one, so that grey stays what it is.
    const int sum = 4899 * r[static_cast<std::ptrdiff_t>(i) * red.step] +
                    9617 * g[static_cast<std::ptrdiff_t>(i) * green.step] +
                    1868 * b[static_cast<std::ptrdiff_t>(i) * blue.step];
    out[i] = static_cast<std::uint8_t>((sum + 8192) >> 14);
  }
}

int colour_part(const Conversion& to, const PicturePlane& cb, const PicturePlane& cr, int cx, int cy) {
  return to.from_cb * (*plane_row(cb, cx, cy) - 128) + to.from_cr * (*plane_row(cr, cx, cy) - 128) + kFixedOne / 2;
}

// Up to kBlock pixels of planar YUV, in loops over whole arrays, which compilers turn into wide instructions.
constexpr int kBlock = 256;

void colour_block(const Conversion& to, const std::uint8_t* luma, const std::uint8_t* cb, const std::uint8_t* cr,
                  int shift, int phase, int width, std::uint8_t* out) {
  std::array<int, kBlock + 2> colour{};
  const int colours = ((phase + width - 1) >> shift) + 1;
  std::array<int, kBlock + 2> each;
  for (int k = 0; k < colours; ++k) each[k] = to.from_cb * (cb[k] - 128) + to.from_cr * (cr[k] - 128) + kFixedOne / 2;
  if (shift == 1) {
    for (int k = 0; 2 * k + 1 < kBlock + 2 && k < colours; ++k) colour[2 * k] = colour[2 * k + 1] = each[k];
  } else {
    for (int i = 0; i < phase + width; ++i) colour[i] = each[i >> shift];
  }
  const auto scale = static_cast<std::int16_t>(to.scale), black = static_cast<std::int16_t>(to.black);
  for (int i = 0; i < width; ++i) {
    const auto above_black = static_cast<std::int16_t>(luma[i] - black);
    const int value = (scale * above_black + colour[i + phase]) >> kFixedBits;
    out[i] = static_cast<std::uint8_t>(value < 0 ? 0 : value > 255 ? 255 : value);
  }
}

void colour_row_of_yuv(const Picture& picture, const Conversion& to, const Region& region, int y, std::uint8_t* out) {
  const auto& [luma, cb, cr] = picture.planes;
  const int shift = picture.chroma_shift_x, cy = y >> picture.chroma_shift_y;
  const bool planar = luma.step == 1 && cb.step == 1 && cr.step == 1 && shift <= 1;
  for (int i = 0; planar && i < region.width; i += kBlock) {
    const int x = region.x + i, width = std::min(kBlock, region.width - i);
    colour_block(to, plane_row(luma, x, y), plane_row(cb, x >> shift, cy), plane_row(cr, x >> shift, cy), shift,
                 x & shift, width, out + i);
  }
  if (planar) return;
  const std::uint8_t* row = plane_row(luma, region.x, y);
  for (int i = 0; i < region.width; ++i) {
    const int colour = colour_part(to, cb, cr, (region.x + i) >> shift, cy);
    out[i] = to_byte((to.scale * (row[static_cast<std::ptrdiff_t>(i) * luma.step] - to.black) + colour) >> kFixedBits);
  }
}

void extract_row(const Picture& picture, PixelChannel channel, const Conversion& to, const Region& region, int y,
                 std::uint8_t* out) {
  if (channel == PixelChannel::kLuma) {
    if (picture.layout == PictureLayout::kRgb) return luma_row_of_rgb(picture, region.x, y, region.width, out);
    return copy_row(picture.planes[0], region.x, y, region.width, out);
  }
  if (picture.layout == PictureLayout::kYuv) return colour_row_of_yuv(picture, to, region, y, out);
  copy_row(picture.planes[static_cast<std::size_t>(channel) - 1], region.x, y, region.width, out);
}

}  // namespace

Picture grey_picture(const ImageView& image) {
  Picture picture;
  picture.width = image.width;
  picture.height = image.height;
  picture.planes[0] = {image.pixels, image.stride, 1};
  return picture;
}

Picture rgb_picture(const ImageView& first_channel, int step) {
  Picture picture = grey_picture(first_channel);
  picture.layout = PictureLayout::kRgb;
  for (int k = 0; k < 3; ++k) picture.planes[k] = {first_channel.pixels + k, first_channel.stride, step};
  return picture;
}

bool has_channel(const Picture& picture, PixelChannel channel) {
  return picture.layout != PictureLayout::kGrey || channel == PixelChannel::kLuma;
}

ImageView plane_in_place(const Picture& picture, PixelChannel channel) {
  const bool luma = channel == PixelChannel::kLuma;
  if (luma == (picture.layout == PictureLayout::kRgb)) return {};
  const PicturePlane& plane = picture.planes[luma ? 0 : static_cast<std::size_t>(channel) - 1];
  if (plane.step != 1) return {};
  return {plane.pixels, picture.width, picture.height, plane.stride};
}

Picture subsampled(const Picture& picture, const Region& area, int step) {
  Picture out = picture;
  out.width = (area.width + step - 1) / step;
  out.height = (area.height + step - 1) / step;
  for (std::size_t k = 0; k < out.planes.size(); ++k) {
    PicturePlane& plane = out.planes[k];
    if (plane.pixels == nullptr) continue;
    const bool chroma = picture.layout == PictureLayout::kYuv && k > 0;
    const int across = chroma ? picture.chroma_shift_x : 0, down = chroma ? picture.chroma_shift_y : 0;
    plane.pixels = plane_row(plane, area.x >> across, area.y >> down);
    plane.stride *= step >> down;
    plane.step *= step >> across;
  }
  out.chroma_shift_x = out.chroma_shift_y = 0;
  return out;
}

void extract_channel(const Picture& picture, PixelChannel channel, const Region& region, std::uint8_t* out) {
  assert(has_channel(picture, channel));
  const Conversion to = conversion(picture, channel);
  for (int y = region.y; y < region.bottom(); ++y, out += region.width) {
    extract_row(picture, channel, to, region, y, out);
  }
}

double brightness(const Picture& picture, PixelChannel channel, double stored) {
  if (channel != PixelChannel::kLuma || picture.layout == PictureLayout::kRgb || picture.full_range) return stored;
  return std::clamp((stored - 16) * (255.0 / 219.0), 0.0, 255.0);
}

OwnedPicture::OwnedPicture(const Picture& picture) : picture_(picture) {
  const int planes = picture.layout == PictureLayout::kGrey ? 1 : 3;
  std::array<std::size_t, 3> offset{};
  for (int k = 0; k < planes; ++k) {
    const bool chroma = picture.layout == PictureLayout::kYuv && k > 0;
    const int width = chroma ? -(-picture.width >> picture.chroma_shift_x) : picture.width;
    const int height = chroma ? -(-picture.height >> picture.chroma_shift_y) : picture.height;
    offset[k] = pixels_.size();
    pixels_.resize(pixels_.size() + static_cast<std::size_t>(width) * height);
    for (int y = 0; y < height; ++y) {
      copy_row(picture.planes[k], 0, y, width, pixels_.data() + offset[k] + static_cast<std::size_t>(y) * width);
    }
    picture_.planes[k] = {nullptr, width, 1};
  }
  for (int k = 0; k < planes; ++k) picture_.planes[k].pixels = pixels_.data() + offset[k];
}

}  // namespace wisp
