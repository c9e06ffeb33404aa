#pragma once
// Wind heard by a microphone: how strong it blows, frame by frame, and whether it is blowing at all.
//
// Reissell & Pai 2001, section 3.3, take the plain RMS of the sound at the video's frame rate, less the mean of the
// stretches without wind. That stays here (`rms`, `rms_clean`). Beyond it: a measure proportional to wind speed, from a
// band that microphones pass, and a confidence that tells blowing from talking (docs/explanation/wind.md has features
// and figures).

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "wisp/base/result.hpp"

namespace wisp {

/// What the samples are.
struct SoundFormat {
  double rate_hz = 44100;  ///< samples a second of each channel, 8000 to 192000
  int channels = 1;        ///< interleaved channels, 1 to 8; powers are averaged over them
};

/// How the wind level is made.
struct WindOptions {
  double frame_rate_hz = 60;  ///< frames a second, 1 to 1000: the video's, or the model's

  /// Wind speed goes as the band's RMS to this power, 0.1 to 2. The default, 1/2, is what stagnation pressure gives
  /// (pressure as the square of speed) and what the one public record of microphones beside an anemometer bears out
  /// (0.55 ± 0.04; docs/explanation/wind.md); 1 is a plain RMS. It belongs to the microphone: set it where the truth is
  /// known.
  double exponent = 0.5;

  /// Mean of the level over this time, seconds, 0 (each frame by itself) to 1. A frame of 16 ms tells its level to
  /// some ten per cent; whatever learns from it averages better than a fixed mean would, so the default is 0.
  double smoothing_seconds = 0;

  /// How fast the background is believed to grow, dB a second, 0 to 60. At 1 a fan that is switched on passes for wind
  /// for ten to thirty seconds, and wind that never pauses for that long passes for a fan. Under a sound that is no
  /// blowing it grows nine times as fast. 0: as first heard, for ever.
  double floor_rise_db_per_second = 1;

  /// Wind 1 before any blowing was heard: this RMS of the band, full scale 1, 1e-6 to 8. It moves after each gust, by
  /// whether that was likelier a soft breath or a hard blow, and never while it blows.
  double first_gust_rms = 0.04;
};

/// The wind during one video frame. Amplitudes are root mean squares with full scale 1.
struct WindFrame {
  std::int64_t index = 0;  ///< frame k covers the sound from k / frame rate to (k + 1) / frame rate
  float rms = 0;           ///< the paper's: plain RMS of all samples in the frame
  float rms_clean = 0;     ///< rms less the background's, not below 0
  float level = 0;         ///< RMS of the band 100–900 Hz, its spectrum levelled, less the background in power
  float speed = 0;         ///< proportional to wind speed; 1 lies between soft breath and hard blowing (in a
                           ///< recording: the 95th percentile while it blows)
  float wind = 0;          ///< a model's input: speed where it sounds like blowing, 0 where nothing is heard, and under
                           ///< another sound no more than the wind before it (in a recording: and after it, and under a
                           ///< knock far above wind 1); live at most 1 until wind above 1 that sounds like blowing adds
                           ///< up to 0.24 s of wind 1
  float confidence = 0;    ///< 0 to 1: this is blowing, not talking
  float background = 0;    ///< the plain RMS of the background as known at this frame
  float clipped = 0;       ///< share of samples at full scale, 0 to 1
};

/// What a guided calibration asks of whoever sits at the microphone.
enum class WindAsk {
  kBreatheGently,  ///< what is to lean a flame and not to put it out
  kBlowHard,       ///< what is to put it out
};

/// What a microphone in a room was found to be: kept, it spares the next start the finding.
struct WindCalibration {
  float background_rms = 0;    ///< plain RMS without wind
  float background_level = 0;  ///< RMS of the level's band without wind
  float floor_db = -95;        ///< loudness without wind: power of 100–900 Hz, dB of full scale
  float gust_rms = 0;          ///< RMS of the band at wind 1; 0: not known yet
};

/// What a call of feed() took and made.
struct WindFed {
  std::size_t samples = 0;  ///< samples taken from the block (all channels counted)
  std::size_t frames = 0;   ///< frames written
};

/// Turns sound into wind as it comes.
///
/// Frames do not depend, to the bit, on how the sound was cut into blocks, nor on compiler or machine: all arithmetic
/// after and at creation is + − × ÷ and square root in a fixed order. feed() allocates nothing, locks nothing, calls
/// nothing of the system. Movable; not for several threads at once.
class WindLevel {
 public:
  /// Returns an estimator at the start of a stream.
  /// Errors: rate, channels or an option outside its range, named with what was found and what is allowed.
  static Result<WindLevel> create(const SoundFormat& format, const WindOptions& options = {});

  WindLevel(WindLevel&&) noexcept;
  WindLevel& operator=(WindLevel&&) noexcept;
  ~WindLevel();

  /// Takes interleaved samples, full scale ±1, until they are used up or `frames` is full; feed the rest again then.
  /// NaN counts as 0; beyond ±8 is clamped. Returns how many samples were taken and frames written.
  ///
  /// Precondition: samples.size() is a multiple of the channels.
  WindFed feed(std::span<const float> samples, std::span<WindFrame> frames);

  /// The same for 16-bit samples: the same frames as those samples divided by 32768.
  WindFed feed(std::span<const std::int16_t> samples, std::span<WindFrame> frames);

  /// The latest frame made; all zero before the first.
  const WindFrame& latest() const;

  /// Takes the coming `seconds` of sound (0.5 to 30 used) for what was requested. A soft breath at one microphone is as
  /// loud as a hard one at another: ask for breath and blowing in turn where that matters. The room needs no
  /// calibration.
  void calibrate(WindAsk ask, double seconds = 3);

  /// Whether calibrate()'s time is still running.
  bool calibrating() const;

  /// Whether the last calibration is over and heard what it asked for: 0.1 s of blowing, where that was it.
  bool calibrated() const;

  /// How much louder the room is by now than in its first seconds or ever since, dB, not below 0: what goes on without
  /// a pause and is no breath. From 6 on something steady has begun (rain, a fan, an engine) that may be taken for
  /// wind; after reset() it is the room.
  float room_rise_db() const;

  /// What is known of microphone and room by now.
  WindCalibration calibration() const;

  /// Starts from what was known of this microphone and room before: wind 1 and the background's means. How loud the
  /// room is now, is heard.
  void set_calibration(const WindCalibration& known);

  /// Forgets everything but the options.
  void reset();

  /// Seconds between wind and the frame that tells of it, beyond the frame itself: the delay of filters and smoothing.
  double latency_seconds() const;

 private:
  struct State;
  explicit WindLevel(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace wisp
