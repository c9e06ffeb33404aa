#pragma once
// Estimates the wind from a clip's sound, one value per frame of its picture (section 3.3 of the paper).

#include <span>
#include <utility>
#include <vector>

#include "wisp/capture/clip/clip_capture.hpp"
#include "wisp/sound/wind_track.hpp"

namespace wisp {

/// Inserts a clip's wind before a recording's channels, if the clip has wind.
void join_wind(const ClipWind& wind, WindMeasure measure, Recording& recording);

/// Measures the wind of a clip from its sound, block by block.
class ClipEar {
 public:
  /// Seconds between a block's time stamp and the end of the block before it, above which sound was lost or repeated.
  static constexpr double kJitter = 0.05;

  /// Creates an ear that returns `rate_hz` wind frames per second. Errors: as WindTracker. Precondition: rate_hz > 0.
  static Result<ClipEar> create(const SoundFormat& format, double rate_hz);

  /// Takes interleaved samples, full scale ±1, from `begin` seconds after the picture's first frame (may be negative).
  void feed(double begin, std::span<const float> samples);

  /// Returns the wind of frames `skipped` to before `frames`; none if the sound is silent. Errors: as WindTracker.
  Result<ClipWind> finish(std::size_t frames, std::size_t skipped = 0) const;

 private:
  struct Hole {
    std::size_t at = 0;  // number of measured frames before the hole
    double frames = 0;   // number of missing frames
  };
  ClipEar(WindTracker tracker, const SoundFormat& format, double rate_hz)
      : tracker_(std::move(tracker)), format_(format), rate_hz_(rate_hz) {}
  void be_silent(double samples);
  void pass_over(double seconds);
  std::size_t place(std::span<const WindFrame> heard, std::size_t frames, std::vector<WindFrame>& placed) const;

  WindTracker tracker_;
  SoundFormat format_;
  double rate_hz_;
  double fed_ = 0;       // samples per channel fed to the tracker
  double heard_to_ = 0;  // end of the sound, in seconds after the picture's first frame
  bool begun_ = false;
  std::vector<Hole> holes_;
  float peak_ = 0;
};

}  // namespace wisp
