#include "wisp/sound/wind_level.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "sound/wind_design.hpp"
#include "sound/wind_listener.hpp"

namespace wisp {

struct WindLevel::State {
  State(const SoundFormat& sound, const WindOptions& given)
      : format(sound), options(given), design(wind::design(sound, given)), listener(design) {
    next_frame_at = end_of(0);
  }

  /// Returns the index of the first sample after a frame.
  std::int64_t end_of(std::int64_t index) const {
    return static_cast<std::int64_t>(static_cast<double>(index + 1) * format.rate_hz / options.frame_rate_hz + 0.5);
  }

  template <class Sample, class Load>
  WindFed feed(std::span<const Sample> samples, std::span<WindFrame> frames, Load load) {
    const std::size_t channels = static_cast<std::size_t>(format.channels);
    WindFed fed;
    float one[wind::kMaxChannels];
    while (fed.samples + channels <= samples.size()) {
      const bool ends_frame = position + 1 == next_frame_at;
      if (ends_frame && fed.frames == frames.size()) break;
      for (std::size_t c = 0; c < channels; ++c) one[c] = load(samples[fed.samples + c]);
      listener.push(one);
      ++position;
      fed.samples += channels;
      if (ends_frame) frames[fed.frames++] = end_frame();
    }
    return fed;
  }

  const WindFrame& end_frame() {
    latest = listener.end_frame();
    latest.index = ++last_index;
    next_frame_at = end_of(last_index + 1);
    return latest;
  }

  SoundFormat format;
  WindOptions options;
  wind::Design design;
  wind::Listener<float> listener;
  WindFrame latest;
  std::int64_t last_index = -1;
  std::int64_t position = 0;
  std::int64_t next_frame_at = 0;
};

WindLevel::WindLevel(std::unique_ptr<State> state) : state_(std::move(state)) {}
WindLevel::WindLevel(WindLevel&&) noexcept = default;
WindLevel& WindLevel::operator=(WindLevel&&) noexcept = default;
WindLevel::~WindLevel() = default;

Result<WindLevel> WindLevel::create(const SoundFormat& format, const WindOptions& options) {
  if (auto ok = wind::check(format, options); !ok) return ok.error();
  return WindLevel(std::make_unique<State>(format, options));
}

WindFed WindLevel::feed(std::span<const float> samples, std::span<WindFrame> frames) {
  return state_->feed(samples, frames, [](float x) { return x; });
}

WindFed WindLevel::feed(std::span<const std::int16_t> samples, std::span<WindFrame> frames) {
  return state_->feed(samples, frames, wind::from_pcm16);
}

const WindFrame& WindLevel::latest() const { return state_->latest; }

void WindLevel::calibrate(WindAsk ask, double seconds) {
  const double used = seconds >= 0.5 ? std::min(seconds, 30.0) : 0.5;
  state_->listener.calibrate(ask, static_cast<int>(std::ceil(used * state_->options.frame_rate_hz)));
}

bool WindLevel::calibrating() const { return state_->listener.calibrating(); }

bool WindLevel::calibrated() const { return state_->listener.calibrated(); }

float WindLevel::room_rise_db() const { return state_->listener.background().rise_db(); }

WindCalibration WindLevel::calibration() const {
  const auto& background = state_->listener.background();
  const float gust_db = state_->listener.reference().level_db();
  return {background.mean().rms(), std::sqrt(background.mean().band_power()), background.floor_db(),
          std::sqrt(wind::from_decibels(gust_db))};
}

void WindLevel::set_calibration(const WindCalibration& known) {
  const wind::Design& d = state_->design;
  const float power = known.background_level * known.background_level;
  state_->listener.background().set(known.background_rms, power, known.floor_db, d);
  if (known.gust_rms > 0) {
    auto& reference = state_->listener.reference();
    reference.start(wind::decibels(known.gust_rms * known.gust_rms), reference.kKnownGusts);
  }
}

void WindLevel::reset() { state_ = std::make_unique<State>(state_->format, state_->options); }

double WindLevel::latency_seconds() const { return state_->design.delay_seconds + state_->options.smoothing_seconds; }

}  // namespace wisp
