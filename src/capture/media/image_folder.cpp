#include "capture/media/video_sources.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstring>
#include <limits>
#include <span>
#include <string_view>
#include <tuple>

#include "wisp/base/file.hpp"

namespace wisp {
namespace {

struct ImageKind {
  std::string_view extension;
  AVCodecID codec;
};

constexpr std::array<ImageKind, 9> kKinds{{{".png", AV_CODEC_ID_PNG},
                                           {".jpg", AV_CODEC_ID_MJPEG},
                                           {".jpeg", AV_CODEC_ID_MJPEG},
                                           {".pgm", AV_CODEC_ID_PGM},
                                           {".ppm", AV_CODEC_ID_PPM},
                                           {".pnm", AV_CODEC_ID_PPM},
                                           {".bmp", AV_CODEC_ID_BMP},
                                           {".tif", AV_CODEC_ID_TIFF},
                                           {".tiff", AV_CODEC_ID_TIFF}}};

// Maximum size of an image file; a larger one is no frame of a clip.
constexpr std::size_t kMaxImageBytes = std::size_t{256} << 20;

std::string lower(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

AVCodecID codec_of(const std::filesystem::path& path) {
  const std::string extension = lower(path.extension().string());
  for (const ImageKind& kind : kKinds) {
    if (kind.extension == extension) return kind.codec;
  }
  return AV_CODEC_ID_NONE;
}

// Returns a group of adjacent digits in the file's name: 0 is the last, 1 the last but one. Empty if there is none.
std::string digits_in(const std::filesystem::path& path, int group = 0) {
  constexpr const char* kDigits = "0123456789";
  std::string stem = path.stem().string();
  for (;; --group) {
    stem.resize(stem.find_last_of(kDigits) + 1);  // npos + 1 is 0
    const std::size_t begin = stem.find_last_not_of(kDigits) + 1;
    if (group == 0 || stem.empty()) return stem.substr(begin);
    stem.resize(begin);
  }
}

// Returns the last group of digits in which the images' names differ: equal groups state a size or the image count.
int counting_group(const std::vector<std::filesystem::path>& images) {
  for (int group = 0; !digits_in(images.front(), group).empty(); ++group) {
    const auto differs = [&](const auto& path) { return digits_in(path, group) != digits_in(images.front(), group); };
    if (std::any_of(images.begin(), images.end(), differs)) return group;
  }
  return 0;
}

// Returns whether a PNG or JPEG file is truncated: decoders would fill the missing part with grey.
bool is_cut(std::span<const std::byte> bytes, AVCodecID codec) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  if (codec == AV_CODEC_ID_PNG) return text.rfind("IDAT") != text.npos && text.rfind("IEND") == text.npos;
  if (codec != AV_CODEC_ID_MJPEG) return false;
  // Skips the segments before the first scan: one may hold a small picture. Behind the end, a phone may add a film.
  const auto byte = [&](std::size_t k) { return std::to_integer<std::size_t>(bytes[k]); };
  std::size_t scan = 2;
  while (scan + 4 <= text.size() && byte(scan + 1) != 0xda) scan += 2 + (byte(scan + 2) << 8 | byte(scan + 3));
  return scan + 4 <= text.size() && byte(scan) == 0xff && text.find("\xff\xd9", scan) == text.npos;
}

std::string pixels(int width, int height) { return std::to_string(width) + " x " + std::to_string(height) + " pixels"; }

}  // namespace

bool ImageFolder::reads(const std::filesystem::path& path) {
  // Some systems put metadata files beside copied images, such as ._001.jpg
  return codec_of(path) != AV_CODEC_ID_NONE && !digits_in(path).empty() && !path.filename().string().starts_with('.');
}

Result<std::vector<ImageFolder::NumberedImage>> ImageFolder::list(const std::filesystem::path& path) {
  std::vector<std::filesystem::path> paths;
  std::error_code code;
  for (const auto& entry : std::filesystem::directory_iterator(path, code)) {
    if (reads(entry.path())) paths.push_back(entry.path());
  }
  if (code) return Error{path.string() + ": the folder cannot be read (" + code.message() + ")"};
  if (paths.empty()) {
    return Error{path.string() +
                 ": found no numbered images in the folder, expected PNG, JPEG, PGM, PPM, BMP or TIFF " +
                 "such as 000.png"};
  }
  std::vector<NumberedImage> images;
  for (const int group = counting_group(paths); const auto& image : paths) {
    const std::string digits = digits_in(image, group);
    if (digits.empty() || digits.size() > 18) {  // 18 fit in 64 bits
      return Error{image.string() + ": its number has " + std::to_string(digits.size()) +
                   " digits, expected 1 to 18; number the images by frames"};
    }
    std::error_code ignored;
    if (!is_regular_file(image, ignored)) {
      return Error{image.string() + ": is no plain file, expected an image; remove it from the folder"};
    }
    images.push_back({image, std::stoll(digits), 0});
  }
  std::sort(images.begin(), images.end(), [](const NumberedImage& a, const NumberedImage& b) {
    return a.number != b.number ? a.number < b.number : a.path < b.path;
  });
  for (std::size_t k = 1; k < images.size(); ++k) {
    if (images[k].number != images[k - 1].number) continue;
    return Error{images[k].path.string() + ": has the same number as " + images[k - 1].path.filename().string() +
                 "; keep one clip in a folder"};
  }
  return images;
}

// Sets the images' indices: the smallest step between two numbers is one frame, larger steps contain lost frames.
void ImageFolder::place(std::vector<NumberedImage>& images) {
  std::int64_t step = std::numeric_limits<std::int64_t>::max();
  for (std::size_t k = 1; k < images.size(); ++k) step = std::min(step, images[k].number - images[k - 1].number);
  const auto longest =
      static_cast<std::int64_t>(std::ceil(std::min(FrameGrid::kLongestGapSeconds * info_.rate_hz, 1e6)));
  for (std::size_t k = 1; k < images.size(); ++k) {
    const std::int64_t way = (images[k].number - images[k - 1].number) / step;
    if (way > longest + 1) ++long_gaps_;
    images[k].index = images[k - 1].index + std::min(way, longest + 1);
  }
}

Result<ImageFolder> ImageFolder::open(const std::filesystem::path& path, const VideoOptions& options) {
  if (!(options.rate_hz > 0))
    return Error{path.string() + ": a folder of images has no rate of its own; give --rate HZ"};
  silence_libav();
  auto images = list(path);
  if (!images) return images.error();
  ImageFolder folder;
  folder.images_ = std::move(images).value();
  folder.path_ = path;
  folder.info_.rate_hz = options.rate_hz;
  folder.place(folder.images_);
  if (options.frames) {
    const std::int64_t last = folder.images_.back().index + 1;
    const auto [first_wanted, last_wanted] = *options.frames;
    if (last_wanted > last) {
      return Error{path.string() + ": found " + std::to_string(last) + " frames, expected frames " +
                   std::to_string(first_wanted) + ":" + std::to_string(last_wanted) + "; give a range inside the clip"};
    }
    std::erase_if(folder.images_, [&](const NumberedImage& image) {
      return image.index + 1 < options.frames->first || image.index + 1 > options.frames->last;
    });
  }
  folder.packet_.reset(av_packet_alloc());
  folder.frame_.reset(av_frame_alloc());
  folder.info_.frames = static_cast<std::int64_t>(folder.images_.size());
  folder.info_.images = true;
  folder.pictures_ = FramePictures(options.turn);
  if (folder.images_.empty()) return folder;
  if (auto decoded = folder.decode(folder.images_.front().path); !decoded) return decoded.error();
  std::tie(folder.info_.width, folder.info_.height) =
      folder.pictures_.shown(folder.frame_->width, folder.frame_->height);
  return folder;
}

Result<void> ImageFolder::decode(const std::filesystem::path& path) {
  const auto bytes = read_file(path, kMaxImageBytes);
  if (!bytes) return bytes.error();
  const AVCodecID id = codec_of(path);
  if (is_cut(*bytes, id)) return Error{path.string() + ": the image is cut short; remove or replace it"};
  if (!codec_ || codec_->codec_id != id) {
    const AVCodec* codec = avcodec_find_decoder(id);
    codec_.reset(codec == nullptr ? nullptr : avcodec_alloc_context3(codec));
    if (codec_) codec_->thread_count = 1;
    if (codec_) codec_->max_pixels = kMaxPixels;
    if (!codec_ || avcodec_open2(codec_.get(), codec, nullptr) < 0) {
      return Error{path.string() + ": this FFmpeg cannot decode such images; convert them to PNG"};
    }
  }
  avcodec_flush_buffers(codec_.get());
  if (av_new_packet(packet_.get(), static_cast<int>(bytes->size())) < 0) {
    return Error{path.string() + ": not enough memory to read the image"};
  }
  std::memcpy(packet_->data, bytes->data(), bytes->size());
  packet_->flags |= AV_PKT_FLAG_KEY;  // otherwise the PNG decoder treats it as a difference to the last image
  int code = with_memory(avcodec_send_packet, codec_.get(), packet_.get());
  av_packet_unref(packet_.get());
  if (code >= 0) code = with_memory(avcodec_receive_frame, codec_.get(), frame_.get());
  if (code == AVERROR(EAGAIN)) {
    with_memory(avcodec_send_packet, codec_.get(), nullptr);
    code = with_memory(avcodec_receive_frame, codec_.get(), frame_.get());
  }
  if (code < 0) {
    return Error{path.string() + ": the image cannot be decoded (" + libav_message(code) +
                 "): it is damaged, or larger than 8192 x 8192 pixels; remove or replace it"};
  }
  return {};
}

std::vector<std::string> ImageFolder::warnings() const {
  if (long_gaps_ == 0) return {};
  return {path_.string() + ": " + std::to_string(long_gaps_) + (long_gaps_ == 1 ? " hole" : " holes") +
          " of more than 2 s in the images' numbers taken as 2 s"};
}

Result<std::optional<VideoFrame>> ImageFolder::next() {
  if (at_ == images_.size()) return std::optional<VideoFrame>();
  const NumberedImage& image = images_[at_++];
  if (auto decoded = decode(image.path); !decoded) return decoded.error();
  const auto [width, height] = pictures_.shown(frame_->width, frame_->height);
  if (width != info_.width || height != info_.height) {
    return Error{image.path.string() + ": found " + pixels(width, height) + ", expected " +
                 pixels(info_.width, info_.height) + " as in " + images_.front().path.filename().string() +
                 "; keep images of one size in a folder"};
  }
  auto picture = pictures_.view(*frame_);
  if (!picture) return Error{image.path.string() + ": " + picture.error().message};
  return std::optional<VideoFrame>(VideoFrame{*picture, image.index});
}

}  // namespace wisp
