#pragma once
// Simulation of a clip of a candle in wind, with sound and ground truth.

#include <cstdint>
#include <functional>
#include <optional>
#include <span>

#include "wisp/base/result.hpp"
#include "wisp/record/recording.hpp"

namespace wisp {

/// Flow, flame and candle. The parameters were calibrated together: the tip's height depends on cell and time step.
struct CandleRigOptions {
  // Grid and time.
  int columns = 64;              ///< 16 … 1024
  int rows = 128;                ///< 16 … 1024
  double cell_mm = 2.0 / 3;      ///< 0.1 … 2; a flame is about 6 mm wide
  double rate_hz = 60;           ///< frames per second, 1 … 1000
  double steps_a_second = 1200;  ///< 100 … 100000, rounded to whole steps per frame: the flame depends on the step, not
                                 ///< on the camera's rate

  // The candle.
  double position = 0.35;      ///< candle axis as a share of the width, 0.1 … 0.9: the lee side needs room
  double wick_damping = 80;    ///< 1/s, 0 … 10000, calibrated: drag of the wick; without it the flame dies at 0.5 m/s
  double wick_cold = 500;      ///< K, 300 … 2000, calibrated: temperature around the wick at which it emits no fuel
  double wick_warm = 900;      ///< K, wick_cold + 1 … 3000, calibrated: temperature at which it emits fuel_rate
  double fuel_rate = 1.35e-4;  ///< m²/s, 0 … 0.01, calibrated: volume of cold vapour per second and depth
};

/// Options of the virtual camera. Colours resemble a photograph of a candle; they are not colorimetry.
struct VirtualCameraOptions {
  int width = 320;         ///< pixels, 16 … 4096; even, as required by video
  int height = 480;        ///< pixels, 16 … 4096; even
  double gain = 2.5;       ///< exposure: higher is brighter and whiter, 0.01 … 100
  double glow = 0.05;      ///< light scattered in the lens, as a share of the flame's, 0 … 1
  double noise = 1.2;      ///< standard deviation of the sensor's noise in steps of 255, 0 … 50
  std::uint64_t seed = 1;  ///< seed of the noise
};

/// Options of the virtual microphone.
struct VirtualMicrophoneOptions {
  double rate_hz = 44100;  ///< samples per second, 4000 … 192000
  double exponent = 2;     ///< amplitude ∝ wind^exponent, 0.5 … 4: 2 is stagnation pressure; an outdoor measurement
                           ///< gave about 1.5
  double level = 0.12;     ///< root mean square of the sound at 1 m/s, full scale 1, 1e-6 … 1; puffs exceed 1 m/s
  double corner_hz = 300;  ///< corner of the spectrum, flat below, −12 dB per octave above, 20 … 5000, ≤ 0.4 rate_hz
  double hiss = 4e-4;      ///< root mean square of the background, white, 0 … 0.1
  double other_sounds = 0.05;  ///< other sounds (half voice, half knocks): 1 / mean pause in s, 0 … 10; 0: none
  std::uint64_t seed = 1;
};

/// Kinds of wind.
enum class WindKind {
  kCalm,      ///< no wind: a perfectly still flame
  kDraughts,  ///< air of a closed room, a few cm/s from either side: brightness varies by 1 %, as a photodiode measured
              ///< beside an undisturbed candle (cpldcpu/RealCandle)
  kGusts,     ///< wideband noise and gusts of all lengths, with rests: excitation for learning
};

/// Parameters of the wind. Speeds in m/s.
struct WindSignalOptions {
  WindKind kind = WindKind::kGusts;
  double most = 1.0;         ///< upper bound of gusts and noise together, 0 … 10; a candle survives 1 m/s
  double noise = 0.35;       ///< typical standard deviation of the wideband part outside rests, 0 … 10
  double bandwidth_hz = 6;   ///< bandwidth of the noise, two poles, 0.1 … 50; slow wind excites no resonance
  double gust = 0.55;        ///< typical peak of a gust, 0 … 10
  double rest_share = 0.25;  ///< share of calm time, 0 … 0.9
  bool both_sides = false;   ///< gusts from the right as well (negative); a microphone hears only strength
  double blow_out_at = -1;   ///< time of a puff of 3 m/s for 0.3 s that extinguishes the flame, seconds; negative: none
  double puff_every = 0;     ///< seconds between puffs of 1.2 to 4 m/s and 0.05 to 0.6 s, some of which extinguish the
                             ///< flame: data for learning extinction; 0: none, else 2 … 86400
  double relight_after = 2;  ///< seconds from the start of a blow-out or a puff until it is relit; negative: never
  std::uint64_t seed = 1;
};

/// Options of the clip. Its frame rate is rig.rate_hz.
struct CandleClipOptions {
  CandleRigOptions rig{};
  VirtualCameraOptions camera{};
  VirtualMicrophoneOptions microphone{};
  WindSignalOptions wind{};
  std::optional<Recording> wind_recording{};  ///< if set, its only input, m/s, replaces `wind`, which must then have
                                              ///< neither blow-out nor puffs; constant after its end
  double seconds = 60;                        ///< length, 0.001 … 86400
  double settle_seconds = 1.5;  ///< time simulated in still air before the first frame, 0 … 60, for a steady flame
};

/// One frame of the clip.
struct CandleFrame {
  std::uint64_t index = 0;
  double seconds = 0;  ///< since the clip's start
  int width = 0;
  int height = 0;
  std::span<const std::uint8_t> picture;  ///< rows from the top, RGB, width × height × 3; valid during the call only
};

/// Callbacks that receive the clip. Each is called from the thread that called simulate_candle, in time order: a
/// frame's picture first, then the sound during it. An error ends the clip and is returned.
struct CandleClipOutputs {
  std::function<Result<void>(const CandleFrame&)> on_frame;
  std::function<Result<void>(std::span<const float>)> on_sound;  ///< mono, microphone.rate_hz, within ±1
  std::function<void(double share)> on_progress;                 ///< 0 … 1, once per frame
};

/// Simulates a candle, its film and its sound. Returns the ground truth, one row per frame: u:wind[m/s] (at the frame's
/// end), y:tip.x, y:tip.y, y:height [mm], y:lean[deg], y:brightness[mm2], y:lit[1], and the outline's control points
/// y:p0.x[px], y:p0.y[px], … in pixels of the picture; tip and outline are missing (NaN) while there is no flame.
/// Attributes state the view (pixels_per_mm, origin_x, origin_y), the seed, and the grid. Errors: an option outside its
/// range (which, what was found, what was expected), a missing wind channel, an error returned by an output, or a
/// numerically unstable flow (a defect; never seen).
Result<Recording> simulate_candle(const CandleClipOptions& options, const CandleClipOutputs& outputs);

}  // namespace wisp
