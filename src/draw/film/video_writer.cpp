#include "wisp/draw/video_writer.hpp"

extern "C" {
#include <libavutil/channel_layout.h>
#include <libavutil/opt.h>
}

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <vector>

#include "draw/film/libav_owners.hpp"
#include "wisp/base/file.hpp"

namespace wisp {
namespace {

using drawing::Owned;

// Silences the information messages of x264 and AAC, but not their errors. The muxer has no log level of its own:
// QuietMuxer lowers the process's level for one call.
constexpr int kQuieter = AV_LOG_DEBUG - AV_LOG_INFO + 1;

class QuietMuxer {
 public:
  QuietMuxer() : before_(av_log_get_level()) { av_log_set_level(std::min(before_, AV_LOG_ERROR)); }
  ~QuietMuxer() { av_log_set_level(before_); }
  QuietMuxer(const QuietMuxer&) = delete;
  QuietMuxer& operator=(const QuietMuxer&) = delete;

 private:
  int before_;
};

std::string ffmpeg_reason(int code) {
  char text[AV_ERROR_MAX_STRING_SIZE] = {};
  av_strerror(code, text, sizeof text);
  return text;
}

struct Track {
  Owned<AVCodecContext> codec;
  AVStream* stream = nullptr;
  Owned<AVFrame> frame;
  std::int64_t next = 0;  // time of the next frame, in the encoder's time base
};

// Format of a film by the file name's ending. Unknown endings have the first of kKinds.
struct Kind {
  const char* ending;
  const char* muxer;
  const char* encoder;
  AVPixelFormat pixels;
};
constexpr std::array kKinds{Kind{".mp4", "mp4", "libx264", AV_PIX_FMT_YUV420P},
                            Kind{".webm", "webm", "libvpx-vp9", AV_PIX_FMT_YUVA420P},
                            Kind{".apng", "apng", "apng", AV_PIX_FMT_RGBA}};

const Kind& kind_of(const std::filesystem::path& path) {
  const auto found = std::ranges::find_if(kKinds, [&](const Kind& kind) { return path.extension() == kind.ending; });
  return found == kKinds.end() ? kKinds[0] : *found;
}

Error option_error(const std::filesystem::path& path, const std::string& what) {
  return {path.string() + ": cannot be encoded: " + what};
}

Result<void> check_options(const std::filesystem::path& path, const VideoWriterOptions& options) {
  constexpr int kLargestSide = 16384;
  if (options.width < 2 || options.height < 2 || options.width > kLargestSide || options.height > kLargestSide) {
    return option_error(path, "frames are " + std::to_string(options.width) + " x " + std::to_string(options.height) +
                                  " pixels, expected 2 to " + std::to_string(kLargestSide) + " each way");
  }
  if (!(options.rate_hz >= 0.1 && options.rate_hz <= 1000)) {
    return option_error(path,
                        "the rate is " + std::to_string(options.rate_hz) + " frames a second, expected 0.1 to 1000");
  }
  if (options.crf < 0 || options.crf > 51) {
    return option_error(path, "the rate factor (crf) is " + std::to_string(options.crf) + ", expected 0 to 51");
  }
  if (options.sound_rate_hz != 0 && (options.sound_rate_hz < 7350 || options.sound_rate_hz > 96000)) {
    return option_error(path, "the sound's rate is " + std::to_string(options.sound_rate_hz) +
                                  " Hz, expected 7350 to 96000 (or 0 for no sound)");
  }
  return {};
}

}  // namespace

struct VideoWriter::Encoder {
  Encoder(std::filesystem::path name, PendingFile pending_file, const VideoWriterOptions& video_options)
      : path(std::move(name)), kind(kind_of(path)), pending(std::move(pending_file)), options(video_options) {}

  std::filesystem::path path;
  const Kind& kind;
  PendingFile pending;
  VideoWriterOptions options;
  Owned<AVFormatContext> format;
  Owned<SwsContext> scaler;
  Owned<AVPacket> packet;
  Track video;
  Track sound;
  std::vector<float> waiting;         // samples that do not yet fill an encoder frame
  std::vector<std::uint32_t> pixels;  // a frame padded to even sides, or with straight (unpremultiplied) opacity
  bool finished = false;

  Error error(const std::string& what, int code) const {
    return {path.string() + ": " + what + ": " + ffmpeg_reason(code)};
  }

  Result<void> open();
  Result<void> open_video();
  Result<void> open_sound();
  Result<void> open_scaler();
  Result<void> start_track(Track& track, const AVCodec* codec, AVDictionary** settings);
  Result<void> next_frame();
  Result<void> send(Track& track, const AVFrame* frame);
  Result<void> send_sound();
  bool opacity() const { return kind.pixels != AV_PIX_FMT_YUV420P; }
  int padded_width() const { return options.width + (opacity() ? 0 : options.width % 2); }
  int padded_height() const { return options.height + (opacity() ? 0 : options.height % 2); }
};

Result<void> VideoWriter::Encoder::open() {
  AVFormatContext* made = nullptr;
  const std::string url = "file:" + pending.path().string();  // without "file:", a colon would end a protocol's name
  const int code = avformat_alloc_output_context2(&made, nullptr, kind.muxer, url.c_str());
  if (code < 0) return error("this FFmpeg cannot write such files", code);
  format.reset(made);
  packet.reset(av_packet_alloc());
  if (auto opened = open_video(); !opened) return opened;
  if (auto opened = open_scaler(); !opened) return opened;
  if (auto opened = options.sound_rate_hz > 0 ? open_sound() : Result<void>(); !opened) return opened;
  const int file = avio_open(&format->pb, url.c_str(), AVIO_FLAG_WRITE);
  if (file < 0) return error("cannot be written", file);
  AVDictionary* settings = nullptr;
  if (!opacity()) av_dict_set(&settings, "movflags", "+faststart", 0);
  if (kind.pixels == AV_PIX_FMT_RGBA) av_dict_set_int(&settings, "plays", options.loop ? 0 : 1, 0);
  const int header = avformat_write_header(format.get(), &settings);
  av_dict_free(&settings);
  if (header < 0) return error("cannot be written", header);
  return {};
}

Result<void> VideoWriter::Encoder::open_video() {
  const AVCodec* codec = avcodec_find_encoder_by_name(kind.encoder);
  if (!codec) return option_error(path, std::string("this FFmpeg has no encoder ") + kind.encoder);
  video.codec.reset(avcodec_alloc_context3(codec));
  AVCodecContext& context = *video.codec;
  context.width = padded_width();
  context.height = padded_height();
  context.pix_fmt = kind.pixels;
  context.framerate = av_d2q(options.rate_hz, 1001000);
  context.time_base = av_inv_q(context.framerate);
  if (kind.pixels != AV_PIX_FMT_RGBA) {
    context.color_range = AVCOL_RANGE_MPEG;
    context.color_primaries = AVCOL_PRI_BT709;
    context.color_trc = AVCOL_TRC_BT709;
    context.colorspace = AVCOL_SPC_BT709;
  }
  context.thread_count = options.threads;
  AVDictionary* settings = nullptr;
  av_dict_set_int(&settings, "crf", options.crf, 0);
  if (opacity()) {
    av_dict_set(&settings, "auto-alt-ref", "0", 0);  // VP9 with opacity does not support hidden frames
    context.bit_rate = 0;
  } else {
    // Preset "medium" at crf 17 looks the same in three fifths of the file size, but takes twice the time.
    av_dict_set(&settings, "preset", "veryfast", 0);
    // Spends more bits on dark, smooth areas, where a halo would otherwise break into steps.
    av_dict_set(&settings, "x264-params", "aq-mode=3", 0);
  }
  auto started = start_track(video, codec, &settings);
  av_dict_free(&settings);
  if (!started) return started;
  video.stream->avg_frame_rate = context.framerate;
  if (kind.pixels == AV_PIX_FMT_YUVA420P) av_dict_set(&video.stream->metadata, "alpha_mode", "1", 0);
  AVFrame& frame = *video.frame;
  frame.format = context.pix_fmt;
  frame.width = context.width;
  frame.height = context.height;
  frame.color_range = context.color_range;
  frame.colorspace = context.colorspace;
  const int code = av_frame_get_buffer(&frame, 0);
  if (code < 0) return error("cannot be encoded", code);
  return {};
}

Result<void> VideoWriter::Encoder::open_sound() {
  const AVCodec* codec = avcodec_find_encoder(AV_CODEC_ID_AAC);
  if (codec == nullptr) return option_error(path, "this FFmpeg has no AAC encoder; install one that has");
  sound.codec.reset(avcodec_alloc_context3(codec));
  AVCodecContext& context = *sound.codec;
  context.sample_fmt = AV_SAMPLE_FMT_FLTP;
  context.sample_rate = options.sound_rate_hz;
  context.bit_rate = 160000;
  context.time_base = {1, options.sound_rate_hz};
  av_channel_layout_default(&context.ch_layout, 1);
  return start_track(sound, codec, nullptr);
}

Result<void> VideoWriter::Encoder::start_track(Track& track, const AVCodec* codec, AVDictionary** settings) {
  AVCodecContext& context = *track.codec;
  context.log_level_offset = kQuieter;
  if ((format->oformat->flags & AVFMT_GLOBALHEADER) != 0) context.flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
  const int code = avcodec_open2(&context, codec, settings);
  if (code < 0) return error("cannot be encoded as " + std::string(codec->name), code);
  track.stream = avformat_new_stream(format.get(), nullptr);
  track.stream->time_base = context.time_base;
  const int copied = avcodec_parameters_from_context(track.stream->codecpar, &context);
  if (copied < 0) return error("cannot be encoded", copied);
  track.frame.reset(av_frame_alloc());
  return {};
}

Result<void> VideoWriter::Encoder::open_scaler() {
  const int width = padded_width(), height = padded_height();
  // Averages subsampled chroma, and rounds accurately, as flames are mostly dark gradients.
  constexpr int kQuality = SWS_BICUBIC | SWS_ACCURATE_RND | SWS_FULL_CHR_H_INP;
  scaler.reset(
      sws_getContext(width, height, AV_PIX_FMT_BGRA, width, height, kind.pixels, kQuality, nullptr, nullptr, nullptr));
  if (!scaler) return option_error(path, "no conversion from pictures to video");
  const int* coefficients = sws_getCoefficients(SWS_CS_ITU709);
  sws_setColorspaceDetails(scaler.get(), coefficients, 1, coefficients, 0, 0, 1 << 16, 1 << 16);
  return {};
}

Result<void> VideoWriter::Encoder::next_frame() {
  if (finished) return Error{path.string() + ": is finished already; nothing can be added"};
  const int code = av_frame_make_writable(video.frame.get());
  if (code < 0) return error("cannot be encoded", code);
  video.frame->pts = video.next++;
  return {};
}

Result<void> VideoWriter::Encoder::send(Track& track, const AVFrame* frame) {
  int code = avcodec_send_frame(track.codec.get(), frame);
  if (code < 0) return error("cannot be encoded", code);
  for (;;) {
    code = avcodec_receive_packet(track.codec.get(), packet.get());
    if (code == AVERROR(EAGAIN) || code == AVERROR_EOF) return {};
    if (code < 0) return error("cannot be encoded", code);
    if (packet->duration == 0 && &track == &video) packet->duration = 1;
    av_packet_rescale_ts(packet.get(), track.codec->time_base, track.stream->time_base);
    packet->stream_index = track.stream->index;
    code = av_interleaved_write_frame(format.get(), packet.get());
    if (code >= 0 && format->pb->error < 0) code = format->pb->error;
    if (code < 0) return error("cannot be written whole", code);
  }
}

Result<void> VideoWriter::Encoder::send_sound() {
  AVFrame& frame = *sound.frame;
  av_frame_unref(&frame);
  frame.format = sound.codec->sample_fmt;
  frame.sample_rate = options.sound_rate_hz;
  frame.nb_samples = static_cast<int>(waiting.size());
  av_channel_layout_copy(&frame.ch_layout, &sound.codec->ch_layout);
  const int code = av_frame_get_buffer(&frame, 0);
  if (code < 0) return error("cannot be encoded", code);
  std::memcpy(frame.data[0], waiting.data(), waiting.size() * sizeof(float));
  frame.pts = sound.next;
  sound.next += frame.nb_samples;
  waiting.clear();
  return send(sound, &frame);
}

VideoWriter::VideoWriter(std::unique_ptr<Encoder> encoder) : encoder_(std::move(encoder)) {}
VideoWriter::VideoWriter(VideoWriter&&) noexcept = default;
VideoWriter& VideoWriter::operator=(VideoWriter&&) noexcept = default;
VideoWriter::~VideoWriter() = default;

Result<VideoWriter> VideoWriter::create(const std::filesystem::path& path, const VideoWriterOptions& options) {
  if (auto checked = check_options(path, options); !checked) return checked.error();
  auto pending = PendingFile::create(path);
  if (!pending) return pending.error();
  auto encoder = std::make_unique<Encoder>(path, *std::move(pending), options);
  if (auto opened = encoder->open(); !opened) return opened.error();
  return VideoWriter(std::move(encoder));
}

Result<void> VideoWriter::write(const Image& image) {
  Encoder& e = *encoder_;
  if (image.width() != e.options.width || image.height() != e.options.height) {
    return Error{e.path.string() + ": frame " + std::to_string(e.video.next) + " is " + std::to_string(image.width()) +
                 " x " + std::to_string(image.height()) + " pixels, expected " + std::to_string(e.options.width) +
                 " x " + std::to_string(e.options.height)};
  }
  if (auto ready = e.next_frame(); !ready) return ready;
  const int width = e.padded_width(), height = e.padded_height();
  const bool copied = e.opacity() || width != image.width() || height != image.height();
  if (copied) e.pixels.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  for (int y = 0; copied && y < height; ++y) {
    const auto from = image.row(std::min(y, image.height() - 1));
    for (int x = 0; x < width; ++x) {
      std::uint32_t& to = e.pixels[static_cast<std::size_t>(y) * width + x];
      to = from[std::min(x, image.width() - 1)];
      if (!e.opacity()) continue;
      const Colour straight = image.at(x, y);
      to = (to & 0xff000000U) | static_cast<std::uint32_t>(straight.red << 16 | straight.green << 8 | straight.blue);
    }
  }
  const std::uint32_t* pixels = copied ? e.pixels.data() : image.pixels().data();
  const std::uint8_t* rows[4] = {reinterpret_cast<const std::uint8_t*>(pixels)};
  const int strides[4] = {width * 4};
  sws_scale(e.scaler.get(), rows, strides, 0, e.padded_height(), e.video.frame->data, e.video.frame->linesize);
  return e.send(e.video, e.video.frame.get());
}

Result<void> VideoWriter::write_sound(std::span<const float> samples) {
  Encoder& e = *encoder_;
  if (!e.sound.codec) return Error{e.path.string() + ": has no sound track; set its rate when the file is opened"};
  if (e.finished) return Error{e.path.string() + ": is finished already; nothing can be added"};
  const auto whole = static_cast<std::size_t>(e.sound.codec->frame_size);
  for (const float sample : samples) {
    e.waiting.push_back(std::isnan(sample) ? 0.0F : std::clamp(sample, -1.0F, 1.0F));
    if (e.waiting.size() < whole) continue;
    if (auto sent = e.send_sound(); !sent) return sent;
  }
  return {};
}

Result<void> VideoWriter::finish() {
  Encoder& e = *encoder_;
  if (e.finished) return Error{e.path.string() + ": is finished already"};
  if (e.video.next == 0) return Error{e.path.string() + ": no frame was written, so there is no video to finish"};
  e.finished = true;
  if (auto sent = e.send(e.video, nullptr); !sent) return sent;
  if (e.sound.codec) {
    if (!e.waiting.empty()) {
      if (auto sent = e.send_sound(); !sent) return sent;
    }
    if (auto sent = e.send(e.sound, nullptr); !sent) return sent;
  }
  const QuietMuxer quiet;
  const int trailer = av_write_trailer(e.format.get());
  const int flushed = e.format->pb->error;
  const int closed = avio_closep(&e.format->pb);
  for (const int code : {trailer, flushed, closed}) {
    if (code < 0) return e.error("cannot be written whole", code);
  }
  return e.pending.commit();
}

}  // namespace wisp
