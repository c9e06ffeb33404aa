#pragma once
// Wind as a function of time: calm, gusts with rests between them, or a recording's channel.

#include <cstdint>
#include <string>
#include <vector>

#include "wisp/base/result.hpp"
#include "wisp/record/recording.hpp"

namespace wisp {

/// What the wind does.
enum class WindKind {
  kCalm,   ///< nothing
  kGusts,  ///< wideband noise and gusts of all lengths, with rests: what a learner needs to see
};

/// The wind. Speeds in m/s.
struct WindSignalOptions {
  WindKind kind = WindKind::kGusts;
  double most = 1.0;         ///< what gusts and noise together are held to, 0 … 10; a candle lives through 1 m/s
  double noise = 0.35;       ///< standard deviation of the wideband part while it blows, 0 … 10
  double bandwidth_hz = 6;   ///< of that noise, two poles, 0.1 … 50; slower wind does not show how a flame swings
  double gust = 0.55;        ///< typical peak of a gust, 0 … 10
  double rest_share = 0.25;  ///< of the time that is calm, 0 … 0.9
  bool both_sides = false;   ///< gusts from the right as well (negative); a microphone hears only strength
  double blow_out_at = -1;   ///< seconds: a puff of 3 m/s for 0.3 s that kills the flame; negative: none
  double puff_every = 0;     ///< seconds between puffs of 1.2 to 4 m/s that last 0.05 to 0.6 s, of which some kill and
                             ///< some do not: what blowing out is learned from; 0: none, else 2 … 86400
  double relight_after = 2;  ///< seconds from a blow-out or a puff until the candle is lit again; negative: never
  std::uint64_t seed = 1;
};

/// A wind at a fixed rate, to be read one sample after the other or at any time.
class WindSignal {
 public:
  /// A generated wind, `seconds` long.
  /// Errors: an option outside its range.
  static Result<WindSignal> generate(const WindSignalOptions& options, double seconds);

  /// A recording's channel, in m/s, with missing samples filled by straight lines.
  /// Errors: no such channel, or nothing but missing samples. `channel` may be empty where there is one input only.
  static Result<WindSignal> from_recording(const Recording& recording, const std::string& channel = {});

  /// Wind at a time, in a straight line between samples; the ends are held.
  double at(double seconds) const;

  double seconds() const;
  double rate_hz() const { return rate_hz_; }
  const std::vector<double>& samples() const { return samples_; }

  /// When the candle is lit again if it is out then: ascending, in seconds.
  const std::vector<double>& relights() const { return relights_; }

 private:
  double rate_hz_ = 0;
  std::vector<double> relights_;
  std::vector<double> samples_;
};

}  // namespace wisp
