#include "sound/wind_design.hpp"

#include <string>

#include "sound/wind_math.hpp"

namespace wisp::wind {
namespace {

constexpr double kMinBoxedHz = 32000;  // minimum rate after the box mean: its droop at 3.4 kHz is then below 0.2 dB
constexpr double kLevelHz = 300;       // corner of the levelling filter; with level_gain its gain here is 1

Result<void> in_range(const char* what, double found, double least, double most, const char* unit) {
  if (found >= least && found <= most) return {};
  return Error{std::string("wind level: ") + what + " is " + decimal(found) + unit + ", expected " + decimal(least) +
               " to " + decimal(most) + unit};
}

int rounded(double x) { return static_cast<int>(x + 0.5); }

void set_filters(Design& d) {
  const double rate = d.analysis_rate_hz;
  d.high_pass = high_pass(100, 0.707, rate);
  d.low_pass = low_pass(900, 0.707, rate);
  d.low = band_pass(126.5, 1.054, rate);
  d.high = band_pass(2646, 1.764, rate);
  const auto power = [](double gain) { return static_cast<float>(gain * gain); };
  d.total_gain = power(d.high_pass.gain);
  d.voice_gain = power(d.high_pass.gain * d.low_pass.gain);
  d.low_gain = power(d.low.gain);
  d.high_gain = power(d.high.gain);
  const double zero = 1 - approach(1 / rate, 1 / (2 * pi * kLevelHz));
  d.level_zero = static_cast<float>(zero);
  d.level_gain = d.voice_gain / static_cast<float>(power_of_zero(zero, kLevelHz, rate));
}

void set_times(Design& d, const WindOptions& options) {
  const double hop_seconds = d.hop / d.analysis_rate_hz;
  d.power_approach = static_cast<float>(approach(hop_seconds, 0.050));
  d.voice_release = static_cast<float>(approach(hop_seconds, 0.300));
  d.tone_approach = static_cast<float>(approach(hop_seconds, 0.150));
  d.slow_rise = static_cast<float>(approach(hop_seconds, 0.350));
  d.slow_fall = static_cast<float>(approach(hop_seconds, 0.100));
  d.floor_fall = static_cast<float>(approach(hop_seconds, 0.050));
  d.floor_rise_db = static_cast<float>(options.floor_rise_db_per_second * hop_seconds);
  d.room_rise_db = 9 * d.floor_rise_db;
  d.room_fall = static_cast<float>(approach(hop_seconds, 2));
  d.swell_fall = static_cast<float>(approach(hop_seconds, 6));
  d.room_hops = rounded(3 / hop_seconds);

  const double rate = options.frame_rate_hz;
  d.smoothing = static_cast<float>(approach(1 / rate, options.smoothing_seconds));
  d.power_exponent = static_cast<float>(options.exponent / 2);
  d.trust_frames = rounded(0.08 * rate);
  d.bridge_delay_frames = rounded(0.05 * rate) + 1;
  d.bridge_keep = static_cast<float>(1 - approach(1 / rate, 0.5));
  d.wind_step = static_cast<float>(1 / (0.08 * rate));
  d.sustain_frames = static_cast<float>(0.24 * rate);
  d.quiet_run_frames = rounded(0.3 * rate);
  d.quiet_span_frames = static_cast<float>(10 * rate);
  d.first_gust_db = decibels(static_cast<float>(options.first_gust_rms * options.first_gust_rms));
  d.gust_rest_frames = rounded(0.25 * rate) + 1;
  d.min_gust_frames = rounded(0.1 * rate) + 1;
}

}  // namespace

std::string decimal(double x) {
  std::string text = std::to_string(x);
  while (text.back() == '0') text.pop_back();
  if (text.back() == '.') text.pop_back();
  return text;
}

Design design(const SoundFormat& format, const WindOptions& options) {
  Design d;
  d.channels = format.channels;
  d.box = static_cast<int>(format.rate_hz / kMinBoxedHz);
  if (d.box < 1) d.box = 1;
  const double boxed = format.rate_hz / d.box;
  d.decimation = static_cast<int>(boxed / 8000);
  const double rate = boxed / d.decimation;
  d.analysis_rate_hz = rate;
  if (d.decimation > 1) d.taps = windowed_sinc(4 * d.decimation, 3800 / boxed);
  for (float& tap : d.taps) tap /= static_cast<float>(d.box);  // Decimator sums `box` samples and does not divide

  set_filters(d);
  // Delay of the decimating low-pass (half its length) plus that of the 900 Hz low-pass at low frequencies, 1 / (2π ·
  // 900 Hz · Q).
  d.delay_seconds = static_cast<double>(d.taps.size()) / 2 / boxed + 0.00025;
  d.voice_step = rounded(rate / 4000);
  d.hop = d.voice_step * rounded(rate / d.voice_step * 0.01);
  d.first_lag = rounded(rate / d.voice_step / 400);
  d.last_lag = rounded(rate / d.voice_step / 70);
  set_times(d, options);
  return d;
}

Result<void> check(const SoundFormat& format, const WindOptions& options) {
  if (auto ok = in_range("the sound's rate", format.rate_hz, 8000, 192000, " Hz"); !ok) return ok;
  if (auto ok = in_range("the number of channels", format.channels, 1, kMaxChannels, ""); !ok) return ok;
  if (auto ok = in_range("the frame rate", options.frame_rate_hz, 1, 1000, " Hz"); !ok) return ok;
  if (auto ok = in_range("the exponent", options.exponent, 0.1, 2, ""); !ok) return ok;
  if (auto ok = in_range("the smoothing", options.smoothing_seconds, 0, 1, " s"); !ok) return ok;
  if (auto ok = in_range("the floor's rise", options.floor_rise_db_per_second, 0, 60, " dB/s"); !ok) return ok;
  return in_range("the first gust's RMS", options.first_gust_rms, 1e-6, 8, "");
}

}  // namespace wisp::wind
