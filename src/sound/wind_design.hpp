#pragma once
// Fixed parameters of the wind estimator: rates, filters, time constants, thresholds.

#include <cstdint>
#include <string>
#include <vector>

#include "sound/wind_filters.hpp"
#include "wisp/sound/wind_level.hpp"

namespace wisp::wind {

/// Conversion to the analysis rate (8 to 16 kHz): the mean of `box` samples, a low-pass, decimation by `decimation`.
/// Then the bands, whose powers are summed over hops of about 10 ms.
struct Design {
  int channels = 1;
  int box = 1;
  int decimation = 1;
  double analysis_rate_hz = 8000;
  std::vector<float> taps;  ///< taps of the low-pass; empty without decimation

  Section high_pass;  ///< 100 Hz, applied to the whole signal
  Section low_pass;   ///< 900 Hz, in series: gives the voice band
  Section low;        ///< band-pass 126.5 Hz
  Section high;       ///< band-pass 2646 Hz

  // Squared gains of the filters, which the sums leave out.
  float total_gain = 1;
  float voice_gain = 1;
  float low_gain = 1;
  float high_gain = 1;

  double delay_seconds = 0;  ///< delay of the filters in the path of the level

  int hop = 80;        ///< analysis samples per hop; a multiple of voice_step
  int voice_step = 2;  ///< decimation for the search of a voice's period (to about 4 kHz)
  int first_lag = 10;  ///< shortest period of a voice, in samples after that decimation
  int last_lag = 57;   ///< longest period

  float power_approach = 1;     ///< weight of one hop in the mean of band powers (50 ms)
  float voice_release = 1;      ///< decay of the peak-held voicing per hop (300 ms)
  float tone_approach = 1;      ///< weight of one hop in the mean autocorrelation (150 ms)
  float slow_rise = 1;          ///< weight of one hop in the slow level that sudden sound exceeds, rising (0.35 s)
  float slow_fall = 1;          ///< the same weight, falling (100 ms)
  float floor_fall = 1;         ///< weight of one hop in the floor, falling (50 ms)
  float floor_rise_db = 0.01F;  ///< rise of the floor per hop under sound like blowing (1 dB/s)
  float room_rise_db = 0.09F;   ///< rise of the floor per hop under other sound (9 dB/s)
  float room_fall = 1;          ///< weight of one hop in the room's floor, falling, once known (2 s)
  float swell_fall = 1;         ///< weight of one hop in the fall of the room's recent maximum (6 s)
  int room_hops = 300;          ///< hops until the room's floor is known (3 s)
  float smoothing = 1;          ///< weight of one frame in the level's band power
  float level_zero = 1;         ///< zero of the levelling filter 1 − zero z⁻¹: flat below 300 Hz, rising above
  float level_gain = 1;         ///< gain of the level's power, such that 300 Hz passes unchanged
  float power_exponent = 0.25F;

  int trust_frames = 5;          ///< maximum frames after blowing in which foreign sound still passes (80 ms)
  int bridge_delay_frames = 4;   ///< frames from a foreign sound's beginning to its detection (50 ms)
  float bridge_keep = 0.97F;     ///< decay per frame of the wind under foreign sound (0.5 s)
  float wind_step = 0.21F;       ///< maximum rise per frame of wind below 1 (1 in 0.08 s)
  float sustain_frames = 14.4F;  ///< sum of strong wind, in frames of wind 1, before it passes (0.24 s)

  int quiet_run_frames = 18;      ///< minimum length of quiet that counts, frames (0.3 s)
  float quiet_span_frames = 600;  ///< memory of the background, frames (10 s of quiet)
  float first_gust_db = -28;      ///< initial level of wind 1
  int gust_rest_frames = 15;      ///< frames without blowing after which a gust ends (0.25 s)
  int min_gust_frames = 6;        ///< minimum length of a gust, frames (0.1 s)
};

constexpr int kMaxChannels = 8;

/// Converts a 16-bit sample to full scale ±1.
inline float from_pcm16(std::int16_t x) { return static_cast<float>(x) * (1.0F / 32768.0F); }

/// Formats a number without trailing zeros.
std::string decimal(double x);

Design design(const SoundFormat& format, const WindOptions& options);

/// Checks format and options. Errors name the value, what was found and what is allowed.
Result<void> check(const SoundFormat& format, const WindOptions& options);

}  // namespace wisp::wind
