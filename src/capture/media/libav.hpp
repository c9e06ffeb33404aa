#pragma once
// FFmpeg's C interface, with owning types for its allocations.

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/display.h>
#include <libavutil/imgutils.h>
#include <libavutil/pixdesc.h>
#include <libswresample/swresample.h>
#include <libswscale/swscale.h>
}

#include <cerrno>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <new>
#include <string>
#include <vector>

#include "wisp/base/result.hpp"

namespace wisp {

/// Calls an FFmpeg function and returns its code. Throws std::bad_alloc if the code or errno reports a failed
/// allocation: the file is not at fault, and skipping frames would change the measurement. (FFmpeg's H.264 decoder
/// reports a failed allocation only in errno.) Once a film or sound is open, this wrapper is used for every call that
/// may read or decode it, also to send the final empty packet. errno is per thread: a failure in a decoding thread is
/// seen only if FFmpeg returns it.
template <class Call, class... Arguments>
int with_memory(Call call, Arguments... arguments) {
  errno = 0;  // earlier calls leave errors there that they recovered from
  const int code = call(arguments...);
  if (code == -ENOMEM || errno == ENOMEM) throw std::bad_alloc();
  return code;
}

struct LibavCloser {
  void operator()(AVFormatContext* format) const { avformat_close_input(&format); }
  void operator()(AVCodecContext* codec) const { avcodec_free_context(&codec); }
  void operator()(AVFrame* frame) const { av_frame_free(&frame); }
  void operator()(AVPacket* packet) const { av_packet_free(&packet); }
  void operator()(SwsContext* scaler) const { sws_freeContext(scaler); }
  void operator()(SwrContext* resampler) const { swr_free(&resampler); }
};

using FormatOwner = std::unique_ptr<AVFormatContext, LibavCloser>;
using CodecOwner = std::unique_ptr<AVCodecContext, LibavCloser>;
using FrameOwner = std::unique_ptr<AVFrame, LibavCloser>;
using PacketOwner = std::unique_ptr<AVPacket, LibavCloser>;
using ScalerOwner = std::unique_ptr<SwsContext, LibavCloser>;
using ResamplerOwner = std::unique_ptr<SwrContext, LibavCloser>;

/// Maximum pixels of an image, eight times 4K: a larger size is corrupt.
inline constexpr std::int64_t kMaxPixels = std::int64_t{1} << 26;

/// Maximum pixels of a film's picture: 8K in its widest form, 8192 by 4320. A decoder keeps up to twenty pictures, and
/// a black picture of any size takes only a few bytes in a file.
inline constexpr std::int64_t kMaxFilmPixels = 36'000'000;

/// Disables FFmpeg's own messages from now on.
void silence_libav();

/// FFmpeg's text for an error code.
std::string libav_message(int code);

/// Opens a media file and reads its list of tracks. FFmpeg's own messages on standard error are disabled. Only the file
/// itself is read, whatever it refers to: playlists and scripts are not accepted. Errors: missing, a folder, a pipe or
/// a device, not a media file, truncated before its index, a picture of more than kMaxFilmPixels.
Result<FormatOwner> open_media(const std::filesystem::path& path);

/// Returns the stated duration of a track, else of the file (its longest track), in seconds; 0: none is stated.
double stated_seconds(const AVFormatContext& format, const AVStream& track);

/// Discards packets of other tracks, unless the track states no duration, when is_truncated() compares the end of all
/// packets with the file's duration, or its parts may have been joined, for which PacketReader needs all tracks.
void read_alone(AVFormatContext& format, int track);

/// Reads packets in order. In files joined by `cat` (MPEG, Ogg), each part has its own times: at the first track whose
/// times jump back, that track continues at its end, and all tracks of the part are shifted by as much.
class PacketReader {
 public:
  /// Reads the next packet as av_read_frame() does; returns its code.
  int next(AVFormatContext* format, AVPacket* packet);

 private:
  struct Track {
    double last = -HUGE_VAL, end = 0;  // stated decoding time of the last packet; end, shifted; seconds
    std::size_t part = 0;
  };
  std::vector<Track> tracks_;
  std::vector<double> shifts_{0};  // of each part, seconds
};

/// End of a packet, in seconds after the file's beginning; 0 where its time is unknown.
double end_of(const AVFormatContext& format, const AVPacket& packet);

/// Returns whether the file is truncated: its last packet ends at `end` seconds, well before the stated duration.
bool is_truncated(const AVFormatContext& format, int track, double end);

/// Opens a decoder with `threads` threads for one track. Errors: a codec that FFmpeg cannot decode.
Result<CodecOwner> open_decoder(const std::filesystem::path& path, const AVStream& track, int threads);

}  // namespace wisp
