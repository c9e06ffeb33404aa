#pragma once
// The wind of a whole recording: as WindLevel, but the background is the mean of all stretches without wind, the gain
// is exact, and under voices the wind is read between their harmonics, since the whole is known when the frames are
// made.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "wisp/base/result.hpp"
#include "wisp/sound/wind_level.hpp"

namespace wisp {

/// The wind of a recording and what was found on the way.
struct WindTrack {
  std::vector<WindFrame> frames;  ///< one a video frame that the sound covers; a last part frame is dropped
  WindCalibration calibration;    ///< background and gust level of the whole
  float one_rms = 0;              ///< RMS of the band at speed 1: the gust level, or the option's where nothing blows
  double seconds = 0;             ///< length of the sound
  float quiet_share = 0;          ///< share of frames taken as background
  float blowing_share = 0;        ///< share of frames whose wind is above 0.05
  float clipped_share = 0;        ///< share of samples at full scale
  bool silent = false;            ///< nothing at all is heard (below −80 dB throughout)
  bool background_found = false;  ///< false: no stretch without wind was found; the background is then the softest part
};

/// Makes a WindTrack from sound that comes in blocks; keeps its wind band (16 kB a second a channel), not
/// the sound.
class WindTracker {
 public:
  /// For video at a fixed frame rate (options.frame_rate_hz). Errors: as WindLevel::create.
  static Result<WindTracker> create(const SoundFormat& format, const WindOptions& options = {});

  /// For video whose frames come at uneven times: frame k covers the sound from frame_seconds[k] to
  /// frame_seconds[k + 1], so there is one frame fewer than times.
  /// Errors: as WindLevel::create; times not finite, negative or not ascending (named by index).
  static Result<WindTracker> create(const SoundFormat& format, std::span<const double> frame_seconds,
                                    const WindOptions& options = {});

  WindTracker(WindTracker&&) noexcept;
  WindTracker& operator=(WindTracker&&) noexcept;
  ~WindTracker();

  /// Takes interleaved samples, full scale ±1 (or 16-bit).
  ///
  /// Precondition: samples.size() is a multiple of the channels.
  void feed(std::span<const float> samples);
  void feed(std::span<const std::int16_t> samples);

  /// The wind of all that was fed. Errors: the sound is shorter than one frame.
  Result<WindTrack> finish() const;

 private:
  struct State;
  explicit WindTracker(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

/// The wind of sound that is all there. Errors: as WindTracker.
Result<WindTrack> wind_from_sound(std::span<const float> interleaved, const SoundFormat& format,
                                  const WindOptions& options = {});

}  // namespace wisp
