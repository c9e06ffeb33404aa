#pragma once
// Everything about hearing wind that is fixed when the estimator is made: rates, filters, time constants, thresholds.

#include <cstdint>
#include <vector>

#include "sound/wind_filters.hpp"
#include "wisp/sound/wind_level.hpp"

namespace wisp::wind {

/// The sound's way to the analysis rate (8 to 16 kHz): the mean of `box` samples, then a low-pass, keeping one in
/// `decimation`. Then the bands, whose powers are summed over hops of about 10 ms.
struct Design {
  int channels = 1;
  int box = 1;
  int decimation = 1;
  double analysis_rate_hz = 8000;
  std::vector<float> taps;  ///< of the low-pass; empty where nothing is left out

  Section high_pass;  ///< 100 Hz: all that is listened to
  Section low_pass;   ///< 900 Hz, after it: the voice band
  Section low;        ///< band-pass 126.5 Hz
  Section high;       ///< band-pass 2646 Hz

  // Powers of the filters' gains, left out of the sums.
  float total_gain = 1;
  float voice_gain = 1;
  float low_gain = 1;
  float high_gain = 1;

  double delay_seconds = 0;  ///< of the filters that the level passes

  int hop = 80;        ///< analysis samples a hop; a multiple of voice_step
  int voice_step = 2;  ///< analysis samples for one in which a voice's period is sought (near 4 kHz)
  int first_lag = 10;  ///< shortest and longest period of a voice, in those samples
  int last_lag = 57;

  float power_approach = 1;     ///< of band powers in one hop (50 ms)
  float voice_release = 1;      ///< of the held voicing in one hop (300 ms)
  float tone_approach = 1;      ///< of the mean autocorrelation in one hop (150 ms)
  float slow_rise = 1;          ///< of the level that a sudden sound exceeds, in one hop (0.35 s)
  float slow_fall = 1;          ///< downwards (100 ms)
  float floor_fall = 1;         ///< of the floor downwards in one hop (50 ms)
  float floor_rise_db = 0.01F;  ///< of the floor upwards in one hop, under what sounds like blowing (1 dB/s)
  float room_rise_db = 0.09F;   ///< and under what does not (9 dB/s)
  float room_fall = 1;          ///< of the room's floor downwards in one hop, once it is known (2 s)
  float swell_fall = 1;         ///< of the loudest that the room was of late, in one hop (6 s)
  int room_hops = 300;          ///< in which it is found (3 s)
  float smoothing = 1;          ///< of the level's band power in one frame
  float level_zero = 1;         ///< of what levels the band, 1 − zero z⁻¹: flat below 300 Hz, rising above
  float level_gain = 1;         ///< of the level's power, so that its band passes 300 Hz as it is
  float power_exponent = 0.25F;

  int trust_frames = 5;          ///< another sound is one after so many frames (80 ms)
  int bridge_delay_frames = 4;   ///< and begins so many before it is known for one (50 ms)
  float bridge_keep = 0.97F;     ///< of the wind under another sound, in one frame (0.5 s)
  float sustain_frames = 14.4F;  ///< of wind 1 that strong wind must make up before it passes (0.24 s)

  int quiet_run_frames = 18;      ///< quiet must last so long before it counts (0.3 s)
  float quiet_span_frames = 600;  ///< memory of the background (10 s of quiet)
  float first_gust_db = -28;      ///< level of wind 1 before anything is heard
  int gust_rest_frames = 15;      ///< a gust ends when it has not blown for so long (0.25 s)
  int min_gust_frames = 6;        ///< and is none when it blew for less than this (0.1 s)
};

constexpr int kMaxChannels = 8;

/// A 16-bit sample with full scale 1.
inline float from_pcm16(std::int16_t x) { return static_cast<float>(x) * (1.0F / 32768.0F); }

/// The design for a format and options that have been checked.
Design design(const SoundFormat& format, const WindOptions& options);

/// Checks format and options. Errors name the value, what was found and what is allowed.
Result<void> check(const SoundFormat& format, const WindOptions& options);

}  // namespace wisp::wind
