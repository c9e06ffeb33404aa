#include "capture/media/video_sources.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "base/statistics.hpp"
#include "record/number_text.hpp"

namespace wisp {
namespace {

// Hz: a higher frame rate is the file's time base, not a camera's rate.
constexpr double kHighestRate = 1000;

// Maximum pixel aspect ratio; a larger one comes from a corrupt header.
constexpr double kWidestPixel = 8;

// Returns the display times of a track's frames in seconds, ascending, without decoding.
std::vector<double> frame_times(const std::filesystem::path& path, int track) {
  std::vector<double> times;
  auto format = open_media(path);
  if (!format) return times;
  const double tick = av_q2d((*format)->streams[track]->time_base);
  const PacketOwner packet(av_packet_alloc());
  for (PacketReader packets; packets.next(format->get(), packet.get()) >= 0;) {
    const bool shown = packet->stream_index == track && (packet->flags & AV_PKT_FLAG_DISCARD) == 0;
    if (shown && packet->pts != AV_NOPTS_VALUE) times.push_back(static_cast<double>(packet->pts) * tick);
    av_packet_unref(packet.get());
  }
  std::sort(times.begin(), times.end());
  return times;
}

// Returns the most common frame rate of an irregular film, rounded to a likely rate: times are often in whole ms.
double usual_rate(const std::vector<double>& times, double nominal, double average) {
  std::vector<double> steps;
  for (std::size_t k = 1; k < times.size(); ++k) {
    if (times[k] > times[k - 1]) steps.push_back(times[k] - times[k - 1]);
  }
  if (steps.empty()) return average > 0 ? average : nominal;
  // Averages the intervals near the median, so that jitter cancels; excludes lost frames and a halved rate in the dark.
  const double usual = median(steps);
  std::erase_if(steps, [&](double one) { return one < 0.4 * usual || one > 1.6 * usual; });
  const double step = mean(steps);
  const auto near = [&](double rate, double share) { return rate > 0 && std::abs(rate * step - 1) < share; };
  for (int part = 1; part <= 8; ++part) {
    if (nominal < kHighestRate && near(nominal / part, 0.01)) return nominal / part;
  }
  if (near(average, 0.01)) return average;
  for (const double rate : {24.0, 25.0, 30.0, 48.0, 50.0, 60.0, 100.0, 120.0, 240.0}) {
    if (near(rate, 0.05)) return rate;
  }
  return 1 / step;
}

// Returns the rate of the frames' grid: the nominal rate (the lowest that represents all times), or the most common
// rate if the nominal one exceeds kHighestRate or a third or more of its frames are missing.
double grid_rate(const std::filesystem::path& path, const AVStream& track) {
  const double nominal = av_q2d(track.r_frame_rate), mean = av_q2d(track.avg_frame_rate);
  const bool plausible = nominal > 0 && nominal <= kHighestRate;
  if (plausible && (!(mean > 0) || nominal / mean < 1.5)) return nominal;
  return usual_rate(frame_times(path, track.index), nominal, mean);
}

// Returns the displayed pixel's width / height.
Result<double> pixel_aspect(const std::filesystem::path& path, AVFormatContext& format, AVStream& track) {
  const double aspect = av_q2d(av_guess_sample_aspect_ratio(&format, &track, nullptr));
  if (!(aspect > 0) || std::abs(aspect - 1) < 0.005) return 1.0;
  const double pixels = double(track.codecpar->width) * track.codecpar->height * std::max(aspect, 1 / aspect);
  if (aspect <= kWidestPixel && aspect >= 1 / kWidestPixel && pixels <= double(kMaxFilmPixels)) return aspect;
  return Error{path.string() + ": states pixels that are " + number_text(aspect, 3) +
               " times as wide as high; convert it to square ones, for example: ffmpeg -i IN -vf "
               "scale=iw*sar:ih,setsar=1 OUT.mp4"};
}

// Returns the file's clockwise rotation. A mirrored picture is left mirrored: a flame has no left or right.
int quarter_turns(const AVStream& track) {
  const std::uint8_t* stated = av_stream_get_side_data(&track, AV_PKT_DATA_DISPLAYMATRIX, nullptr);
  if (stated == nullptr) return 0;
  std::array<std::int32_t, 9> matrix;
  std::memcpy(matrix.data(), stated, sizeof matrix);
  const bool mirrored = double(matrix[0]) * matrix[4] < double(matrix[1]) * matrix[3];
  if (mirrored) av_display_matrix_flip(matrix.data(), 1, 0);
  const double degrees = -av_display_rotation_get(matrix.data());
  if (std::isnan(degrees)) return 0;
  return static_cast<int>(std::lround(degrees / 90) % 4 + 4) % 4;
}

bool is_mov(const AVFormatContext& format) { return std::strstr(format.iformat->name, "mov") != nullptr; }

// Returns the number of frames that are not displayed: a phone trims a film by an edit list and keeps all frames.
std::int64_t cut_out(const AVFormatContext& format, const AVStream& track) {
  if (!is_mov(format)) return 0;
  auto& indexed = const_cast<AVStream&>(track);
  const int listed = avformat_index_get_entries_count(&track);
  std::int64_t shown = 0;
  for (int k = 0; k < listed; ++k) shown += (avformat_index_get_entry(&indexed, k)->flags & AVINDEX_DISCARD_FRAME) == 0;
  return listed > 0 && shown < track.nb_frames ? track.nb_frames - shown : 0;
}

std::int64_t stated_frames(const AVFormatContext& format, const AVStream& track, double rate) {
  if (track.nb_frames > 0) return track.nb_frames - cut_out(format, track);
  return std::llround(stated_seconds(format, track) * rate);
}

}  // namespace

Result<VideoFile> VideoFile::open(const std::filesystem::path& path, const VideoOptions& options) {
  VideoFile file;
  file.path_ = path;
  file.options_ = options;
  auto format = open_media(path);
  if (!format) return format.error();
  file.format_ = std::move(format).value();
  file.track_ = av_find_best_stream(file.format_.get(), AVMEDIA_TYPE_VIDEO, -1, -1, nullptr, 0);
  const bool cover = file.track_ >= 0 && file.format_->streams[file.track_]->disposition & AV_DISPOSITION_ATTACHED_PIC;
  if (file.track_ < 0 || cover) return Error{path.string() + ": found no video track, expected one; give a video file"};
  const AVStream& track = *file.format_->streams[file.track_];
  auto codec = open_decoder(path, track, options.threads);
  if (!codec) return codec.error();
  file.codec_ = std::move(codec).value();
  file.seconds_per_tick_ = av_q2d(track.time_base);
  VideoInfo& info = file.info_;
  const double own_rate = grid_rate(path, track);
  info.rate_hz = options.rate_hz > 0 ? options.rate_hz : own_rate;
  if (own_rate > 0) info.speed = info.rate_hz / own_rate;
  if (!(info.rate_hz > 0)) return Error{path.string() + ": states no frame rate; give it as --rate"};
  const int turns = (quarter_turns(track) + options.turn) % 4;
  const auto aspect = pixel_aspect(path, *file.format_, *file.format_->streams[file.track_]);
  if (!aspect) return aspect.error();
  file.aspect_ = *aspect;
  file.grid_.emplace(info.rate_hz);
  file.pictures_ = FramePictures(turns, *aspect);
  const auto [width, height] = file.pictures_.shown(track.codecpar->width, track.codecpar->height);
  info.width = width;
  info.height = height;
  info.frames = stated_frames(*file.format_, track, info.rate_hz / info.speed);
  info.has_sound = av_find_best_stream(file.format_.get(), AVMEDIA_TYPE_AUDIO, -1, -1, nullptr, 0) >= 0;
  read_alone(*file.format_, file.track_);
  file.packet_.reset(av_packet_alloc());
  file.frame_.reset(av_frame_alloc());
  return file;
}

// Sends one packet of the track to the decoder. Returns false at the end of the file or at a read error.
bool VideoFile::send_packet() {
  while (true) {
    const int code = packets_.next(format_.get(), packet_.get());
    if (code < 0) {
      read_error_ = code != AVERROR_EOF;
      with_memory(avcodec_send_packet, codec_.get(), nullptr);
      return false;
    }
    end_ = std::max(end_, end_of(*format_, *packet_));
    const bool ours = packet_->stream_index == track_;
    const bool whole = (packet_->flags & AV_PKT_FLAG_CORRUPT) == 0;
    if (ours && !whole) ++broken_;
    if (ours && whole && with_memory(avcodec_send_packet, codec_.get(), packet_.get()) < 0) ++broken_;
    av_packet_unref(packet_.get());
    if (ours) return true;
  }
}

// Decodes the next complete frame into frame_. Returns false at the end.
bool VideoFile::decode() {
  while (true) {
    const int code = with_memory(avcodec_receive_frame, codec_.get(), frame_.get());
    if (code == AVERROR(EAGAIN)) {
      if (!ended_) ended_ = !send_packet();
      continue;
    }
    if (code == AVERROR_EOF) return false;
    if (code < 0) {
      ++broken_;
      if (ended_) return false;
      ended_ = !send_packet();
      continue;
    }
    if ((frame_->flags & AV_FRAME_FLAG_CORRUPT) == 0 && frame_->decode_error_flags == 0) return true;
    ++broken_;
  }
}

std::int64_t VideoFile::place_on_grid() {
  const std::int64_t tick = frame_->best_effort_timestamp;
  const std::int64_t start = format_->streams[track_]->start_time;
  if (grid_->last() < 0 && tick != AV_NOPTS_VALUE && start != AV_NOPTS_VALUE) {
    info_.begin = static_cast<double>(tick - start) * seconds_per_tick_;
  }
  if (tick == AV_NOPTS_VALUE) return grid_->follow();
  return grid_->place(static_cast<double>(tick) * seconds_per_tick_ / info_.speed);
}

Result<std::optional<VideoFrame>> VideoFile::next() {
  while (decode()) {
    ++decoded_;
    const std::int64_t index = place_on_grid();
    if (options_.frames && index + 1 < options_.frames->first) continue;
    if (options_.frames && index + 1 > options_.frames->last) return std::optional<VideoFrame>();
    if (!holes_before_) {
      holes_before_ = grid_->shortened();
      info_.begin += grid_->removed() * info_.speed;
    }
    shortened_ = grid_->shortened() - *holes_before_;
    auto picture = pictures_.view(*frame_);
    if (!picture) return Error{path_.string() + ": " + picture.error().message};
    return std::optional<VideoFrame>(VideoFrame{*picture, index});
  }
  if (options_.frames && grid_->last() + 1 < options_.frames->first) {
    return Error{path_.string() + ": found " + std::to_string(grid_->last() + 1) + " frames, expected frame " +
                 std::to_string(options_.frames->first) + " as the first; give a range inside the clip"};
  }
  return std::optional<VideoFrame>();
}

// Decodes only the key frame at or before `tick`, unless it is at `before`. Returns its time; `before` if not decoded.
std::int64_t VideoFile::decode_key_frame(std::int64_t tick, std::int64_t before) {
  if (with_memory(av_seek_frame, format_.get(), track_, tick, AVSEEK_FLAG_BACKWARD) < 0) return before;
  while (with_memory(av_read_frame, format_.get(), packet_.get()) >= 0) {
    const bool wanted = packet_->stream_index == track_ && (packet_->flags & AV_PKT_FLAG_KEY) != 0;
    const std::int64_t at = packet_->pts;
    int code = wanted && at != before ? with_memory(avcodec_send_packet, codec_.get(), packet_.get()) : -1;
    av_packet_unref(packet_.get());
    if (!wanted) continue;
    if (code >= 0) code = with_memory(avcodec_send_packet, codec_.get(), nullptr);
    if (code >= 0) code = with_memory(avcodec_receive_frame, codec_.get(), frame_.get());
    avcodec_flush_buffers(codec_.get());
    return code >= 0 ? at : before;
  }
  return before;
}

// Uses a second reader, so that the position of this one is unaffected.
std::vector<OwnedPicture> VideoFile::glimpses(int count) {
  std::vector<OwnedPicture> out;
  auto opened = open(path_, options_);
  if (!opened || info_.frames <= 0) return out;
  VideoFile& file = *opened;
  const AVStream& track = *file.format_->streams[file.track_];
  const std::int64_t begin = track.start_time == AV_NOPTS_VALUE ? 0 : track.start_time;
  const double ticks_per_frame = file.info_.speed / (file.seconds_per_tick_ * file.info_.rate_hz);
  const std::int64_t first = options_.frames ? options_.frames->first - 1 : 0;
  const std::int64_t last = options_.frames ? std::min(options_.frames->last, info_.frames) : info_.frames;
  std::int64_t before = begin;  // skips the first key frame, which next() decodes
  for (int k = 1; k <= count; ++k) {
    const double frame = static_cast<double>(first) + static_cast<double>(last - 1 - first) * k / count;
    const std::int64_t at = file.decode_key_frame(begin + std::llround(frame * ticks_per_frame), before);
    if (at == before) continue;
    before = at;
    const auto picture = file.pictures_.view(*file.frame_);
    if (picture && picture->width == info_.width && picture->height == info_.height) out.emplace_back(*picture);
  }
  return out;
}

std::vector<std::string> VideoFile::warnings() const {
  std::vector<std::string> out;
  const std::string name = path_.string();
  const bool to_the_end = !options_.frames || grid_->last() + 1 < options_.frames->last;
  if (broken_ > 0)
    out.push_back(name + ": " + std::to_string(broken_) +
                  (broken_ == 1 ? " broken frame was left out" : " broken frames were left out"));
  // Only MP4 states the exact number of frames: AVI also counts frames that were dropped during recording.
  const bool exact = is_mov(*format_), counted = format_->streams[track_]->nb_frames > 0;
  const std::int64_t least = exact ? info_.frames : info_.frames - info_.frames / 20 - 2;
  const std::int64_t found = exact ? decoded_ + broken_ : grid_->last() + 1;
  const bool lacks = counted ? found < least : is_truncated(*format_, track_, end_);
  if (to_the_end && (read_error_ || lacks)) {
    out.push_back(name + ": cut off: found " + std::to_string(decoded_) + " frames of " + std::to_string(info_.frames) +
                  " stated; what is there is used");
  }
  if (aspect_ != 1) {
    out.push_back(name + ": its pixels are " + number_text(aspect_, 3) +
                  " times as wide as high; places are in square ones, in a picture of " + std::to_string(info_.width) +
                  " x " + std::to_string(info_.height));
  }
  for (std::string& warning : grid_->warnings(name)) out.push_back(std::move(warning));
  return out;
}

}  // namespace wisp
