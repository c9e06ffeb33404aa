#include "capture/media/libav.hpp"

#include <algorithm>
#include <cstring>
#include <mutex>

namespace wisp {
namespace {

// Container formats that may be opened. FFmpeg's others include playlists and scripts that make it open other files.
constexpr const char* kContainers =
    "mov,mp4,m4a,3gp,3g2,mj2,matroska,webm,avi,mpegts,mpeg,mpegvideo,flv,asf,ogg,nut,ivf,gif,apng,yuv4mpegpipe,h264,"
    "hevc,wav,w64,aiff,caf,flac,mp3,aac,au";

struct Options {
  AVDictionary* entries = nullptr;
  ~Options() { av_dict_free(&entries); }
};

Result<void> check_pictures(const std::string& name, const AVFormatContext& format) {
  for (unsigned k = 0; k < format.nb_streams; ++k) {
    const AVCodecParameters& picture = *format.streams[k]->codecpar;
    if (std::int64_t{picture.width} * picture.height <= kMaxFilmPixels) continue;
    return Error{name + ": its picture has " + std::to_string(picture.width) + " x " + std::to_string(picture.height) +
                 " pixels, expected at most 8192 x 4320; make it smaller"};
  }
  return {};
}

// Identifies the tracks. FFmpeg decodes some frames to do so, so this limits their size as open_decoder() does.
int look_at_tracks(AVFormatContext& format) {
  std::vector<AVDictionary*> options(format.nb_streams, nullptr);
  for (AVDictionary*& entries : options) av_dict_set_int(&entries, "max_pixels", kMaxFilmPixels, 0);
  const int code = avformat_find_stream_info(&format, options.data());
  for (AVDictionary*& entries : options) av_dict_free(&entries);
  return code;
}

}  // namespace

void silence_libav() {
  static std::once_flag once;
  std::call_once(once, [] { av_log_set_level(AV_LOG_QUIET); });
}

std::string libav_message(int code) {
  char buffer[AV_ERROR_MAX_STRING_SIZE] = {};
  av_strerror(code, buffer, sizeof buffer);
  return buffer;
}

Result<FormatOwner> open_media(const std::filesystem::path& path) {
  silence_libav();
  const std::string name = path.string();
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) return Error{name + ": no such file; check the path"};
  if (std::filesystem::is_directory(path, ignored)) return Error{name + ": found a folder, expected a media file"};
  if (!std::filesystem::is_regular_file(path, ignored)) {
    return Error{name + ": is no plain file but a device or a pipe, expected a media file"};
  }
  Options options;
  av_dict_set(&options.entries, "format_whitelist", kContainers, 0);
  av_dict_set(&options.entries, "protocol_whitelist", "file", 0);
  AVFormatContext* raw = nullptr;
  // Without the prefix "file:" a name with a colon would be parsed as a protocol.
  int code = avformat_open_input(&raw, ("file:" + name).c_str(), nullptr, &options.entries);
  if (code < 0) {
    return Error{name + ": cannot be read as video or sound (" + libav_message(code) +
                 "); it is of another kind, or was cut off before its index; give a file that plays"};
  }
  FormatOwner format(raw);
  if (auto ok = check_pictures(name, *format); !ok) return ok.error();
  code = look_at_tracks(*format);
  if (code < 0) return Error{name + ": no track can be read (" + libav_message(code) + "); give a file that plays"};
  return format;
}

double stated_seconds(const AVFormatContext& format, const AVStream& track) {
  if (format.duration == AV_NOPTS_VALUE || format.duration_estimation_method == AVFMT_DURATION_FROM_BITRATE) return 0;
  if (track.duration != AV_NOPTS_VALUE) return static_cast<double>(track.duration) * av_q2d(track.time_base);
  // Matroska's duration counts from 0, whatever the time of the first frame.
  const bool from_zero = std::strstr(format.iformat->name, "matroska") != nullptr;
  const std::int64_t before = from_zero && format.start_time != AV_NOPTS_VALUE ? format.start_time : 0;
  return std::max(0.0, static_cast<double>(format.duration - before) / AV_TIME_BASE);
}

double end_of(const AVFormatContext& format, const AVPacket& packet) {
  const double start = format.start_time == AV_NOPTS_VALUE ? 0 : static_cast<double>(format.start_time) / AV_TIME_BASE;
  const double tick = av_q2d(format.streams[packet.stream_index]->time_base);
  return packet.pts == AV_NOPTS_VALUE ? 0 : static_cast<double>(packet.pts + packet.duration) * tick - start;
}

int PacketReader::next(AVFormatContext* format, AVPacket* packet) {
  const int code = with_memory(av_read_frame, format, packet);
  if (code < 0 || (format->iformat->flags & AVFMT_TS_DISCONT) == 0 || packet->dts == AV_NOPTS_VALUE) return code;
  const AVStream& stream = *format->streams[packet->stream_index];
  const AVMediaType type = stream.codecpar->codec_type;
  if (type != AVMEDIA_TYPE_VIDEO && type != AVMEDIA_TYPE_AUDIO) return code;
  tracks_.resize(format->nb_streams);
  Track& track = tracks_[static_cast<std::size_t>(packet->stream_index)];
  const double tick = av_q2d(stream.time_base), decoded = static_cast<double>(packet->dts) * tick;
  const double begin = packet->pts == AV_NOPTS_VALUE ? decoded : static_cast<double>(packet->pts) * tick;
  const bool joined = decoded < track.last - 0.5;  // s: smaller steps back are errors of a muxer
  if (joined && ++track.part == shifts_.size()) shifts_.push_back(track.end - begin);
  const double shift = shifts_[track.part];
  track.last = decoded;
  track.end = std::max(track.end, begin + shift + static_cast<double>(packet->duration) * tick);
  packet->dts += std::llround(shift / tick);
  if (packet->pts != AV_NOPTS_VALUE) packet->pts += std::llround(shift / tick);
  return code;
}

void read_alone(AVFormatContext& format, int track) {
  const bool joined = (format.iformat->flags & AVFMT_TS_DISCONT) != 0;
  if (joined || format.streams[track]->duration == AV_NOPTS_VALUE) return;
  for (unsigned k = 0; k < format.nb_streams; ++k) {
    if (static_cast<int>(k) != track) format.streams[k]->discard = AVDISCARD_ALL;
  }
}

bool is_truncated(const AVFormatContext& format, int track, double end) {
  return end < 0.95 * stated_seconds(format, *format.streams[track]) - 0.1;  // tolerances: 5 % and 0.1 s
}

Result<CodecOwner> open_decoder(const std::filesystem::path& path, const AVStream& track, int threads) {
  const AVCodec* codec = avcodec_find_decoder(track.codecpar->codec_id);
  const std::string coded = avcodec_get_name(track.codecpar->codec_id);
  const bool sound = track.codecpar->codec_type == AVMEDIA_TYPE_AUDIO;
  const std::string cure = sound ? "; convert the sound to AAC, or leave it out" : "; convert it to H.264";
  if (codec == nullptr) {
    return Error{path.string() + (sound ? ": its sound is coded as " : ": coded as ") + coded +
                 ", which this FFmpeg cannot decode" + cure};
  }
  CodecOwner context(avcodec_alloc_context3(codec));
  if (!context || avcodec_parameters_to_context(context.get(), track.codecpar) < 0) {
    return Error{path.string() + ": not enough memory to decode " + coded};
  }
  context->thread_count = threads;
  context->max_pixels = kMaxFilmPixels;
  context->pkt_timebase = track.time_base;
  if (const int code = avcodec_open2(context.get(), codec, nullptr); code < 0) {
    return Error{path.string() + ": the decoder for " + coded + " does not start (" + libav_message(code) + ")" + cure};
  }
  return context;
}

}  // namespace wisp
