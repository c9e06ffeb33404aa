#pragma once
// FFmpeg's C interface with owners for what it allocates.

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
#include <cstdint>
#include <filesystem>
#include <memory>
#include <new>
#include <string>

#include "wisp/base/result.hpp"

namespace wisp {

/// Makes one of FFmpeg's calls and returns its code. Throws std::bad_alloc where the code, or errno, says that an
/// allocation failed in it: the file is not at fault, and leaving frames out would change what is measured. (FFmpeg's
/// H.264 decoder returns success where an allocation for a picture failed; malloc reports it in errno.) Every call that
/// may read or decode goes through it, the last, empty packet's too. errno belongs to the calling thread: what fails in
/// decoding threads is only seen where FFmpeg returns it.
template <class Call, class... Arguments>
int with_memory(Call call, Arguments... arguments) {
  errno = 0;  // encoders and malloc leave there what they got over
  const int code = call(arguments...);
  if (code == -ENOMEM || errno == ENOMEM) throw std::bad_alloc();
  return code;
}

struct FormatCloser {
  void operator()(AVFormatContext* format) const { avformat_close_input(&format); }
};
struct CodecCloser {
  void operator()(AVCodecContext* codec) const { avcodec_free_context(&codec); }
};
struct FrameCloser {
  void operator()(AVFrame* frame) const { av_frame_free(&frame); }
};
struct PacketCloser {
  void operator()(AVPacket* packet) const { av_packet_free(&packet); }
};
struct ScalerCloser {
  void operator()(SwsContext* scaler) const { sws_freeContext(scaler); }
};
struct ResamplerCloser {
  void operator()(SwrContext* resampler) const { swr_free(&resampler); }
};

using FormatOwner = std::unique_ptr<AVFormatContext, FormatCloser>;
using CodecOwner = std::unique_ptr<AVCodecContext, CodecCloser>;
using FrameOwner = std::unique_ptr<AVFrame, FrameCloser>;
using PacketOwner = std::unique_ptr<AVPacket, PacketCloser>;
using ScalerOwner = std::unique_ptr<SwsContext, ScalerCloser>;
using ResamplerOwner = std::unique_ptr<SwrContext, ResamplerCloser>;

/// More in an image is a damaged size, not a camera's: eight times 4K.
inline constexpr std::int64_t kMaxPixels = std::int64_t{1} << 26;

/// The same of a film's picture: 8K in its widest form, 8192 by 4320. A decoder keeps up to twenty of them, and a
/// black one of any size takes a few bytes of a file.
inline constexpr std::int64_t kMaxFilmPixels = 36'000'000;

/// From now on FFmpeg prints nothing itself.
void silence_libav();

/// FFmpeg's words for one of its error codes.
std::string libav_message(int code);

/// Opens a media file and reads what tracks it has. FFmpeg's own chatter on standard error is silenced: what matters
/// comes back as errors and warnings.
/// Nothing but the file itself is read, whatever it says: playlists and scripts are not media files here.
/// Errors: missing, a folder, a pipe or a device, not a media file, cut off before its index.
Result<FormatOwner> open_media(const std::filesystem::path& path);

/// A decoder for one track, opened with `threads` threads.
/// Errors: a codec that FFmpeg cannot decode.
Result<CodecOwner> open_decoder(const std::filesystem::path& path, const AVStream& track, int threads);

}  // namespace wisp
