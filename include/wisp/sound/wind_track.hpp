#pragma once
// Wind estimate of a whole recording: like WindLevel, but since all sound is known when the frames are made, the
// background is the mean of all stretches without wind, wind 1 is measured over all gusts, and under voices the wind is
// measured between their harmonics.

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "wisp/base/result.hpp"
#include "wisp/sound/wind_level.hpp"

namespace wisp {

/// The wind of a recording and the estimates behind it.
struct WindTrack {
  std::vector<WindFrame> frames;  ///< one per video frame that the sound covers; a last part frame is dropped
  WindCalibration calibration;    ///< background and gust level of the whole recording
  float one_rms = 0;              ///< RMS of the whitened band at speed 1; without blowing, the option first_gust_rms
  double seconds = 0;             ///< length of the sound
  float quiet_share = 0;          ///< share of frames taken as background
  float blowing_share = 0;        ///< share of frames whose wind is above 0.05
  float clipped_share = 0;        ///< share of samples at full scale
  bool silent = false;            ///< nothing is heard (below −80 dB throughout)
  bool background_found = false;  ///< false: no stretch without wind was found; the background is then the softest part
};

/// Computes a WindTrack from sound that comes in blocks. Stores the band below 900 Hz at about 4 kHz (16 kB per second
/// and channel) in place of the sound.
class WindTracker {
 public:
  /// Returns a tracker for video at a fixed frame rate (options.frame_rate_hz). Errors: those of WindLevel::create().
  static Result<WindTracker> create(const SoundFormat& format, const WindOptions& options = {});

  WindTracker(WindTracker&&) noexcept;
  WindTracker& operator=(WindTracker&&) noexcept;
  ~WindTracker();

  /// Takes interleaved samples, full scale ±1. Precondition: samples.size() is a multiple of the channels.
  void feed(std::span<const float> samples);

  /// Returns the wind of all sound fed so far. Errors: the sound is shorter than one frame.
  Result<WindTrack> finish() const;

 private:
  struct State;
  explicit WindTracker(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

/// Returns the wind of sound that is all in memory. Errors: those of WindTracker.
Result<WindTrack> wind_from_sound(std::span<const float> interleaved, const SoundFormat& format,
                                  const WindOptions& options = {});

}  // namespace wisp
