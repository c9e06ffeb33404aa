#pragma once
// The wind of a recording under other sounds, read between a voice's harmonics.
//
// A voice fills few of the narrow bands between 60 and 1000 Hz; wind fills all of them, and each band's power scatters
// about its mean as an exponential does: a quarter of the bands lie below 0.288 of their means. So where S is the
// spectrum of wind 1 and N the room's, the wind's power q is that with which a quarter of the bands lie below
// 0.288 · (q S + N), whatever sounds in the others.

#include <cstddef>
#include <vector>

#include "sound/wind_design.hpp"

namespace wisp::wind {

/// Powers of narrow bands, a row for each frame.
class Spectra {
 public:
  /// Of a window of 93 ms about each frame's middle (seconds). `channels`: the voice band of each, levelled, at
  /// `rate_hz`.
  Spectra(const std::vector<std::vector<float>>& channels, double rate_hz, const std::vector<double>& middles);

  std::size_t bands() const { return bands_; }
  const float* frame(std::size_t k) const { return powers_.data() + k * bands_; }

  /// Adds a frame's powers, `weight` times.
  void add(std::size_t k, double weight, std::vector<double>& sum) const;

 private:
  std::size_t bands_ = 0;
  std::vector<float> powers_;
};

/// Spectra of wind and room in those bands.
struct BandMeans {
  std::vector<double> wind;  ///< at power 1, less the room's
  std::vector<double> room;
};

/// Power of the wind in a frame, 1 at wind 1.
float power_between(const float* powers, const BandMeans& means);

}  // namespace wisp::wind
