#pragma once
// What the microphone hears when nobody blows, and how strong a gust is: both found while it listens.

#include <array>
#include <cstddef>

#include "run/wind_design.hpp"
#include "run/wind_math.hpp"

namespace wisp::wind {

/// The loudness that the sound keeps coming back to: falls to a softer sound in 50 ms, rises 1 dB a second.
template <class T>
class Floor {
 public:
  void follow(T loudness_db, const Design& d) {
    if (!known_ || plain(loudness_db) < plain(level_)) {
      level_ = known_ ? level_ + T(d.floor_fall) * (loudness_db - level_) : loudness_db;
      known_ = true;
      return;
    }
    level_ = level_ + T(d.floor_rise_db);
    if (plain(level_) > plain(loudness_db)) level_ = loudness_db;
  }

  void set(T loudness_db) {
    level_ = loudness_db;
    known_ = true;
  }

  bool known() const { return known_; }
  T level_db() const { return level_; }

 private:
  T level_ = T(-120.0F);
  bool known_ = false;
};

/// Mean of what was heard in quiet frames: over all of them at first, over the last `span` frames later.
template <class T>
class QuietMean {
 public:
  void add(T rms, T band_power, float span) {
    if (count_ < span) count_ += 1.0F;
    const T share = T(1.0F) / T(count_);
    rms_ = rms_ + share * (rms - rms_);
    band_power_ = band_power_ + share * (band_power - band_power_);
  }

  void set(T rms, T band_power, float count) {
    rms_ = rms;
    band_power_ = band_power;
    count_ = count;
  }

  T rms() const { return rms_; }
  T band_power() const { return band_power_; }
  bool known() const { return count_ > 0; }

 private:
  T rms_ = T(0.0F);
  T band_power_ = T(0.0F);
  float count_ = 0;
};

/// The 95th percentile of gust levels, from a histogram over decibels that forgets slowly.
class GustLevel {
 public:
  /// `first_db`: what to say before anything was heard; it weighs as much as `weight` frames.
  void start(float first_db, float weight);

  /// Counts one frame of blowing; older ones weigh `keep` of what they did.
  void add(float db, float keep);

  /// 95th percentile, dB.
  float high_db() const;

 private:
  static constexpr int kBins = 81;
  static constexpr float kStepDb = 1.5F;
  static constexpr float kLeastDb = -100;
  std::array<float, kBins> counts_{};
};

}  // namespace wisp::wind
