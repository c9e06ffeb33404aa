#include "wisp/capture/media/clip_wind.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "wisp/capture/media/sound.hpp"

namespace wisp {
namespace {

// Sound in step with the picture: what begins later is led in by silence, what began earlier loses its start.
class InStep {
 public:
  InStep(WindTracker& tracker, const SoundInfo& info) : tracker_(tracker) {
    const auto samples = static_cast<std::int64_t>(std::llround(info.begin * info.rate_hz)) * info.channels;
    if (samples > 0) tracker_.feed(std::vector<float>(static_cast<std::size_t>(samples), 0.0F));
    to_skip_ = static_cast<std::size_t>(std::max<std::int64_t>(0, -samples));
  }

  void feed(std::span<const float> samples) {
    const std::size_t skipped = std::min(to_skip_, samples.size());
    to_skip_ -= skipped;
    tracker_.feed(samples.subspan(skipped));
  }

 private:
  WindTracker& tracker_;
  std::size_t to_skip_ = 0;
};

Result<std::optional<WindTracker>> follow_sound(const std::filesystem::path& path, double rate_hz,
                                                std::optional<SoundInfo>& info) {
  std::optional<WindTracker> tracker;
  std::optional<InStep> sound;
  std::optional<Error> refused;
  auto heard = stream_sound(path, [&](const SoundInfo& format, std::span<const float> samples) {
    if (!tracker) {
      auto made =
          WindTracker::create({.rate_hz = format.rate_hz, .channels = format.channels}, {.frame_rate_hz = rate_hz});
      if (!made) {
        refused = Error{path.string() + ": its sound cannot be used: " + made.error().message};
        return false;
      }
      tracker.emplace(std::move(made).value());
      sound.emplace(*tracker, format);
    }
    sound->feed(samples);
    return true;
  });
  if (refused) return *refused;
  if (!heard) return heard.error();
  info = *heard;
  return tracker;
}

WindFrame missing_frame(std::size_t index) {
  constexpr float kMissing = std::numeric_limits<float>::quiet_NaN();
  WindFrame frame{};
  frame.index = static_cast<std::int64_t>(index);
  frame.rms = frame.rms_clean = frame.level = frame.speed = frame.wind = kMissing;
  return frame;
}

}  // namespace

std::string wind_channel_name(WindMeasure measure) {
  switch (measure) {
    case WindMeasure::kSpeed:
      return "wind";
    case WindMeasure::kHeard:
      return "wind.heard";
    case WindMeasure::kRms:
      return "wind.rms";
  }
  return "";
}

double wind_value(const WindFrame& frame, WindMeasure measure) {
  switch (measure) {
    case WindMeasure::kSpeed:
      return frame.wind;
    case WindMeasure::kHeard:
      return frame.speed;
    case WindMeasure::kRms:
      return frame.rms_clean;
  }
  return 0;
}

Result<ClipWind> hear_wind(const std::filesystem::path& path, double rate_hz, std::size_t frames) {
  std::optional<SoundInfo> info;
  auto tracker = follow_sound(path, rate_hz, info);
  if (!tracker) return tracker.error();
  ClipWind wind;
  if (!info || !*tracker) {
    wind.note = "not heard: the clip has no sound track";
    return wind;
  }
  if (info->silent()) {
    wind.note = "not heard: the sound track is silent";
    return wind;
  }
  auto track = (*tracker)->finish();
  if (!track) return Error{path.string() + ": its sound cannot be used: " + track.error().message};
  wind.frames = std::move(track->frames);
  wind.background = track->calibration.background_rms;
  wind.one_rms = track->one_rms;
  wind.clipped_share = track->clipped_share;
  wind.uncovered = frames - std::min(frames, wind.frames.size());
  wind.frames.resize(frames);
  for (std::size_t k = frames - wind.uncovered; k < frames; ++k) wind.frames[k] = missing_frame(k);
  wind.note =
      "heard in " + std::to_string(static_cast<int>(std::lround(100 * track->blowing_share))) + " % of the clip";
  return wind;
}

}  // namespace wisp
