// C interface of wind estimated from a microphone's sound.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <span>
#include <utility>

#include "c/boundary.hpp"
#include "wisp/sound/wind_level.hpp"

struct wisp_wind {
  wisp::WindLevel level;
  std::size_t channels;
};

namespace {

using namespace wisp::c;

wisp_wind_frame frame_of(const wisp::WindFrame& frame) {
  return {frame.index, frame.rms,        frame.rms_clean,  frame.level,  frame.speed,
          frame.wind,  frame.confidence, frame.background, frame.clipped};
}

// Feeds samples and converts up to 16 frames at a time, without allocation or reinterpretation of structs.
template <class Sample>
wisp_status feed(const char* function, wisp_wind* wind, std::span<const Sample> samples, wisp_wind_frame* frames,
                 std::size_t room, std::size_t* taken, std::size_t* made) {
  if (samples.size() % wind->channels != 0) {
    return fail(WISP_BAD_ARGUMENT, "%s was given %zu samples, expected a multiple of the %zu channels", function,
                samples.size(), wind->channels);
  }
  wisp::WindFrame piece[16];
  std::size_t used = 0, written = 0;
  for (;;) {
    const std::size_t left = std::min(room - written, std::size(piece));
    const wisp::WindFed fed = wind->level.feed(samples.subspan(used), {piece, left});
    for (std::size_t k = 0; k < fed.frames; ++k) frames[written + k] = frame_of(piece[k]);
    used += fed.samples;
    written += fed.frames;
    if (fed.frames == 0 || used == samples.size()) break;
  }
  if (taken) *taken = used;
  if (made) *made = written;
  return WISP_OK;
}

bool is_amplitude(float value) { return value >= 0 && value <= 8; }

}  // namespace

extern "C" {

wisp_wind_options wisp_wind_default_options(void) {
  const wisp::WindOptions defaults;
  return {.size = sizeof(wisp_wind_options),
          .channels = static_cast<uint32_t>(wisp::SoundFormat().channels),
          .rate_hz = wisp::SoundFormat().rate_hz,
          .frame_rate_hz = defaults.frame_rate_hz,
          .exponent = defaults.exponent,
          .smoothing_seconds = defaults.smoothing_seconds,
          .floor_rise_db_per_second = defaults.floor_rise_db_per_second,
          .first_gust_rms = defaults.first_gust_rms};
}

wisp_status wisp_wind_create(const wisp_wind_options* options, wisp_wind** wind) {
  if (!wind) return null_argument(__func__);
  wisp_wind_options known = wisp_wind_default_options();
  if (options) {
    if (!size_is_right(__func__, options->size)) return WISP_BAD_ARGUMENT;
    take_in(options, known);
  }
  if (known.channels == 0) known.channels = 1;
  const wisp::SoundFormat sound{.rate_hz = known.rate_hz,
                                .channels = static_cast<int>(std::min<std::uint32_t>(known.channels, 0x7fffffff))};
  const wisp::WindOptions wanted{.frame_rate_hz = known.frame_rate_hz,
                                 .exponent = known.exponent,
                                 .smoothing_seconds = known.smoothing_seconds,
                                 .floor_rise_db_per_second = known.floor_rise_db_per_second,
                                 .first_gust_rms = known.first_gust_rms};
  return guarded(__func__, [&]() -> wisp_status {
    auto level = wisp::WindLevel::create(sound, wanted);
    if (!level) return fail(WISP_BAD_ARGUMENT, level.error());
    *wind = new wisp_wind{std::move(level).value(), known.channels};
    return WISP_OK;
  });
}

void wisp_wind_free(wisp_wind* wind) { delete wind; }

wisp_status wisp_wind_feed(wisp_wind* wind, const float* samples, size_t count, wisp_wind_frame* frames, size_t room,
                           size_t* taken, size_t* made) {
  if (!wind || (!samples && count > 0) || (!frames && room > 0)) return null_argument(__func__);
  return feed<float>(__func__, wind, {samples, count}, frames, room, taken, made);
}

wisp_status wisp_wind_feed_int16(wisp_wind* wind, const int16_t* samples, size_t count, wisp_wind_frame* frames,
                                 size_t room, size_t* taken, size_t* made) {
  if (!wind || (!samples && count > 0) || (!frames && room > 0)) return null_argument(__func__);
  return feed<std::int16_t>(__func__, wind, {samples, count}, frames, room, taken, made);
}

wisp_status wisp_wind_latest(const wisp_wind* wind, wisp_wind_frame* frame) {
  if (!wind || !frame) return null_argument(__func__);
  *frame = frame_of(wind->level.latest());
  return WISP_OK;
}

wisp_status wisp_wind_calibrate(wisp_wind* wind, uint32_t what, double seconds) {
  if (!wind) return null_argument(__func__);
  if (std::isnan(seconds)) return fail(WISP_BAD_ARGUMENT, "%s was given a time that is not a number", __func__);
  if (what > WISP_WIND_BLOW_HARD)
    return fail(WISP_BAD_ARGUMENT, "%s was requested %u, expected a WISP_WIND_*, 0 or 1", __func__, what);
  wind->level.calibrate(static_cast<wisp::WindAsk>(what), seconds);
  return WISP_OK;
}

int32_t wisp_wind_calibrated(const wisp_wind* wind) { return wind && wind->level.calibrated() ? 1 : 0; }

double wisp_wind_room_rise(const wisp_wind* wind) { return wind ? static_cast<double>(wind->level.room_rise_db()) : 0; }

int32_t wisp_wind_calibrating(const wisp_wind* wind) { return wind && wind->level.calibrating() ? 1 : 0; }

wisp_status wisp_wind_get_calibration(const wisp_wind* wind, wisp_wind_calibration* calibration) {
  if (!struct_is_right(__func__, wind, calibration)) return WISP_BAD_ARGUMENT;
  const wisp::WindCalibration known = wind->level.calibration();
  return hand_out(wisp_wind_calibration{.background_rms = known.background_rms,
                                        .background_level = known.background_level,
                                        .floor_db = known.floor_db,
                                        .gust_rms = known.gust_rms},
                  calibration);
}

wisp_status wisp_wind_set_calibration(wisp_wind* wind, const wisp_wind_calibration* calibration) {
  if (!struct_is_right(__func__, wind, calibration)) return WISP_BAD_ARGUMENT;
  const wisp::WindCalibration defaults;
  wisp_wind_calibration known{};
  known.floor_db = defaults.floor_db;
  take_in(calibration, known);
  if (!is_amplitude(known.background_rms) || !is_amplitude(known.background_level) || !is_amplitude(known.gust_rms) ||
      !(known.floor_db >= -200 && known.floor_db <= 40)) {
    return fail(WISP_BAD_ARGUMENT,
                "%s was given a number that no room has: amplitudes are 0 to 8, the floor -200 to 40", __func__);
  }
  wind->level.set_calibration({known.background_rms, known.background_level, known.floor_db, known.gust_rms});
  return WISP_OK;
}

wisp_status wisp_wind_reset(wisp_wind* wind) {
  if (!wind) return null_argument(__func__);
  wind->level.reset();
  return WISP_OK;
}

double wisp_wind_latency(const wisp_wind* wind) { return wind ? wind->level.latency_seconds() : 0; }
}
