#include "wisp/draw/film_strip.hpp"

extern "C" {
#include <libavutil/opt.h>
}

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include "base/json_text.hpp"
#include "base/path_text.hpp"
#include "draw/film/libav_owners.hpp"
#include "record/number_text.hpp"
#include "wisp/base/file.hpp"

namespace wisp {
namespace {

constexpr int kLargestAtlas = 16384;

using drawing::Owned;

Error failed(const std::filesystem::path& path, const std::string& what) {
  return {path.string() + ": cannot be written: " + what};
}

Result<void> check(const std::filesystem::path& path, const Flipbook& book) {
  if (book.frames.empty() || book.frames.front().empty()) return failed(path, "there are no frames");
  for (const Image& frame : book.frames) {
    if (frame.width() != book.frames[0].width() || frame.height() != book.frames[0].height()) {
      return failed(path, "the frames are of several sizes");
    }
  }
  if (!(book.rate_hz >= 0.1 && book.rate_hz <= 1000)) {
    return failed(path, "the rate is " + number_text(book.rate_hz) + ", expected 0.1 to 1000 frames a second");
  }
  return {};
}

// A frame of FFmpeg in RGBA, of the picture's bytes: premultiplied as they are, or straight.
Owned<AVFrame> frame_of(const Image& image, bool straight) {
  Owned<AVFrame> frame(av_frame_alloc());
  frame->format = AV_PIX_FMT_RGBA;
  frame->width = image.width();
  frame->height = image.height();
  if (av_frame_get_buffer(frame.get(), 0) < 0) return nullptr;
  for (int y = 0; y < image.height(); ++y) {
    std::uint8_t* out = frame->data[0] + static_cast<std::ptrdiff_t>(y) * frame->linesize[0];
    for (int x = 0; x < image.width(); ++x) {
      const std::uint32_t pixel = image.row(y)[static_cast<std::size_t>(x)];
      Colour colour{static_cast<std::uint8_t>(pixel >> 16), static_cast<std::uint8_t>(pixel >> 8),
                    static_cast<std::uint8_t>(pixel), static_cast<std::uint8_t>(pixel >> 24)};
      if (straight) colour = image.at(x, y);
      for (const std::uint8_t byte : {colour.red, colour.green, colour.blue, colour.opacity}) *out++ = byte;
    }
  }
  return frame;
}

// An animated picture in the making.
struct Clip {
  const std::filesystem::path& path;
  PendingFile pending;
  Owned<AVFormatContext> format{};
  Owned<AVCodecContext> codec{};
  Owned<SwsContext> scaler{};
  Owned<AVFrame> converted{};
  AVStream* stream = nullptr;

  Result<void> open(const Flipbook& book, bool webm);
  Result<void> send(AVFrame* frame);
};

Result<void> Clip::open(const Flipbook& book, bool webm) {
  const AVCodec* encoder = webm ? avcodec_find_encoder_by_name("libvpx-vp9") : avcodec_find_encoder(AV_CODEC_ID_APNG);
  if (!encoder) return failed(path, std::string("this FFmpeg has no encoder for ") + (webm ? "VP9" : "APNG"));
  AVFormatContext* made = nullptr;
  avformat_alloc_output_context2(&made, nullptr, webm ? "webm" : "apng", nullptr);
  if (!made) return failed(path, "this FFmpeg cannot write such files");
  format.reset(made);
  codec.reset(avcodec_alloc_context3(encoder));
  codec->width = book.frames[0].width();
  codec->height = book.frames[0].height();
  codec->pix_fmt = webm ? AV_PIX_FMT_YUVA420P : AV_PIX_FMT_RGBA;
  codec->framerate = av_d2q(book.rate_hz, 1001000);
  codec->time_base = av_inv_q(codec->framerate);
  codec->log_level_offset = AV_LOG_DEBUG - AV_LOG_INFO + 1;
  if (webm) {
    av_opt_set_int(codec->priv_data, "crf", 18, 0);
    av_opt_set(codec->priv_data, "auto-alt-ref", "0", 0);  // VP9 has no hidden frames with opacity
    codec->bit_rate = 0;
  } else {
    av_opt_set_int(format->priv_data, "plays", book.loop ? 0 : 1, 0);
  }
  if ((format->oformat->flags & AVFMT_GLOBALHEADER) != 0) codec->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
  if (avcodec_open2(codec.get(), encoder, nullptr) < 0) return failed(path, "its encoder does not start");
  stream = avformat_new_stream(format.get(), nullptr);
  stream->time_base = codec->time_base;
  stream->avg_frame_rate = codec->framerate;
  avcodec_parameters_from_context(stream->codecpar, codec.get());
  if (webm) av_dict_set(&stream->metadata, "alpha_mode", "1", 0);
  scaler.reset(sws_getContext(codec->width, codec->height, AV_PIX_FMT_RGBA, codec->width, codec->height, codec->pix_fmt,
                              SWS_BICUBIC, nullptr, nullptr, nullptr));
  const std::string name = pending.path().string();
  if (!scaler || avio_open(&format->pb, name.c_str(), AVIO_FLAG_WRITE) < 0 ||
      avformat_write_header(format.get(), nullptr) < 0) {
    return failed(path, "the file does not open");
  }
  return {};
}

Result<void> Clip::send(AVFrame* frame) {
  const Owned<AVPacket> packet(av_packet_alloc());
  if (avcodec_send_frame(codec.get(), frame) < 0) return failed(path, "a frame cannot be encoded");
  while (avcodec_receive_packet(codec.get(), packet.get()) >= 0) {
    if (packet->duration == 0) packet->duration = 1;
    av_packet_rescale_ts(packet.get(), codec->time_base, stream->time_base);
    packet->stream_index = stream->index;
    if (av_interleaved_write_frame(format.get(), packet.get()) < 0 || format->pb->error < 0) {
      return failed(path, "the disk is full or gone");
    }
  }
  return {};
}

Owned<AVFrame> converted(const Clip& clip, const AVFrame& straight, std::size_t index) {
  Owned<AVFrame> frame(av_frame_alloc());
  frame->format = clip.codec->pix_fmt;
  frame->width = straight.width;
  frame->height = straight.height;
  frame->pts = static_cast<std::int64_t>(index);
  if (av_frame_get_buffer(frame.get(), 0) < 0) return nullptr;
  sws_scale(clip.scaler.get(), straight.data, straight.linesize, 0, straight.height, frame->data, frame->linesize);
  return frame;
}

// One picture as the bytes of a PNG file, with its numbers as they are.
std::vector<std::byte> png_bytes(const Image& image) {
  const Owned<AVCodecContext> codec(avcodec_alloc_context3(avcodec_find_encoder(AV_CODEC_ID_PNG)));
  const Owned<AVFrame> frame = frame_of(image, false);
  const Owned<AVPacket> packet(av_packet_alloc());
  codec->width = image.width();
  codec->height = image.height();
  codec->pix_fmt = AV_PIX_FMT_RGBA;
  codec->time_base = {1, 25};
  std::vector<std::byte> bytes;
  if (!frame || avcodec_open2(codec.get(), nullptr, nullptr) < 0) return bytes;
  avcodec_send_frame(codec.get(), frame.get());
  avcodec_send_frame(codec.get(), nullptr);
  while (avcodec_receive_packet(codec.get(), packet.get()) >= 0) {
    const auto* first = reinterpret_cast<const std::byte*>(packet->data);
    bytes.insert(bytes.end(), first, first + packet->size);
  }
  return bytes;
}

struct Grid {
  int columns = 0, rows = 0;
};

// As near to a square as whole frames make it.
Grid grid_of(const Flipbook& book) {
  const auto count = static_cast<double>(book.frames.size());
  const double shape = static_cast<double>(book.frames[0].height()) / book.frames[0].width();
  const int columns = std::clamp(static_cast<int>(std::ceil(std::sqrt(count * shape))), 1, static_cast<int>(count));
  return {columns, static_cast<int>(std::ceil(count / columns))};
}

JsonText& write_size(int width, int height, JsonText& json) { return json.value(width, "w").value(height, "h"); }

std::string atlas_json(const std::filesystem::path& path, const Flipbook& book, const Grid& grid) {
  const int width = book.frames[0].width(), height = book.frames[0].height();
  JsonText json;
  json.object().list("frames");
  for (std::size_t k = 0; k < book.frames.size(); ++k) {
    const int column = static_cast<int>(k) % grid.columns, row = static_cast<int>(k) / grid.columns;
    json.object().value(std::to_string(k), "filename").object("frame").value(column * width, "x");
    write_size(width, height, json.value(row * height, "y")).end().value(false, "rotated").value(false, "trimmed");
    write_size(width, height, json.object("spriteSourceSize").value(0, "x").value(0, "y")).end();
    write_size(width, height, json.object("sourceSize")).end().value(1000 / book.rate_hz, "duration");
    json.object("pivot").value(book.pivot.x / static_cast<float>(width), "x");
    json.value(book.pivot.y / static_cast<float>(height), "y").end().end();
  }
  json.end().object("meta").value("Wisp", "app").value(path_text(path.filename()), "image");
  json.value("RGBA8888", "format").value(true, "premultiplied");
  write_size(grid.columns * width, grid.rows * height, json.object("size")).end().value("1", "scale");
  json.value(grid.columns, "columns").value(grid.rows, "rows").value(book.rate_hz, "rate_hz").value(book.loop, "loop");
  json.end().end();
  return json.text() + "\n";
}

}  // namespace

void make_light(Image& image) {
  for (std::uint32_t& pixel : image.pixels()) {
    const std::uint32_t brightest = std::max({pixel >> 16 & 0xff, pixel >> 8 & 0xff, pixel & 0xff});
    pixel = (pixel & 0xffffff) | brightest << 24;
  }
}

Result<void> write_atlas(const std::filesystem::path& path, const Flipbook& book) {
  if (auto ok = check(path, book); !ok) return ok;
  const Grid grid = grid_of(book);
  const int width = book.frames[0].width(), height = book.frames[0].height();
  if (grid.columns * width > kLargestAtlas || grid.rows * height > kLargestAtlas) {
    return failed(path, std::to_string(book.frames.size()) + " frames make an atlas of " +
                            std::to_string(grid.columns * width) + " x " + std::to_string(grid.rows * height) +
                            " pixels, expected at most 16384 either way; ask for fewer seconds or a smaller height");
  }
  Image atlas(grid.columns * width, grid.rows * height, {0, 0, 0, 0});
  for (std::size_t k = 0; k < book.frames.size(); ++k) {
    const int x = static_cast<int>(k) % grid.columns * width, y = static_cast<int>(k) / grid.columns * height;
    for (int row = 0; row < height; ++row) {
      std::ranges::copy(book.frames[k].row(row), atlas.row(y + row).begin() + x);
    }
  }
  const auto bytes = png_bytes(atlas);
  if (bytes.empty()) return failed(path, "this FFmpeg has no encoder for PNG");
  if (auto ok = write_file(path, bytes); !ok) return ok;
  std::filesystem::path beside = path;
  return write_file(beside.replace_extension(".atlas.json"), atlas_json(path, book, grid));
}

Result<void> write_animation(const std::filesystem::path& path, const Flipbook& book) {
  if (auto ok = check(path, book); !ok) return ok;
  const bool webm = path.extension() == ".webm";
  if (!webm && path.extension() != ".apng") return failed(path, "expected a name that ends in .apng or .webm");
  auto pending = PendingFile::create(path);
  if (!pending) return pending.error();
  Clip clip{path, *std::move(pending)};
  if (auto ok = clip.open(book, webm); !ok) return ok;
  for (std::size_t k = 0; k < book.frames.size(); ++k) {
    const auto straight = frame_of(book.frames[k], true);
    const auto frame = straight ? converted(clip, *straight, k) : nullptr;
    if (!frame) return failed(path, "there is no memory for a frame");
    if (auto ok = clip.send(frame.get()); !ok) return ok;
  }
  if (auto ok = clip.send(nullptr); !ok) return ok;
  const int trailer = av_write_trailer(clip.format.get()), closed = avio_closep(&clip.format->pb);
  if (trailer < 0 || closed < 0) return failed(path, "the disk is full or gone");
  return clip.pending.commit();
}

}  // namespace wisp
