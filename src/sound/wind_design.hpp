#pragma once
// Fixed parameters of the wind estimator: rates, filters, time constants, thresholds.

#include <cstdint>
#include <string>
#include <vector>

#include "sound/wind_filters.hpp"
#include "wisp/sound/wind_level.hpp"

namespace wisp::wind {

/// Parameters for one format and set of options. Sound is first converted to the analysis rate (8 to 16 kHz): mean of
/// `box` samples, low-pass, decimation by `decimation`. Then the powers of bands are summed over hops of about 10 ms.
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

  // Squared gains of the filters: BandSums have to be multiplied by them.
  float total_gain = 1;
  float voice_gain = 1;
  float low_gain = 1;
  float high_gain = 1;

  double delay_seconds = 0;  ///< delay of the filters in the path of the level

  int hop = 80;        ///< analysis samples per hop; a multiple of voice_step
  int voice_step = 2;  ///< decimation for the search of a voice's period (to about 4 kHz)
  int first_lag = 10;  ///< shortest period of a voice (1/400 s), in samples decimated by voice_step
  int last_lag = 57;   ///< longest period of a voice (1/70 s), in the same samples

  float power_approach = 1;      ///< weight of one hop in the mean of band powers (50 ms)
  float voice_release = 1;       ///< decay of the peak-held voicing per hop (300 ms)
  float tone_approach = 1;       ///< weight of one hop in the mean autocorrelation (150 ms)
  float slow_rise = 1;           ///< weight of a louder hop in the slow mean that sudden sound exceeds (0.35 s)
  float slow_fall = 1;           ///< weight of a softer hop in this slow mean (100 ms)
  float floor_fall = 1;          ///< weight of a softer hop in the floor (50 ms)
  float floor_rise_db = 0.01F;   ///< rise of the floor per hop under sound like blowing (1 dB/s)
  float room_rise_db = 0.09F;    ///< rise of the floor per hop under other sound (9 dB/s)
  float room_fall = 1;           ///< weight of a hop with a lower floor in the lowest floor so far (2 s)
  float swell_fall = 1;          ///< weight of one hop in the decay of the background's recent maximum (6 s)
  int room_hops = 300;           ///< hops over which the first floor is averaged (3 s)
  float smoothing = 1;           ///< weight of one frame in the level's band power
  float level_zero = 1;          ///< zero of the levelling filter 1 − zero z⁻¹: flat below 300 Hz, rising above
  float level_gain = 1;          ///< gain of the level's power, such that 300 Hz passes unchanged
  float power_exponent = 0.25F;  ///< wind speed is proportional to band power to this power

  int trust_frames = 5;          ///< maximum frames after blowing in which sound unlike blowing still passes (80 ms)
  int bridge_delay_frames = 4;   ///< frames from a foreign sound's beginning to its detection (50 ms)
  float bridge_keep = 0.97F;     ///< decay per frame of the wind under foreign sound (0.5 s)
  float wind_step = 0.21F;       ///< maximum rise of wind per frame, up to wind 1 (0.08 s from 0 to 1)
  float sustain_frames = 14.4F;  ///< sum over frames of wind above 1, above which such wind passes (0.24 s of wind 1)

  int quiet_run_frames = 18;      ///< quiet frames count as background after this many in a row (0.3 s)
  float quiet_span_frames = 600;  ///< memory of the background, frames (10 s of quiet)
  float first_gust_db = -28;      ///< initial level of wind 1
  int gust_rest_frames = 15;      ///< frames without blowing after which a gust ends (0.25 s)
  int min_gust_frames = 6;        ///< minimum frames of blowing in a gust (0.1 s); shorter gusts are ignored
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
