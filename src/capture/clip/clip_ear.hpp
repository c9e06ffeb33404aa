#pragma once
// The wind in a clip's sound, one value a frame of its picture (section 3.3 of the paper).

#include <span>
#include <utility>
#include <vector>

#include "wisp/capture/clip/clip_capture.hpp"
#include "wisp/sound/wind_track.hpp"

namespace wisp {

/// Puts a clip's wind before a recording's channels, where there is any.
void join_wind(const ClipWind& wind, WindMeasure measure, Recording& recording);

/// Hears the wind of a clip from its sound as it comes.
class ClipEar {
 public:
  /// For a picture of `rate_hz` frames a second. Errors: as WindTracker.
  ///
  /// Precondition: rate_hz > 0.
  static Result<ClipEar> create(const SoundFormat& format, double rate_hz);

  /// Takes interleaved samples, full scale ±1, that begin `begin` seconds after the picture's first frame, or before
  /// it. Where that is not where the last ones ended, sound was lost, or comes twice.
  void feed(double begin, std::span<const float> samples);

  /// The wind of the picture's first `frames` frames; none where the sound was silent. Errors: as WindTracker.
  Result<ClipWind> finish(std::size_t frames) const;

 private:
  struct Hole {
    std::size_t at = 0;  // of the frames that were heard, the one after it
    double frames = 0;
  };
  ClipEar(WindTracker tracker, const SoundFormat& format, double rate_hz)
      : tracker_(std::move(tracker)), format_(format), rate_hz_(rate_hz) {}
  void be_silent(double samples);
  void pass_over(double seconds);
  std::size_t place(std::span<const WindFrame> heard, std::size_t frames, std::vector<WindFrame>& placed) const;

  WindTracker tracker_;
  SoundFormat format_;
  double rate_hz_;
  double fed_ = 0;       // samples a channel, to the tracker
  double heard_to_ = 0;  // seconds after the picture's first frame
  bool begun_ = false;
  std::vector<Hole> holes_;
  float peak_ = 0;
};

}  // namespace wisp
