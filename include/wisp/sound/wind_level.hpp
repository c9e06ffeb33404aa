#pragma once
// Wind heard by a microphone: its strength, frame by frame, and whether it blows at all.
//
// Reissell & Pai 2001, section 3.3, take the plain RMS of the sound at the video's frame rate, minus the mean of the
// stretches without wind. These are `rms` and `rms_clean`. Departures: a measure proportional to wind speed, from a
// band that microphones pass, and a confidence that distinguishes blowing from talking (docs/explanation/wind.md has
// features and figures).

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "wisp/base/result.hpp"

namespace wisp {

/// Format of the samples.
struct SoundFormat {
  double rate_hz = 44100;  ///< samples per second of each channel, 8000 to 192000
  int channels = 1;        ///< interleaved channels, 1 to 8; powers are averaged over them
};

/// Options of the wind estimate.
struct WindOptions {
  double frame_rate_hz = 60;  ///< frames per second, 1 to 1000: the video's, or the model's

  /// Wind speed is proportional to WindFrame::level to this power, 0.1 to 2. The default, 1/2, follows from stagnation
  /// pressure (proportional to speed squared) and is supported by the one public record of microphones beside an
  /// anemometer (0.55 ± 0.04; docs/explanation/wind.md). The exponent depends on the microphone: set it if it is known.
  double exponent = 0.5;

  /// Averaging time of the level, seconds, 0 (each frame by itself) to 1. The level of a 16 ms frame has an error of
  /// about ten per cent. The default is 0, as learned models average their inputs better than a fixed mean.
  double smoothing_seconds = 0;

  /// Largest growth rate of the background estimate, dB per second, 0 to 60; during sounds other than blowing the rate
  /// is nine times as large. At 1, a fan that is switched on counts as wind for ten to thirty seconds, and wind that
  /// blows for longer than that without a pause becomes background. 0: the background never rises.
  double floor_rise_db_per_second = 1;

  /// Initial WindFrame::level at wind 1, 1e-6 to 8. After each gust, not during it, the estimate of this level moves:
  /// towards 4 dB above the gust if this was likelier a soft breath, 17 dB below the gust if likelier a hard blow.
  double first_gust_rms = 0.04;
};

/// The wind during one video frame. Amplitudes are root mean squares with full scale 1.
struct WindFrame {
  std::int64_t index = 0;  ///< frame k covers the sound from k / frame rate to (k + 1) / frame rate
  float rms = 0;           ///< measure of Reissell & Pai: plain RMS of all samples in the frame
  float rms_clean = 0;     ///< `rms` minus the RMS of the background, at least 0
  float level = 0;         ///< RMS of the band 100–900 Hz with whitened spectrum, minus the background in power
  float speed = 0;         ///< proportional to wind speed. Live, 1 lies between soft breath and hard blowing; in a
                           ///< recording, 1 is the 95th percentile of frames with blowing
  float wind = 0;          ///< a model's input: `speed` while blowing is heard, near 0 in silence. Under other sounds,
                           ///< live: at most the wind before them; in a recording: estimated between the harmonics of
                           ///< voices, and for knocks the larger wind beside them. Live, wind above 1 is clamped to 1
                           ///< until it has lasted (0.24 s at wind 1, less if stronger)
  float confidence = 0;    ///< confidence that the sound is blowing, not talking, 0 to 1
  float background = 0;    ///< the plain RMS of the background as estimated at this frame
  float clipped = 0;       ///< share of samples at full scale, 0 to 1
};

/// Request of a guided calibration to the person at the microphone.
enum class WindAsk {
  kBreatheGently,  ///< wind that leans a flame without extinguishing it
  kBlowHard,       ///< wind that extinguishes it
};

/// Estimated properties of a microphone in a room, to be stored and passed to set_calibration() at the next start.
struct WindCalibration {
  float background_rms = 0;    ///< plain RMS without wind
  float background_level = 0;  ///< RMS of the band 100–900 Hz with whitened spectrum, without wind
  float floor_db = -95;        ///< power of the band 100–900 Hz without wind, dB of full scale
  float gust_rms = 0;          ///< RMS of the band 100–900 Hz with whitened spectrum, at wind 1; 0: unknown
};

/// Numbers of samples consumed and frames produced by feed().
struct WindFed {
  std::size_t samples = 0;  ///< samples consumed from the block (all channels counted)
  std::size_t frames = 0;   ///< frames written
};

/// Estimates wind from sound as it arrives.
///
/// The division of the sound into blocks, the compiler and the machine do not change a bit of the frames: all
/// arithmetic, the design of the filters included, is + − × ÷ and square root in a fixed order. feed() allocates
/// nothing, takes no lock and makes no system call. Movable; to be used by one thread at a time.
class WindLevel {
 public:
  /// Returns an estimator at the start of a stream.
  /// Errors: rate, channels or an option outside its range, named with what was found and what is allowed.
  static Result<WindLevel> create(const SoundFormat& format, const WindOptions& options = {});

  WindLevel(WindLevel&&) noexcept;
  WindLevel& operator=(WindLevel&&) noexcept;
  ~WindLevel();

  /// Consumes interleaved samples, full scale ±1, until they are used up or `frames` is full; pass the samples that
  /// were not consumed again. NaN counts as 0; samples are clamped to ±8. Returns the numbers of samples and frames.
  /// Precondition: samples.size() is a multiple of the channels.
  WindFed feed(std::span<const float> samples, std::span<WindFrame> frames);

  /// Consumes 16-bit samples: the frames equal those of the samples divided by 32768.
  WindFed feed(std::span<const std::int16_t> samples, std::span<WindFrame> frames);

  /// Returns the latest frame; all zero before the first.
  const WindFrame& latest() const;

  /// Uses the next `seconds` of sound, clamped to 0.5 to 30, for the requested calibration. A soft breath at one
  /// microphone is as loud as a hard blow at another: for equal scales, request both in turn.
  void calibrate(WindAsk ask, double seconds = 3);

  /// Returns whether calibrate()'s time is still running.
  bool calibrating() const;

  /// Returns whether the last calibration has ended and heard at least 0.1 s of certain blowing.
  bool calibrated() const;

  /// Returns by how many dB the background is louder than in the first seconds or at its quietest since; at least 0.
  /// From 6 dB on, a steady sound may be mistaken for wind (rain, a fan, an engine); reset() makes it the background.
  float room_rise_db() const;

  /// Returns the current estimate of microphone and room.
  WindCalibration calibration() const;

  /// Continues from a stored estimate of this microphone and room: gust_rms and the background's means. The current
  /// loudness of the background is still measured.
  void set_calibration(const WindCalibration& known);

  /// Forgets everything but format and options.
  void reset();

  /// Returns the delay by filters and smoothing, seconds, in addition to the duration of a frame.
  double latency_seconds() const;

 private:
  struct State;
  explicit WindLevel(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace wisp
