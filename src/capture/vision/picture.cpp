#include "wisp/capture/vision/picture.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "wisp/capture/vision/image.hpp"

namespace wisp {
namespace {

// Conversion from luma to a colour in 9.6 fixed point, which fits 16-bit lanes: value = (scale (Y − black) + colour) /
// 64 with colour = from_cb (Cb − 128) + from_cr (Cr − 128). Error: at most 1.3 grey levels at full range, else 2.5.
struct Conversion {
  std::int16_t black = 0;
  std::int16_t scale = kOne;
  std::int16_t from_cb = 0;
  std::int16_t from_cr = 0;

  static constexpr int kBits = 6;
  static constexpr std::int16_t kOne = 1 << kBits;
};

std::int16_t fixed(double value) {
  return static_cast<std::int16_t>(value * Conversion::kOne + (value < 0 ? -0.5 : 0.5));
}

// Uses Kr and Kb of ITU-R BT.601 and BT.709, section 3; Kg = 1 − Kr − Kb.
Conversion conversion(const Picture& picture, PixelChannel channel) {
  const double kr = picture.bt709 ? 0.2126 : 0.299, kb = picture.bt709 ? 0.0722 : 0.114, kg = 1 - kr - kb;
  const double luma = picture.full_range ? 1.0 : 255.0 / 219.0;
  const double chroma = picture.full_range ? 1.0 : 255.0 / 224.0;
  Conversion out;
  out.black = picture.full_range ? 0 : 16;
  out.scale = fixed(luma);
  if (channel == PixelChannel::kRed) out.from_cr = fixed(2 * (1 - kr) * chroma);
  if (channel == PixelChannel::kBlue) out.from_cb = fixed(2 * (1 - kb) * chroma);
  if (channel == PixelChannel::kGreen) {
    out.from_cr = fixed(-2 * (1 - kr) * kr / kg * chroma);
    out.from_cb = fixed(-2 * (1 - kb) * kb / kg * chroma);
  }
  return out;
}

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

void append_row(const PicturePlane& plane, int y, int width, std::vector<std::uint8_t>& out) {
  const std::uint8_t* in = plane_row(plane, 0, y);
  const std::size_t before = out.size();
  if (plane.step == 1) {
    out.insert(out.end(), in, in + width);
  } else {
    out.resize(before + static_cast<std::size_t>(width));
    copy_row(plane, 0, y, width, out.data() + before);
  }
}

void luma_row_of_rgb(const Picture& picture, int x, int y, int width, std::uint8_t* out) {
  const auto& [red, green, blue] = picture.planes;
  const std::uint8_t *r = plane_row(red, x, y), *g = plane_row(green, x, y), *b = plane_row(blue, x, y);
  for (int i = 0; i < width; ++i) {
    // BT.601 weights in 2^-14; their sum is 1, so grey is preserved.
    const int sum = 4899 * r[static_cast<std::ptrdiff_t>(i) * red.step] +
                    9617 * g[static_cast<std::ptrdiff_t>(i) * green.step] +
                    1868 * b[static_cast<std::ptrdiff_t>(i) * blue.step];
    out[i] = static_cast<std::uint8_t>((sum + 8192) >> 14);
  }
}

// Writes the contribution of the colour planes to each pixel of a row, in 64ths of a grey level.
void colour_row(const Picture& picture, const Conversion& to, const Region& region, int y, std::int16_t* out) {
  const int shift = picture.chroma_shift_x, cy = y >> picture.chroma_shift_y;
  const int first = region.x >> shift, last = (region.right() - 1) >> shift;
  const std::uint8_t* cb = plane_row(picture.planes[1], 0, cy);
  const std::uint8_t* cr = plane_row(picture.planes[2], 0, cy);
  const std::ptrdiff_t step = picture.planes[1].step;
  const int width = 1 << shift;
  for (int c = first; c <= last; ++c) {
    const int colour = to.from_cb * (cb[c * step] - 128) + to.from_cr * (cr[c * step] - 128) + Conversion::kOne / 2;
    const int begin = std::max(c * width, region.x) - region.x;
    const int end = std::min((c + 1) * width, region.right()) - region.x;
    for (int i = begin; i < end; ++i) out[i] = static_cast<std::int16_t>(colour);
  }
}

// Does the work of colour_row() for planes at half width, from an even pixel on: the usual case in videos.
void colour_row_in_pairs(const Conversion to, const std::uint8_t* cb, const std::uint8_t* cr, int pairs,
                         std::int16_t* out) {
  for (int c = 0; c < pairs; ++c) {
    const auto blue = static_cast<std::int16_t>(cb[c] - 128), red = static_cast<std::int16_t>(cr[c] - 128);
    const auto colour = static_cast<std::int16_t>(to.from_cb * blue + to.from_cr * red + Conversion::kOne / 2);
    out[2 * c] = colour;
    out[2 * c + 1] = colour;
  }
}

// Adds luma and colour, both halved before: |scale × 255| / 2 is below 9,600 and |colour| / 2 below 8,700, so all sums
// fit 16 bits and the loop processes eight pixels at a time on any processor.
void add_luma(const Conversion to, const std::uint8_t* luma, const std::int16_t* colour, int width, std::uint8_t* out) {
  for (int i = 0; i < width; ++i) {
    const auto scaled = static_cast<std::int16_t>(to.scale * static_cast<std::int16_t>(luma[i] - to.black));
    const auto sum = static_cast<std::int16_t>((scaled >> 1) + (colour[i] >> 1));
    const auto value = static_cast<std::int16_t>(sum >> (Conversion::kBits - 1));
    const std::int16_t low = value < 0 ? std::int16_t{0} : value;
    out[i] = static_cast<std::uint8_t>(low > 255 ? std::int16_t{255} : low);
  }
}

void colour_row_of_yuv(const Picture& picture, const Conversion& to, const Region& region, int y, std::uint8_t* out) {
  constexpr int kPart = 512;  // pixels per block, so that the colour contributions stay in the cache
  std::array<std::int16_t, kPart + 2> colour;
  std::array<std::uint8_t, kPart> luma;
  const PicturePlane &lumas = picture.planes[0], &cb = picture.planes[1], &cr = picture.planes[2];
  const bool pairs = picture.chroma_shift_x == 1 && cb.step == 1 && cr.step == 1;
  for (int x = region.x; x < region.right();) {
    const int width = std::min(kPart - (x & 1), region.right() - x);
    if (pairs) {
      const int cy = y >> picture.chroma_shift_y, skip = x & 1;
      colour_row_in_pairs(to, plane_row(cb, x >> 1, cy), plane_row(cr, x >> 1, cy), (width + skip + 1) / 2,
                          colour.data());
      if (skip != 0) std::copy_n(colour.data() + 1, width, colour.data());
    } else {
      colour_row(picture, to, {x, y, width, 1}, y, colour.data());
    }
    const std::uint8_t* values = plane_row(lumas, x, y);
    if (lumas.step != 1) {
      copy_row(lumas, x, y, width, luma.data());
      values = luma.data();
    }
    add_luma(to, values, colour.data(), width, out);
    out += width;
    x += width;
  }
}

std::uint8_t colour_of_yuv(const Conversion to, int luma, int cb, int cr) {
  const int colour = to.from_cb * (cb - 128) + to.from_cr * (cr - 128) + Conversion::kOne / 2;
  const int scaled = to.scale * (luma - to.black);
  return static_cast<std::uint8_t>(std::clamp(((scaled >> 1) + (colour >> 1)) >> (Conversion::kBits - 1), 0, 255));
}

// Samples every `step`-th pixel of a row. Returns the end of the output.
std::uint8_t* sample_row_of_yuv(const Picture& picture, const Conversion to, const Region& region, int y, int step,
                                std::uint8_t* out) {
  const PicturePlane &lumas = picture.planes[0], &cb = picture.planes[1], &cr = picture.planes[2];
  const int shift = picture.chroma_shift_x, cy = y >> picture.chroma_shift_y;
  const std::uint8_t *luma = plane_row(lumas, 0, y), *blue = plane_row(cb, 0, cy), *red = plane_row(cr, 0, cy);
  for (int x = region.x; x < region.right(); x += step, ++out) {
    const std::ptrdiff_t at = x, cx = x >> shift;
    *out = colour_of_yuv(to, luma[at * lumas.step], blue[cx * cb.step], red[cx * cr.step]);
  }
  return out;
}

void extract_row(const Picture& picture, PixelChannel channel, const Conversion& to, const Region& region, int y,
                 std::uint8_t* out) {
  if (channel == PixelChannel::kLuma || picture.layout == PictureLayout::kGrey) {
    if (picture.layout == PictureLayout::kRgb) return luma_row_of_rgb(picture, region.x, y, region.width, out);
    return copy_row(picture.planes[0], region.x, y, region.width, out);
  }
  if (picture.layout == PictureLayout::kYuv) return colour_row_of_yuv(picture, to, region, y, out);
  copy_row(picture.planes[static_cast<std::size_t>(channel) - 1], region.x, y, region.width, out);
}

constexpr int kRowsAhead = 6;  // rows between prefetching and use

// Always inlined: GCC treats a function that only prefetches as without effect, and drops its calls.
[[gnu::always_inline]] inline void prefetch_row([[maybe_unused]] const PicturePlane& plane, [[maybe_unused]] int x,
                                                [[maybe_unused]] int y, [[maybe_unused]] int width) {
#ifdef __GNUC__
  const std::uint8_t *at = plane_row(plane, x, y), *end = plane_row(plane, x + width, y);
  for (; at < end; at += 64) __builtin_prefetch(at);  // a cache line
#endif
}

// Prefetches a row of a region: its rows are far apart in memory, which hardware prefetchers do not predict.
[[gnu::always_inline]] inline void prefetch(const Picture& picture, PixelChannel channel, const Region& region, int y) {
  prefetch_row(picture.planes[0], region.x, y, region.width);
  if (picture.layout != PictureLayout::kYuv || channel == PixelChannel::kLuma) return;
  const int x = region.x >> picture.chroma_shift_x, width = region.width >> picture.chroma_shift_x;
  prefetch_row(picture.planes[1], x, y >> picture.chroma_shift_y, width);
  prefetch_row(picture.planes[2], x, y >> picture.chroma_shift_y, width);
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

void extract_channel(const Picture& picture, PixelChannel channel, const Region& region, std::uint8_t* out) {
  const Conversion to = conversion(picture, channel);
  for (int y = region.y; y < region.bottom(); ++y, out += region.width) {
    if (y + kRowsAhead < region.bottom()) prefetch(picture, channel, region, y + kRowsAhead);
    extract_row(picture, channel, to, region, y, out);
  }
}

void sample_channel(const Picture& picture, PixelChannel channel, const Region& region, int step, std::uint8_t* out) {
  const Conversion to = conversion(picture, channel);
  const bool computed = picture.layout == PictureLayout::kYuv && channel != PixelChannel::kLuma;
  const bool mixed = picture.layout == PictureLayout::kRgb && channel == PixelChannel::kLuma;
  for (int y = region.y; y < region.bottom(); y += step) {
    if (y + step < region.bottom()) prefetch(picture, channel, region, y + step);
    if (computed) {
      out = sample_row_of_yuv(picture, to, region, y, step, out);
    } else if (mixed) {
      for (int x = region.x; x < region.right(); x += step, ++out) luma_row_of_rgb(picture, x, y, 1, out);
    } else {
      const bool first = channel == PixelChannel::kLuma || picture.layout == PictureLayout::kGrey;
      const PicturePlane& plane = picture.planes[first ? 0 : static_cast<int>(channel) - 1];
      const std::uint8_t* row = plane_row(plane, region.x, y);
      const std::ptrdiff_t stride = static_cast<std::ptrdiff_t>(step) * plane.step;
      for (int x = region.x; x < region.right(); x += step, row += stride, ++out) *out = *row;
    }
  }
}

double brightness(const Picture& picture, PixelChannel channel, double stored) {
  if (channel != PixelChannel::kLuma || picture.layout == PictureLayout::kRgb || picture.full_range) return stored;
  return std::clamp((stored - 16) * (255.0 / 219.0), 0.0, 255.0);
}

double linear_light(double signal) {
  return signal < 0.081 ? signal / 4.5 : std::pow((signal + 0.099) / 1.099, 1 / 0.45);
}

OwnedPicture::OwnedPicture(const Picture& picture) : picture_(picture) {
  const int planes = picture.layout == PictureLayout::kGrey ? 1 : 3;
  std::array<std::array<int, 2>, 3> size{};
  std::size_t bytes = 0;
  for (int k = 0; k < planes; ++k) {
    const bool chroma = picture.layout == PictureLayout::kYuv && k > 0;
    size[k] = {chroma ? -(-picture.width >> picture.chroma_shift_x) : picture.width,
               chroma ? -(-picture.height >> picture.chroma_shift_y) : picture.height};
    bytes += static_cast<std::size_t>(size[k][0]) * size[k][1];
  }
  pixels_.reserve(bytes);  // rows are appended: no zero-initialisation, no reallocation
  for (int k = 0; k < planes; ++k) {
    const auto [width, height] = size[k];
    picture_.planes[k] = {pixels_.data() + pixels_.size(), width, 1};
    for (int y = 0; y < height; ++y) append_row(picture.planes[k], y, width, pixels_);
  }
}

Region intersection(const Region& a, const Region& b) {
  const int x = std::max(a.x, b.x), y = std::max(a.y, b.y);
  const int right = std::min(a.right(), b.right()), bottom = std::min(a.bottom(), b.bottom());
  if (right <= x || bottom <= y) return {};
  return {x, y, right - x, bottom - y};
}

Region enclosing(const Region& a, const Region& b) {
  if (a.empty()) return b;
  if (b.empty()) return a;
  const int x = std::min(a.x, b.x), y = std::min(a.y, b.y);
  return {x, y, std::max(a.right(), b.right()) - x, std::max(a.bottom(), b.bottom()) - y};
}

Region grown(const Region& region, int margin) {
  return {region.x - margin, region.y - margin, region.width + 2 * margin, region.height + 2 * margin};
}

ImageView crop(const ImageView& image, const Region& region) {
  assert(region.x >= 0 && region.y >= 0 && region.right() <= image.width && region.bottom() <= image.height);
  return {image.row(region.y) + region.x, region.width, region.height, image.stride};
}

constexpr std::array<std::string_view, 4> kChannelNames{"luma", "red", "green", "blue"};

std::string_view channel_name(PixelChannel channel) { return kChannelNames[static_cast<std::size_t>(channel)]; }

std::optional<PixelChannel> channel_from_name(std::string_view name) {
  const auto found = std::find(kChannelNames.begin(), kChannelNames.end(), name);
  if (found == kChannelNames.end()) return std::nullopt;
  return static_cast<PixelChannel>(found - kChannelNames.begin());
}

}  // namespace wisp
