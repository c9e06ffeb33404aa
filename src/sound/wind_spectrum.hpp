#pragma once
// Estimates the wind of a recording during other sounds, from the bands between a voice's harmonics.
//
// A voice occupies few of the narrow bands between 60 and 1000 Hz; wind occupies all of them, with exponentially
// distributed power: a quarter of the bands are below 0.288 of their means. With S the spectrum of wind 1 and N the
// room's, the wind's power q is therefore that for which a quarter of the bands are below 0.288 · (q S + N), whatever
// sounds in the others.

#include <cstddef>
#include <vector>

#include "sound/wind_design.hpp"

namespace wisp::wind {

/// Powers of narrow bands, one row per frame.
class Spectra {
 public:
  /// Computes powers in windows of 93 ms centred at `middles` (seconds). `channels`: levelled voice band of each
  /// channel, at `rate_hz`.
  Spectra(const std::vector<std::vector<float>>& channels, double rate_hz, const std::vector<double>& middles);

  std::size_t bands() const { return bands_; }
  const float* frame(std::size_t k) const { return powers_.data() + k * bands_; }

  /// Adds `weight` times the powers of frame `k` to `sum`.
  void add(std::size_t k, double weight, std::vector<double>& sum) const;

 private:
  std::size_t bands_ = 0;
  std::vector<float> powers_;
};

/// Mean spectra of wind and room in those bands.
struct BandMeans {
  std::vector<double> wind;  ///< at power 1, without the room's
  std::vector<double> room;
};

/// Power of the wind in a frame, relative to wind 1.
float power_between(const float* powers, const BandMeans& means);

}  // namespace wisp::wind
