#include "wisp/draw/film_strip.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/json_text.hpp"
#include "base/path_text.hpp"
#include "draw/film/libav_owners.hpp"
#include "record/number_text.hpp"
#include "wisp/base/file.hpp"
#include "wisp/draw/video_writer.hpp"

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

// Encodes a picture as PNG, whose opacity stays premultiplied; empty on failure.
std::vector<std::byte> png_bytes(const Image& image) {
  const Owned<AVCodecContext> codec(avcodec_alloc_context3(avcodec_find_encoder(AV_CODEC_ID_PNG)));
  const Owned<AVFrame> frame(av_frame_alloc());
  const Owned<AVPacket> packet(av_packet_alloc());
  codec->width = image.width();
  codec->height = image.height();
  codec->pix_fmt = AV_PIX_FMT_RGBA;
  codec->time_base = {1, 25};
  frame->format = codec->pix_fmt;
  frame->width = image.width();
  frame->height = image.height();
  std::vector<std::byte> bytes;
  if (av_frame_get_buffer(frame.get(), 0) < 0 || avcodec_open2(codec.get(), nullptr, nullptr) < 0) return bytes;
  for (int y = 0; y < image.height(); ++y) {
    std::uint8_t* out = frame->data[0] + static_cast<std::ptrdiff_t>(y) * frame->linesize[0];
    for (const std::uint32_t pixel : image.row(y)) {
      for (const int shift : {16, 8, 0, 24}) *out++ = static_cast<std::uint8_t>(pixel >> shift);
    }
  }
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

// Returns the smallest grid for all frames: of book.columns columns or, if these are 0, nearest to a square picture.
Grid grid_of(const Flipbook& book) {
  const auto count = static_cast<double>(book.frames.size());
  if (book.columns > 0) return {book.columns, static_cast<int>(std::ceil(count / book.columns))};
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
    for (int row = 0; row < height; ++row) std::ranges::copy(book.frames[k].row(row), atlas.row(y + row).begin() + x);
  }
  const auto bytes = png_bytes(atlas);
  if (bytes.empty()) return failed(path, "this FFmpeg has no encoder for PNG");
  if (auto ok = write_file(path, bytes); !ok) return ok;
  std::filesystem::path beside = path;
  return write_file(beside.replace_extension(".atlas.json"), atlas_json(path, book, grid));
}

Result<void> write_animation(const std::filesystem::path& path, const Flipbook& book) {
  if (auto ok = check(path, book); !ok) return ok;
  return write_animation(path, book, book.frames.size(), [&](std::size_t k) { return book.frames[k]; });
}

Result<void> write_animation(const std::filesystem::path& path, const Flipbook& book, std::size_t count,
                             const std::function<Image(std::size_t)>& frame) {
  if (path.extension() != ".webm" && path.extension() != ".apng") {
    return failed(path, "expected a name that ends in .apng or .webm");
  }
  if (count == 0) return failed(path, "there are no frames");
  Image image = frame(0);
  auto film = VideoWriter::create(
      path, {.width = image.width(), .height = image.height(), .rate_hz = book.rate_hz, .crf = 18, .loop = book.loop});
  if (!film) return film.error();
  for (std::size_t k = 0; k < count; ++k) {
    if (k > 0) image = frame(k);
    if (auto ok = film->write(image); !ok) return ok;
  }
  return film->finish();
}

}  // namespace wisp
