#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <limits>

#include "record/loudness.hpp"
#include "studies/flame/verify_flame.hpp"
#include "studies/value_or_abort.hpp"
#include "wisp/capture/vision/outline_capture.hpp"
#include "wisp/simulate/candle_clip.hpp"

namespace wisp::verify {
namespace {

constexpr double kPuffSeconds = 5;

Picture picture_of(const CandleFrame& frame) {
  return rgb_picture({frame.picture.data(), frame.width, frame.height, 3 * frame.width}, 3);
}

Recording with_wind(const Recording& outline, const std::string& unit, std::vector<double> samples) {
  Recording out = outline;
  samples.resize(outline.rows(), std::numeric_limits<double>::quiet_NaN());
  out.channels.push_back({"wind", unit, Role::kInput, std::move(samples)});
  return out;
}

WindSignalOptions wind_of(const FlameClipChoice& choice) {
  WindSignalOptions wind{.seed = choice.wind_seed};
  if (choice.wind == FlameWind::kCalm) {
    // Draughts of a closed room: the flame's brightness varies by a few percent, as a candle's does in still air.
    // Without any it would not move at all, and be refused as a lamp.
    wind.most = 0.1;
    wind.noise = 0.03;
    wind.bandwidth_hz = 1;
    wind.gust = wind.rest_share = 0;
    wind.both_sides = true;
  }
  if (choice.wind == FlameWind::kPuffs) wind.puff_every = kPuffSeconds;
  return wind;
}

}  // namespace

FlameClip make_flame_clip(double seconds, std::uint64_t seed, const std::vector<double>& knots) {
  return make_flame_clip({seconds, seed, seed, knots});
}

FlameClip make_flame_clip(const FlameClipChoice& choice) {
  CandleClipOptions options;
  options.seconds = choice.seconds;
  options.wind = wind_of(choice);
  options.camera.seed = options.microphone.seed = choice.chance_seed;
  OutlineCapture capture(
      {.knots = choice.knots, .rate_hz = options.rig.rate_hz, .source = "seed " + std::to_string(choice.wind_seed)});
  WindTracker tracker =
      value_or_abort(WindTracker::create({options.microphone.rate_hz, 1}, {.frame_rate_hz = options.rig.rate_hz}));
  CandleClipOutputs outputs;
  outputs.on_frame = [&](const CandleFrame& frame) { return capture.feed(picture_of(frame)); };
  outputs.on_sound = [&](std::span<const float> sound) -> Result<void> {
    tracker.feed(sound);
    return {};
  };
  const std::clock_t start = std::clock();
  FlameClip clip;
  clip.truth = value_or_abort(simulate_candle(options, outputs));
  clip.processor_seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  CapturedOutline captured = value_or_abort(capture.finish());
  // Where it is blown out, the sound excuses that later.
  if (!captured.report.usable && choice.wind != FlameWind::kPuffs) {
    std::printf("  seed %llu is not usable: %s\n", static_cast<unsigned long long>(choice.wind_seed),
                captured.report.reason.c_str());
  }
  clip.outline = std::move(captured.recording);
  WindTrack track = value_or_abort(tracker.finish());
  clip.wind = std::move(track.frames);
  clip.one_rms = track.one_rms;
  return clip;
}

Recording driven_by_sound(const FlameClip& clip, WindMeasure measure) {
  std::vector<double> samples;
  for (const WindFrame& frame : clip.wind) samples.push_back(wind_value(frame, measure));
  Recording out = with_wind(clip.outline, "1", std::move(samples));
  if (measure != WindMeasure::kRms) set_one_rms(out, "wind", clip.one_rms);
  return out;
}

Recording driven_by_truth(const FlameClip& clip) {
  return with_wind(clip.outline, "m/s", clip.truth.channels[*find_channel(clip.truth, "wind")].samples);
}

}  // namespace wisp::verify
