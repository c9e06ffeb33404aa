#include "wisp/capture/capture.hpp"

#include <algorithm>
#include <optional>
#include <string>

#include "capture/capture_clip.hpp"
#include "capture/clip/clip_ear.hpp"
#include "wisp/capture/media/sound.hpp"

namespace wisp {
namespace {

Result<void> check_frames(const std::filesystem::path& path, const std::optional<FrameRange>& frames,
                          std::size_t rows) {
  const auto last = frames ? frames->first - 1 + static_cast<std::int64_t>(rows) : 0;
  if (!frames || last >= frames->last) return {};
  return Error{path.string() + ": frames " + std::to_string(frames->first) + ":" + std::to_string(frames->last) +
               " reach beyond its end, frame " + std::to_string(last)};
}

// Of the rows that were captured.
ClipTimes times_of(const VideoReader& reader, const ClipCapture& options) {
  ClipTimes times = reader.times();
  const auto skipped = static_cast<std::size_t>(options.frames ? options.frames->first - 1 : 0);
  times.offsets = times.offsets.subspan(std::min(skipped, times.offsets.size()));
  return times;
}

// Hands a clip's sound on. Returns whether there was any.
template <class Hear>
Result<bool> hear_sound(const std::filesystem::path& path, Hear hear) {
  Result<void> heard;
  const auto info = stream_sound(path, [&](const SoundInfo& sound, std::span<const float> samples) {
    heard = hear(SoundFormat{.rate_hz = sound.rate_hz, .channels = sound.channels}, sound.begin, samples);
    return static_cast<bool>(heard);
  });
  if (!heard) return heard.error();
  if (!info) return info.error();
  return info->has_value();
}

}  // namespace

Result<Captured> capture(const std::filesystem::path& path, const ClipCapture& options, const Progress& progress) {
  auto reader = VideoReader::open(path, {.rate_hz = options.rate_hz, .frames = options.frames});
  if (!reader) return reader.error();
  const VideoInfo& info = reader->info();
  auto live = LiveCapture::create({.name = path.string(), .rate_hz = info.rate_hz, .pictures = info.images}, options);
  if (!live) return live.error();
  if (auto read = read_into(*reader, live->picture(), progress); !read) return read.error();
  if (!info.images) {
    const auto heard = hear_sound(path, [&](const SoundFormat& format, double begin, std::span<const float> samples) {
      return live->hear(format, begin - reader->info().begin, samples);
    });
    if (!heard) return heard.error();
  }
  auto captured = live->finish(times_of(*reader, options));
  if (!captured) return captured;
  if (auto ok = check_frames(path, options.frames, captured->recording.rows()); !ok) return ok.error();
  for (std::string& warning : reader->warnings()) captured->report.warnings.push_back(std::move(warning));
  return captured;
}

Result<ClipWind> hear_wind(const std::filesystem::path& path, double rate_hz, std::size_t frames) {
  std::optional<ClipEar> ear;
  const auto unusable = [&](const Error& why) {
    return Error{path.string() + ": its sound cannot be used: " + why.message};
  };
  const auto heard = hear_sound(path, [&](const SoundFormat& format, double begin, std::span<const float> samples) {
    if (!ear) {
      auto made = ClipEar::create(format, rate_hz);
      if (!made) return Result<void>(unusable(made.error()));
      ear.emplace(std::move(*made));
    }
    ear->feed(begin, samples);
    return Result<void>();
  });
  if (!heard) return heard.error();
  if (!ear) {
    ClipWind none;
    none.note = "not heard: the clip has no sound track";
    return none;
  }
  auto wind = ear->finish(frames);
  if (!wind) return unusable(wind.error());
  return wind;
}

}  // namespace wisp
