#include "wisp/run/wind_level.hpp"

#include <algorithm>
#include <utility>

#include "run/wind_background.hpp"
#include "run/wind_design.hpp"
#include "run/wind_kernel.hpp"
#include "run/wind_verdict.hpp"

namespace wisp {

struct WindLevel::State {
  State(const SoundFormat& sound, const WindOptions& given)
      : format(sound), options(given), design(wind::design(sound, given)), kernel(design) {
    gusts.start(wind::decibels(static_cast<float>(given.first_gust_rms * given.first_gust_rms)),
                kFirstGustSeconds * frame_rate());
    next_frame_at = boundary(1);
  }

  static constexpr float kFirstGustSeconds = 0.05F;  // of blowing: what the first guess weighs
  static constexpr float kGustMemorySeconds = 60;    // of blowing
  static constexpr float kQuietSpanSeconds = 10;     // of quiet
  static constexpr float kQuietDb = 6;               // above the floor: quiet, by the 50 ms loudness

  float frame_rate() const { return static_cast<float>(options.frame_rate_hz); }

  /// First sample of a frame.
  std::int64_t boundary(std::int64_t of_frame) const {
    return static_cast<std::int64_t>(static_cast<double>(of_frame) * format.rate_hz / options.frame_rate_hz + 0.5);
  }

  template <class Sample, class Load>
  WindFed feed(std::span<const Sample> samples, std::span<WindFrame> frames, Load load);

  void hear(const float* one);
  WindFrame end_frame();
  void learn(const wind::Observation<float>& seen, float confidence);

  SoundFormat format;
  WindOptions options;
  wind::Design design;
  wind::Kernel<float> kernel;
  wind::Floor<float> floor;
  wind::QuietMean<float> quiet;
  wind::QuietMean<float> room;
  wind::GustLevel gusts;
  WindFrame last;
  std::int64_t position = 0;
  std::int64_t next_frame_at = 0;
  std::int64_t frame = 0;
  std::int64_t calibrate_until = 0;
};

void WindLevel::State::hear(const float* one) {
  kernel.push(one);
  ++position;
  if (kernel.ended_hop()) floor.follow(kernel.loudness_db(), design);
}

void WindLevel::State::learn(const wind::Observation<float>& seen, float confidence) {
  if (position <= calibrate_until) {
    room.add(seen.rms, seen.band_power, 1e9F);
    floor.set(wind::decibels(room.band_power()));
    quiet = room;
    return;
  }
  if (seen.loudness_db < floor.level_db() + kQuietDb) {
    quiet.add(seen.rms, seen.band_power, kQuietSpanSeconds * frame_rate());
  } else if (confidence > 0.8F) {
    const float keep = 1 - 1 / (kGustMemorySeconds * frame_rate());
    gusts.add(wind::decibels(seen.band_power - std::min(seen.band_power, quiet.band_power())), keep);
  }
}

WindFrame WindLevel::State::end_frame() {
  const wind::Observation<float> seen = kernel.end_frame();
  const float confidence = seen.likeness * wind::audible(seen.loudness_db - floor.level_db());
  learn(seen, confidence);
  const wind::Background background{quiet.rms(), quiet.band_power(), gusts.high_db()};
  last = wind::verdict(seen, confidence, background, design.exponent);
  last.index = frame++;
  next_frame_at = boundary(frame + 1);
  return last;
}

template <class Sample, class Load>
WindFed WindLevel::State::feed(std::span<const Sample> samples, std::span<WindFrame> frames, Load load) {
  const std::size_t channels = static_cast<std::size_t>(format.channels);
  WindFed fed;
  float one[8];
  while (fed.samples + channels <= samples.size()) {
    if (position + 1 == next_frame_at && fed.frames == frames.size()) break;
    for (std::size_t c = 0; c < channels; ++c) one[c] = load(samples[fed.samples + c]);
    hear(one);
    fed.samples += channels;
    if (position == next_frame_at) frames[fed.frames++] = end_frame();
  }
  return fed;
}

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
  return state_->feed(samples, frames, [](std::int16_t x) { return static_cast<float>(x) * (1.0F / 32768.0F); });
}

const WindFrame& WindLevel::latest() const { return state_->last; }

void WindLevel::calibrate(double seconds) {
  const double used = std::clamp(seconds, 0.5, 30.0);
  state_->calibrate_until = state_->position + static_cast<std::int64_t>(used * state_->format.rate_hz);
  state_->room = {};
}

bool WindLevel::calibrating() const { return state_->position < state_->calibrate_until; }

WindCalibration WindLevel::calibration() const {
  return {state_->quiet.rms(), wind::root_of(state_->quiet.band_power()),
          wind::root_of(wind::from_decibels(state_->gusts.high_db()))};
}

void WindLevel::set_calibration(const WindCalibration& known) {
  const float power = known.background_level * known.background_level;
  state_->quiet.set(known.background_rms, power, State::kQuietSpanSeconds * state_->frame_rate());
  state_->floor.set(wind::decibels(power));
  if (known.gust_rms > 0) {
    state_->gusts.start(wind::decibels(known.gust_rms * known.gust_rms),
                        State::kGustMemorySeconds * state_->frame_rate() / 4);
  }
}

void WindLevel::reset() { *state_ = State(state_->format, state_->options); }

double WindLevel::latency_seconds() const {
  const double filter =
      static_cast<double>(state_->design.taps.size()) / 2 * state_->design.box / state_->format.rate_hz;
  return filter + state_->options.smoothing_seconds;
}

}  // namespace wisp
