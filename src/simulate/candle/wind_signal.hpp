#pragma once
// Wind as a function of time: calm, gusts with rests between them, or a recording's channel.

#include <vector>

#include "wisp/base/result.hpp"
#include "wisp/record/recording.hpp"
#include "wisp/simulate/candle_clip.hpp"

namespace wisp {

/// A wind at a fixed rate, to be read sequentially or at any time.
class WindSignal {
 public:
  /// Generates a wind, `seconds` long.
  /// Errors: an option outside its range.
  static Result<WindSignal> generate(const WindSignalOptions& options, double seconds);

  /// Reads a recording's only input, in m/s, with missing samples interpolated linearly.
  /// Errors: not one input, or only missing samples.
  static Result<WindSignal> from_recording(const Recording& recording);

  /// Returns the wind at a time, interpolated linearly and constant beyond the ends.
  double at(double seconds) const;

  double seconds() const;
  double rate_hz() const { return rate_hz_; }
  const std::vector<double>& samples() const { return samples_; }

  /// Returns the times at which an extinguished candle is relit, ascending, in seconds.
  const std::vector<double>& relights() const { return relights_; }

 private:
  double rate_hz_ = 0;
  std::vector<double> relights_;
  std::vector<double> samples_;
};

}  // namespace wisp
