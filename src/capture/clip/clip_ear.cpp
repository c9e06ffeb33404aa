#include "capture/clip/clip_ear.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace wisp {
namespace {

constexpr float kSilence = 1e-4F;  // −80 dB of full scale

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

// Sound that begins after the picture is led in by silence, what began earlier loses its start.
Result<ClipEar> ClipEar::create(const SoundFormat& format, double begin, double rate_hz) {
  auto tracker = WindTracker::create(format, {.frame_rate_hz = rate_hz});
  if (!tracker) return tracker.error();
  ClipEar ear(std::move(*tracker));
  const auto samples = static_cast<std::int64_t>(std::llround(begin * format.rate_hz)) * format.channels;
  if (samples > 0) ear.tracker_.feed(std::vector<float>(static_cast<std::size_t>(samples), 0.0F));
  ear.to_skip_ = static_cast<std::size_t>(std::max<std::int64_t>(0, -samples));
  return ear;
}

void ClipEar::feed(std::span<const float> samples) {
  for (const float sample : samples) peak_ = std::max(peak_, std::abs(sample));
  const std::size_t skipped = std::min(to_skip_, samples.size());
  to_skip_ -= skipped;
  tracker_.feed(samples.subspan(skipped));
}

Result<ClipWind> ClipEar::finish(std::size_t frames) const {
  ClipWind wind;
  if (peak_ < kSilence) {
    wind.note = "not heard: the sound track is silent";
    return wind;
  }
  auto track = tracker_.finish();
  if (!track) return track.error();
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
