#include "capture/media/libav.hpp"

#include <mutex>

namespace wisp {
namespace {

void silence() {
  static std::once_flag once;
  std::call_once(once, [] { av_log_set_level(AV_LOG_QUIET); });
}

}  // namespace

std::string libav_message(int code) {
  char buffer[AV_ERROR_MAX_STRING_SIZE] = {};
  av_strerror(code, buffer, sizeof buffer);
  return buffer;
}

Result<FormatOwner> open_media(const std::filesystem::path& path) {
  silence();
  const std::string name = path.string();
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) return Error{name + ": no such file; check the path"};
  if (std::filesystem::is_directory(path, ignored)) {
    return Error{name + ": found a folder, expected a media file"};
  }
  AVFormatContext* raw = nullptr;
  int code = avformat_open_input(&raw, name.c_str(), nullptr, nullptr);
  if (code < 0) {
    return Error{name + ": cannot be read as video or sound (" + libav_message(code) +
                 "); it is of another kind, or was cut off before its index; give a file that plays"};
  }
  FormatOwner format(raw);
  code = avformat_find_stream_info(format.get(), nullptr);
  if (code < 0) return Error{name + ": no track can be read (" + libav_message(code) + "); give a file that plays"};
  return format;
}

Result<CodecOwner> open_decoder(const std::filesystem::path& path, const AVStream& track, int threads) {
  const AVCodec* codec = avcodec_find_decoder(track.codecpar->codec_id);
  const std::string coded = avcodec_get_name(track.codecpar->codec_id);
  if (codec == nullptr) {
    return Error{path.string() + ": coded as " + coded + ", which this FFmpeg cannot decode; convert it to H.264"};
  }
  CodecOwner context(avcodec_alloc_context3(codec));
  if (!context || avcodec_parameters_to_context(context.get(), track.codecpar) < 0) {
    return Error{path.string() + ": not enough memory to decode " + coded};
  }
  context->thread_count = threads;
  context->pkt_timebase = track.time_base;
  if (const int code = avcodec_open2(context.get(), codec, nullptr); code < 0) {
    return Error{path.string() + ": the decoder for " + coded + " does not start (" + libav_message(code) +
                 "); convert it to H.264"};
  }
  return context;
}

}  // namespace wisp
