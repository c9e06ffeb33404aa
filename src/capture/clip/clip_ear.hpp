#pragma once
// The wind in a clip's sound, one value a frame of its picture (section 3.3 of the paper).

#include <span>
#include <utility>

#include "wisp/capture/clip/clip_capture.hpp"
#include "wisp/sound/wind_track.hpp"

namespace wisp {

/// Hears the wind of a clip from its sound as it comes.
class ClipEar {
 public:
  /// For a picture of `rate_hz` frames a second whose sound begins `begin` seconds after its first frame (or before it,
  /// negative). Errors: as WindTracker.
  ///
  /// Precondition: rate_hz > 0.
  static Result<ClipEar> create(const SoundFormat& format, double begin, double rate_hz);

  /// Takes interleaved samples, full scale ±1.
  void feed(std::span<const float> samples);

  /// The wind of the picture's first `frames` frames; none where the sound was silent. Errors: as WindTracker.
  Result<ClipWind> finish(std::size_t frames) const;

 private:
  ClipEar(WindTracker tracker) : tracker_(std::move(tracker)) {}
  WindTracker tracker_;
  std::size_t to_skip_ = 0;  // samples from before the first frame
  float peak_ = 0;
};

}  // namespace wisp
