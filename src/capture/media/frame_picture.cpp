#include "capture/media/video_sources.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "capture/media/wide_colours.hpp"

namespace wisp {
namespace {

const AVPixFmtDescriptor* descriptor(const AVFrame& frame) {
  return av_pix_fmt_desc_get(static_cast<AVPixelFormat>(frame.format));
}

// Returns whether every colour component is a separate byte, so that the planes can be borrowed.
bool plain_bytes(const AVPixFmtDescriptor& format) {
  constexpr std::uint64_t kOther =
      AV_PIX_FMT_FLAG_PAL | AV_PIX_FMT_FLAG_BITSTREAM | AV_PIX_FMT_FLAG_HWACCEL | AV_PIX_FMT_FLAG_BAYER;
  if ((format.flags & kOther) != 0) return false;
  for (int k = 0; k < format.nb_components; ++k) {
    if (format.comp[k].depth != 8 || format.comp[k].shift != 0) return false;
  }
  return true;
}

// Returns whether the format alone states full range: FFmpeg would convert it to another.
bool is_jpeg(const AVPixFmtDescriptor& format) { return std::strncmp(format.name, "yuvj", 4) == 0; }

bool full_range(const AVFrame& frame) { return frame.color_range == AVCOL_RANGE_JPEG || is_jpeg(*descriptor(frame)); }

Picture borrowed(const AVFrame& frame) {
  const AVPixFmtDescriptor& format = *descriptor(frame);
  const bool grey = format.nb_components < 3, rgb = (format.flags & AV_PIX_FMT_FLAG_RGB) != 0;
  Picture out;
  out.layout = grey ? PictureLayout::kGrey : rgb ? PictureLayout::kRgb : PictureLayout::kYuv;
  out.width = frame.width;
  out.height = frame.height;
  for (int k = 0; k < (grey ? 1 : 3); ++k) {
    const AVComponentDescriptor& part = format.comp[k];
    out.planes[k] = {frame.data[part.plane] + part.offset, frame.linesize[part.plane], part.step};
  }
  out.chroma_shift_x = format.log2_chroma_w;
  out.chroma_shift_y = format.log2_chroma_h;
  out.bt709 = frame.colorspace == AVCOL_SPC_BT709;
  out.full_range = rgb || full_range(frame) || (grey && frame.color_range != AVCOL_RANGE_MPEG);
  return out;
}

// Rotates one plane clockwise by quarter turns; `width` and `height` are those of the input plane.
void turn_plane(const PicturePlane& in, int width, int height, int quarters, std::uint8_t* out) {
  const auto at = [&](int x, int y) { return in.pixels[y * in.stride + static_cast<std::ptrdiff_t>(x) * in.step]; };
  const int out_width = quarters % 2 == 0 ? width : height, out_height = quarters % 2 == 0 ? height : width;
  for (int y = 0; y < out_height; ++y) {
    for (int x = 0; x < out_width; ++x) {
      if (quarters == 1) *out++ = at(y, height - 1 - x);
      if (quarters == 2) *out++ = at(width - 1 - x, height - 1 - y);
      if (quarters == 3) *out++ = at(width - 1 - y, x);
    }
  }
}

// Gives `kept` this size and format, reusing its memory if both are unchanged. Returns false if memory is exhausted.
bool take_frame(FrameOwner& kept, std::pair<int, int> size, AVPixelFormat format) {
  if (!kept) kept.reset(av_frame_alloc());
  if (!kept) return false;
  if (kept->width == size.first && kept->height == size.second && kept->format == format) return true;
  av_frame_unref(kept.get());
  kept->width = size.first;
  kept->height = size.second;
  kept->format = format;
  if (av_frame_get_buffer(kept.get(), 0) >= 0) return true;
  av_frame_unref(kept.get());
  return false;
}

}  // namespace

// Returns a frame's size in square pixels: enlarges the dimension along which pixels are longer.
std::pair<int, int> FramePictures::stretched(int width, int height) const {
  if (aspect_ > 1) return {static_cast<int>(std::lround(width * aspect_)), height};
  return {width, static_cast<int>(std::lround(height / aspect_))};
}

std::pair<int, int> FramePictures::shown(int width, int height) const {
  auto [wide, high] = stretched(width, height);
  if (quarter_turns_ % 2 != 0) std::swap(wide, high);
  return {wide, high};
}

Result<const AVFrame*> FramePictures::plain(const AVFrame& frame) {
  const AVPixFmtDescriptor& format = *descriptor(frame);
  const auto size = stretched(frame.width, frame.height);
  const bool square = size == std::pair(frame.width, frame.height), wide = has_wide_colours(frame);
  if (plain_bytes(format) && square && !wide) return &frame;
  const bool rgb = (format.flags & (AV_PIX_FMT_FLAG_RGB | AV_PIX_FMT_FLAG_PAL)) != 0;
  const AVPixelFormat target = wide                               ? AV_PIX_FMT_RGB48
                               : format.nb_components < 3 && !rgb ? AV_PIX_FMT_GRAY8
                               : rgb                              ? AV_PIX_FMT_RGB24
                               : is_jpeg(format)                  ? AV_PIX_FMT_YUVJ444P
                                                                  : AV_PIX_FMT_YUV444P;
  if (!take_frame(plain_, size, target)) return Error{"not enough memory for a frame"};
  to_plain_.reset(sws_getCachedContext(to_plain_.release(), frame.width, frame.height,
                                       static_cast<AVPixelFormat>(frame.format), size.first, size.second, target,
                                       square ? SWS_POINT : SWS_BILINEAR, nullptr, nullptr, nullptr));
  if (!to_plain_) return Error{std::string("pixel format ") + format.name + " cannot be converted"};
  const int* matrix = sws_getCoefficients(frame.colorspace == AVCOL_SPC_BT709 ? SWS_CS_ITU709 : SWS_CS_BT2020);
  if (wide) sws_setColorspaceDetails(to_plain_.get(), matrix, full_range(frame), matrix, 1, 0, 1 << 16, 1 << 16);
  sws_scale(to_plain_.get(), frame.data, frame.linesize, 0, frame.height, plain_->data, plain_->linesize);
  plain_->colorspace = frame.colorspace;
  plain_->color_range = frame.color_range;
  if (!wide) return plain_.get();
  if (!take_frame(narrow_, size, AV_PIX_FMT_RGB24)) return Error{"not enough memory for a frame"};
  narrow_colours(frame, *plain_, *narrow_);
  return narrow_.get();
}

Picture FramePictures::turned(const Picture& picture) {
  Picture out = picture;
  const bool sideways = quarter_turns_ % 2 != 0;
  if (sideways) {
    std::swap(out.width, out.height);
    std::swap(out.chroma_shift_x, out.chroma_shift_y);
  }
  const int planes = picture.layout == PictureLayout::kGrey ? 1 : 3;
  turned_.resize(static_cast<std::size_t>(planes) * (picture.width + 1) * (picture.height + 1));
  std::uint8_t* next = turned_.data();
  for (int k = 0; k < planes; ++k) {
    const bool chroma = k > 0 && picture.layout == PictureLayout::kYuv;
    const int width = chroma ? -(-picture.width >> picture.chroma_shift_x) : picture.width;
    const int height = chroma ? -(-picture.height >> picture.chroma_shift_y) : picture.height;
    turn_plane(picture.planes[k], width, height, quarter_turns_, next);
    out.planes[k] = {next, sideways ? height : width, 1};
    next += static_cast<std::ptrdiff_t>(width) * height;
  }
  return out;
}

Result<Picture> FramePictures::view(const AVFrame& frame) {
  const auto source = plain(frame);
  if (!source) return source.error();
  const Picture picture = borrowed(**source);
  return quarter_turns_ == 0 ? picture : turned(picture);
}

RgbImage FramePictures::rgb(const AVFrame& frame) {
  const auto [width, height] = shown(frame.width, frame.height);
  std::vector<std::uint8_t> plane(static_cast<std::size_t>(width) * height);
  RgbImage out{width, height, std::vector<std::uint8_t>(3 * plane.size())};
  const auto picture = view(frame);
  if (!picture) return out;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto colour = static_cast<PixelChannel>(static_cast<std::size_t>(PixelChannel::kRed) + k);
    const PixelChannel channel = has_channel(*picture, colour) ? colour : PixelChannel::kLuma;
    std::array<std::uint8_t, 256> level{};
    for (int v = 0; v < 256; ++v) level[v] = static_cast<std::uint8_t>(std::lround(brightness(*picture, channel, v)));
    extract_channel(*picture, channel, picture->frame(), plane.data());
    for (std::size_t i = 0; i < plane.size(); ++i) out.pixels[3 * i + k] = level[plane[i]];
  }
  return out;
}

}  // namespace wisp
