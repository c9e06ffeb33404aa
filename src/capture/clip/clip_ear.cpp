#include "capture/clip/clip_ear.hpp"

#include <algorithm>
#include <cmath>

namespace wisp {
namespace {

WindFrame missing_frame(std::size_t index) {
  WindFrame frame{};
  frame.index = static_cast<std::int64_t>(index);
  frame.rms = frame.rms_clean = frame.level = frame.speed = frame.wind = std::nanf("");
  return frame;
}

}  // namespace

std::string wind_channel_name(WindMeasure measure) {
  return measure == WindMeasure::kSpeed ? "wind" : measure == WindMeasure::kHeard ? "wind.heard" : "wind.rms";
}

double wind_value(const WindFrame& frame, WindMeasure measure) {
  if (measure == WindMeasure::kRms) return frame.rms_clean;
  return measure == WindMeasure::kSpeed ? frame.wind : frame.speed;
}

Result<ClipEar> ClipEar::create(const SoundFormat& format, double rate_hz) {
  auto tracker = WindTracker::create(format, {.frame_rate_hz = rate_hz});
  if (!tracker) return tracker.error();
  return ClipEar(std::move(*tracker), format, rate_hz);
}

void ClipEar::be_silent(double samples) {
  const double whole = std::round(samples);
  if (whole <= 0) return;
  tracker_.feed(std::vector<float>(static_cast<std::size_t>(whole) * static_cast<std::size_t>(format_.channels), 0.0F));
  fed_ += whole;
}

// Skips a gap in the sound without feeding silence, which the tracker would take for the background. Only the frames at
// the gap's two ends are completed with silence; the frames between are missing.
void ClipEar::pass_over(double seconds) {
  const double frame = format_.rate_hz / rate_hz_, hole = seconds * format_.rate_hz;
  const double to_next = (std::ceil(fed_ / frame - 1e-9) * frame - fed_);
  if (hole < to_next + frame) return be_silent(hole);
  const double frames = std::floor((hole - to_next) / frame + 1e-9);
  be_silent(to_next);
  holes_.push_back({static_cast<std::size_t>(std::llround(fed_ / frame)), frames});
  be_silent(hole - to_next - frames * frame);
}

void ClipEar::feed(double begin, std::span<const float> samples) {
  for (const float sample : samples) peak_ = std::max(peak_, std::abs(sample));
  const double gap = begin - heard_to_;
  if (!begun_ ? gap > 0 : gap > kJitter) {
    pass_over(gap);
    heard_to_ = begin;
  }
  // Drops samples from before the first picture, and samples that repeat earlier sound.
  std::size_t skipped = 0;
  if (!begun_ ? gap < 0 : gap < -kJitter) {
    const double early = std::min(-gap * format_.rate_hz, static_cast<double>(samples.size()) / format_.channels);
    skipped = static_cast<std::size_t>(std::llround(early)) * static_cast<std::size_t>(format_.channels);
  }
  samples = samples.subspan(skipped);
  begun_ = begun_ || !samples.empty();
  const double count = static_cast<double>(samples.size()) / format_.channels;
  tracker_.feed(samples);
  fed_ += count;
  heard_to_ += count / format_.rate_hz;
}

// Copies wind frames to their times in `placed`; frames in holes are missing. Returns the index after the last copied.
std::size_t ClipEar::place(std::span<const WindFrame> heard, std::size_t frames, std::vector<WindFrame>& placed) const {
  placed.clear();
  for (std::size_t k = 0; k < frames; ++k) placed.push_back(missing_frame(k));
  double shift = 0;
  auto hole = holes_.begin();
  std::size_t end = 0;
  for (std::size_t k = 0; k < heard.size(); ++k) {
    for (; hole != holes_.end() && hole->at <= k; ++hole) shift += hole->frames;
    const double at = static_cast<double>(k) + shift;
    if (!(at < static_cast<double>(frames))) break;
    placed[static_cast<std::size_t>(at)] = heard[k];
    placed[static_cast<std::size_t>(at)].index = static_cast<std::int64_t>(at);
    end = static_cast<std::size_t>(at) + 1;
  }
  return end;
}

Result<ClipWind> ClipEar::finish(std::size_t frames, std::size_t skipped) const {
  ClipWind wind;
  if (peak_ < 1e-4F) {  // −80 dB of full scale, as SoundInfo::silent()
    wind.note = "not heard: the sound track is silent";
    return wind;
  }
  auto track = tracker_.finish();
  if (!track) return track.error();
  wind.background = track->calibration.background_rms;
  wind.one_rms = track->one_rms;
  wind.clipped_share = track->clipped_share;
  wind.uncovered = frames - std::clamp(place(track->frames, frames, wind.frames), skipped, frames);
  wind.frames.erase(wind.frames.begin(), wind.frames.begin() + static_cast<std::ptrdiff_t>(skipped));
  wind.holes = static_cast<std::size_t>(std::count_if(wind.frames.begin(), wind.frames.end(),
                                                      [](const WindFrame& one) { return std::isnan(one.rms); })) -
               wind.uncovered;
  wind.note =
      "heard in " + std::to_string(static_cast<int>(std::lround(100 * track->blowing_share))) + " % of the clip";
  return wind;
}

}  // namespace wisp
