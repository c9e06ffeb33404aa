#include "wisp/run/wind_track.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "run/wind_design.hpp"
#include "run/wind_kernel.hpp"
#include "run/wind_verdict.hpp"

namespace wisp {

struct WindTracker::State {
  State(const SoundFormat& sound, const WindOptions& given)
      : format(sound), options(given), design(wind::design(sound, given)), kernel(design) {}

  std::int64_t boundary(std::size_t frame) const {
    const double at = times.empty() ? static_cast<double>(frame) / options.frame_rate_hz : times[frame];
    return static_cast<std::int64_t>(at * format.rate_hz + 0.5);
  }

  bool more() const { return times.empty() || seen.size() + 1 < times.size(); }

  void hear(const float* one) {
    kernel.push(one);
    ++position;
    if (!started && position >= boundary(0)) {
      started = true;
      if (position > 0 && boundary(0) > 0) (void)kernel.end_frame();
    }
    if (started && more() && position >= boundary(seen.size() + 1)) seen.push_back(kernel.end_frame());
  }

  SoundFormat format;
  WindOptions options;
  wind::Design design;
  wind::Kernel<float> kernel;
  std::vector<double> times;
  std::vector<wind::Observation<float>> seen;
  std::int64_t position = 0;
  bool started = false;
};

namespace {

float percentile(std::vector<float> values, double share) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

}  // namespace

WindTracker::WindTracker(std::unique_ptr<State> state) : state_(std::move(state)) {}
WindTracker::WindTracker(WindTracker&&) noexcept = default;
WindTracker& WindTracker::operator=(WindTracker&&) noexcept = default;
WindTracker::~WindTracker() = default;

Result<WindTracker> WindTracker::create(const SoundFormat& format, const WindOptions& options) {
  if (auto ok = wind::check(format, options); !ok) return ok.error();
  return WindTracker(std::make_unique<State>(format, options));
}

Result<WindTracker> WindTracker::create(const SoundFormat& format, std::span<const double> frame_seconds,
                                        const WindOptions& options) {
  if (auto ok = wind::check(format, options); !ok) return ok.error();
  if (frame_seconds.size() < 2) {
    return Error{"wind track: " + std::to_string(frame_seconds.size()) + " frame times, expected at least 2"};
  }
  for (std::size_t i = 0; i < frame_seconds.size(); ++i) {
    const bool fine =
        std::isfinite(frame_seconds[i]) && (i == 0 ? frame_seconds[i] >= 0 : frame_seconds[i] > frame_seconds[i - 1]);
    if (!fine) {
      return Error{"wind track: frame time " + std::to_string(i) + " is " + std::to_string(frame_seconds[i]) +
                   " s, expected finite, not negative and later than the one before"};
    }
  }
  auto state = std::make_unique<State>(format, options);
  state->times.assign(frame_seconds.begin(), frame_seconds.end());
  return WindTracker(std::move(state));
}

void WindTracker::feed(std::span<const float> samples) {
  const std::size_t channels = static_cast<std::size_t>(state_->format.channels);
  for (std::size_t i = 0; i + channels <= samples.size(); i += channels) state_->hear(samples.data() + i);
}

void WindTracker::feed(std::span<const std::int16_t> samples) {
  const std::size_t channels = static_cast<std::size_t>(state_->format.channels);
  float one[8];
  for (std::size_t i = 0; i + channels <= samples.size(); i += channels) {
    for (std::size_t c = 0; c < channels; ++c) one[c] = static_cast<float>(samples[i + c]) * (1.0F / 32768.0F);
    state_->hear(one);
  }
}

Result<WindTrack> WindTracker::finish() const {
  const auto& seen = state_->seen;
  if (seen.empty()) {
    return Error{"wind track: " + std::to_string(static_cast<double>(state_->position) / state_->format.rate_hz) +
                 " s of sound, expected at least one video frame"};
  }
  std::vector<float> loudness;
  for (const auto& one : seen) loudness.push_back(one.loudness_db);
  const float floor_db = percentile(loudness, 0.05);
  WindTrack track;
  track.seconds = static_cast<double>(state_->position) / state_->format.rate_hz;
  double rms = 0;
  double power = 0;
  std::size_t quiet = 0;
  for (const auto& one : seen) {
    if (one.loudness_db > floor_db + 6) continue;
    rms += one.rms;
    power += one.band_power;
    ++quiet;
  }
  wind::Background background{static_cast<float>(rms / static_cast<double>(quiet)),
                              static_cast<float>(power / static_cast<double>(quiet)), 0};
  std::vector<float> gusts;
  for (const auto& one : seen) {
    if (one.likeness * wind::audible(one.loudness_db - floor_db) > 0.8F)
      gusts.push_back(wind::decibels(one.band_power - std::min(one.band_power, background.band_power)));
  }
  background.gust_db =
      gusts.empty()
          ? wind::decibels(static_cast<float>(state_->options.first_gust_rms * state_->options.first_gust_rms))
          : percentile(gusts, 0.95);
  double clipped = 0;
  for (const auto& one : seen) {
    const float confidence = one.likeness * wind::audible(one.loudness_db - floor_db);
    WindFrame frame = wind::verdict(one, confidence, background, state_->design.exponent);
    frame.index = static_cast<std::int64_t>(track.frames.size());
    track.frames.push_back(frame);
    clipped += one.clipped;
    if (confidence > 0.5F) track.blowing_share += 1;
  }
  const float frames = static_cast<float>(seen.size());
  track.blowing_share /= frames;
  track.quiet_share = static_cast<float>(quiet) / frames;
  track.clipped_share = static_cast<float>(clipped) / frames;
  track.silent = percentile(loudness, 1) < -80;
  track.background_found = true;
  track.calibration = {background.rms, wind::root_of(background.band_power),
                       gusts.empty() ? 0.0F : wind::root_of(wind::from_decibels(background.gust_db))};
  return track;
}

Result<WindTrack> wind_from_sound(std::span<const float> interleaved, const SoundFormat& format,
                                  const WindOptions& options) {
  auto tracker = WindTracker::create(format, options);
  if (!tracker) return tracker.error();
  tracker->feed(interleaved);
  return tracker->finish();
}

}  // namespace wisp
