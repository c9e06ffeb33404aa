#include "capture/media/video_sources.hpp"

#include <algorithm>
#include <cmath>

namespace wisp {
namespace {

const AVPixFmtDescriptor* descriptor(const AVFrame& frame) {
  return av_pix_fmt_desc_get(static_cast<AVPixelFormat>(frame.format));
}

// Whether every colour component is a separate byte, so that the planes can be borrowed.
bool plain_bytes(const AVPixFmtDescriptor& format) {
  constexpr std::uint64_t kOther =
      AV_PIX_FMT_FLAG_PAL | AV_PIX_FMT_FLAG_BITSTREAM | AV_PIX_FMT_FLAG_HWACCEL | AV_PIX_FMT_FLAG_BAYER;
  if ((format.flags & kOther) != 0) return false;
  for (int k = 0; k < format.nb_components; ++k) {
    if (format.comp[k].depth != 8 || format.comp[k].shift != 0) return false;
  }
  return true;
}

bool old_full_range(AVPixelFormat format) {
  return format == AV_PIX_FMT_YUVJ420P || format == AV_PIX_FMT_YUVJ422P || format == AV_PIX_FMT_YUVJ444P ||
         format == AV_PIX_FMT_YUVJ440P || format == AV_PIX_FMT_YUVJ411P;
}

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
  out.full_range = rgb || frame.color_range == AVCOL_RANGE_JPEG ||
                   old_full_range(static_cast<AVPixelFormat>(frame.format)) ||
                   (grey && frame.color_range != AVCOL_RANGE_MPEG);
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

// Provides a reused frame of the given format and size. Returns false where memory is exhausted.
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

// Size with square pixels: enlarges the dimension along which pixels are longer.
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
  const bool square = size == std::pair(frame.width, frame.height);
  if (plain_bytes(format) && square) return &frame;
  const bool rgb = (format.flags & (AV_PIX_FMT_FLAG_RGB | AV_PIX_FMT_FLAG_PAL)) != 0;
  const AVPixelFormat target = format.nb_components < 3 && !rgb ? AV_PIX_FMT_GRAY8
                               : rgb                            ? AV_PIX_FMT_RGB24
                                                                : AV_PIX_FMT_YUV444P;
  if (!take_frame(plain_, size, target)) return Error{"not enough memory for a frame"};
  to_plain_.reset(sws_getCachedContext(to_plain_.release(), frame.width, frame.height,
                                       static_cast<AVPixelFormat>(frame.format), size.first, size.second, target,
                                       square ? SWS_POINT : SWS_BILINEAR, nullptr, nullptr, nullptr));
  if (!to_plain_) return Error{std::string("pixel format ") + format.name + " cannot be converted"};
  sws_scale(to_plain_.get(), frame.data, frame.linesize, 0, frame.height, plain_->data, plain_->linesize);
  plain_->colorspace = frame.colorspace;
  plain_->color_range = frame.color_range;
  return plain_.get();
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
  const auto size = stretched(frame.width, frame.height);
  RgbImage out{size.first, size.second, {}};
  const std::size_t row_bytes = 3 * static_cast<std::size_t>(out.width);
  out.pixels.resize(row_bytes * static_cast<std::size_t>(out.height));
  to_rgb_.reset(sws_getCachedContext(to_rgb_.release(), frame.width, frame.height,
                                     static_cast<AVPixelFormat>(frame.format), out.width, out.height, AV_PIX_FMT_RGB24,
                                     SWS_BILINEAR, nullptr, nullptr, nullptr));
  if (!to_rgb_ || !take_frame(rgb_, size, AV_PIX_FMT_RGB24)) return out;
  if (frame.colorspace == AVCOL_SPC_BT709) {
    const int* matrix = sws_getCoefficients(SWS_CS_ITU709);
    sws_setColorspaceDetails(to_rgb_.get(), matrix, frame.color_range == AVCOL_RANGE_JPEG, matrix, 1, 0, 1 << 16,
                             1 << 16);
  }
  // The scaler writes whole vectors beyond a row's end: it needs an output frame with padding, copied row by row.
  sws_scale(to_rgb_.get(), frame.data, frame.linesize, 0, frame.height, rgb_->data, rgb_->linesize);
  for (int y = 0; y < out.height; ++y) {
    std::copy_n(rgb_->data[0] + static_cast<std::ptrdiff_t>(y) * rgb_->linesize[0], row_bytes,
                out.pixels.data() + static_cast<std::size_t>(y) * row_bytes);
  }
  if (quarter_turns_ == 0) return out;
  RgbImage shown{
      quarter_turns_ % 2 == 0 ? out.width : out.height, quarter_turns_ % 2 == 0 ? out.height : out.width, {}};
  shown.pixels.resize(out.pixels.size());
  std::vector<std::uint8_t> plane(out.pixels.size() / 3);
  for (int k = 0; k < 3; ++k) {
    turn_plane({out.pixels.data() + k, static_cast<std::ptrdiff_t>(row_bytes), 3}, out.width, out.height,
               quarter_turns_, plane.data());
    for (std::size_t i = 0; i < plane.size(); ++i) shown.pixels[3 * i + k] = plane[i];
  }
  return shown;
}

}  // namespace wisp
