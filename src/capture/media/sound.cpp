#include "wisp/capture/media/sound.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "capture/clip/clip_ear.hpp"
#include "capture/media/libav.hpp"

namespace wisp {
namespace {

// A sound track being decoded to blocks of floats.
struct SoundTrack {
  FormatOwner format;
  CodecOwner codec;
  ResamplerOwner resampler;
  PacketOwner packet{av_packet_alloc()};
  FrameOwner frame{av_frame_alloc()};
  int track = -1;
  SoundInfo info;
  double first_picture = 0;   // time of the first picture on the file's clock, seconds
  std::optional<double> now;  // time of the next sample, seconds after the first picture
  std::vector<float> samples;
};

double start_of(const AVStream& track) {
  return track.start_time == AV_NOPTS_VALUE ? 0 : static_cast<double>(track.start_time) * av_q2d(track.time_base);
}

// Returns the start of the video track (without one, of the sound) on the file's clock, seconds.
double first_picture(AVFormatContext& format, const AVStream& sound) {
  const int video = av_find_best_stream(&format, AVMEDIA_TYPE_VIDEO, -1, -1, nullptr, 0);
  return start_of(video < 0 ? sound : *format.streams[video]);
}

// Sets the block's start: the end of the block before, unless the time stamp is over kJitter off, as after lost sound.
void take_time(SoundTrack& track) {
  const AVFrame& frame = *track.frame;
  if (frame.best_effort_timestamp != AV_NOPTS_VALUE) {
    const double stamped =
        static_cast<double>(frame.best_effort_timestamp) * av_q2d(track.codec->pkt_timebase) - track.first_picture;
    if (!track.now || std::abs(stamped - *track.now) > ClipEar::kJitter) track.now = stamped;
  }
  track.info.begin = track.now.value_or(track.info.begin);
  track.now = track.info.begin + static_cast<double>(frame.nb_samples) / track.info.rate_hz;
}

// Sets up conversion from any sample format, planar or packed, to packed floats at unchanged rate and channels.
bool start_resampler(SoundTrack& track) {
  AVFrame& frame = *track.frame;
  SwrContext* raw = nullptr;
  const auto format = static_cast<AVSampleFormat>(frame.format);
  const int code = with_memory(swr_alloc_set_opts2, &raw, &frame.ch_layout, AV_SAMPLE_FMT_FLT, frame.sample_rate,
                               &frame.ch_layout, format, frame.sample_rate, 0, nullptr);
  track.resampler.reset(raw);
  track.info.rate_hz = frame.sample_rate;
  return code >= 0 && with_memory(swr_init, raw) >= 0;
}

// Converts the decoded frame to floats and passes them to `block`. Returns whether to continue.
bool hand_out(SoundTrack& track, const SoundBlock& block) {
  const AVFrame& frame = *track.frame;
  if (!track.resampler && !start_resampler(track)) return false;
  const bool same = frame.ch_layout.nb_channels == track.info.channels && frame.sample_rate == track.info.rate_hz;
  if (!same) return true;  // ignores a block of another format
  take_time(track);
  track.samples.resize(static_cast<std::size_t>(frame.nb_samples) * track.info.channels);
  std::uint8_t* out[1] = {reinterpret_cast<std::uint8_t*>(track.samples.data())};
  const int got = with_memory(swr_convert, track.resampler.get(), out, frame.nb_samples,
                              const_cast<const std::uint8_t**>(frame.extended_data), frame.nb_samples);
  if (got < 0) return true;
  track.samples.resize(static_cast<std::size_t>(got) * track.info.channels);
  for (float& sample : track.samples) {
    if (!std::isfinite(sample)) sample = 0;
    track.info.peak = std::max(track.info.peak, std::abs(sample));
  }
  track.info.samples += static_cast<std::size_t>(got);
  return block(track.info, track.samples);
}

bool drain(SoundTrack& track, const SoundBlock& block) {
  while (with_memory(avcodec_receive_frame, track.codec.get(), track.frame.get()) >= 0) {
    if (!hand_out(track, block)) return false;
  }
  return true;
}

void decode_all(SoundTrack& track, const SoundBlock& block) {
  double end = 0;
  for (PacketReader packets; packets.next(track.format.get(), track.packet.get()) >= 0;) {
    end = std::max(end, end_of(*track.format, *track.packet));
    if (track.packet->stream_index == track.track) {
      track.info.cut = (track.packet->flags & AV_PKT_FLAG_CORRUPT) != 0;
      with_memory(avcodec_send_packet, track.codec.get(), track.packet.get());
    }
    av_packet_unref(track.packet.get());
    if (!drain(track, block)) return;
  }
  track.info.cut = track.info.cut || is_truncated(*track.format, track.track, end);
  with_memory(avcodec_send_packet, track.codec.get(), nullptr);
  drain(track, block);
}

}  // namespace

Result<std::optional<SoundInfo>> stream_sound(const std::filesystem::path& path, const SoundBlock& block) {
  SoundTrack track;
  auto format = open_media(path);
  if (!format) return format.error();
  track.format = std::move(format).value();
  track.track = av_find_best_stream(track.format.get(), AVMEDIA_TYPE_AUDIO, -1, -1, nullptr, 0);
  if (track.track < 0) return std::optional<SoundInfo>();
  read_alone(*track.format, track.track);
  const AVStream& sound = *track.format->streams[track.track];
  auto codec = open_decoder(path, sound, 1);
  if (!codec) return codec.error();
  track.codec = std::move(codec).value();
  track.info.rate_hz = track.codec->sample_rate;
  track.info.channels = track.codec->ch_layout.nb_channels;
  track.first_picture = first_picture(*track.format, sound);
  track.info.begin = start_of(sound) - track.first_picture;
  if (track.info.channels < 1 || track.info.rate_hz <= 0) {
    return Error{path.string() + ": the sound track states no rate or no channels; convert it to WAV"};
  }
  const double begin = track.info.begin;
  decode_all(track, block);
  track.info.begin = begin;
  return std::optional<SoundInfo>(track.info);
}

}  // namespace wisp
