#pragma once
// Estimates the background level, that is the sound without wind, while listening.

#include "sound/wind_design.hpp"
#include "sound/wind_kernel.hpp"
#include "sound/wind_math.hpp"

namespace wisp::wind {

constexpr float kMinFloorDb = -95;  ///< a lower floor is that of a gated microphone
constexpr float kQuietDb = 6;       ///< minimum loudness of wind over the floor
constexpr float kSwellDb = 3;       ///< maximum distance of the floor below the room's recent loudness

/// Floor of loudness. It starts at the first loudness heard, falls to softer sound within 50 ms, and rises: fast during
/// sound unlike blowing, slowly during blowing.
template <class T>
class Floor {
 public:
  void follow(T loudness_db, bool blows, const Design& d) {
    if (loudness_db < T(kNothingDb)) {
      warm_ = 0;
      return;
    }
    if (warm_ < kWarmHops) {
      ++warm_;
      if (known_ || warm_ < kWarmHops) return;
      set(loudness_db);
    }
    const T rise = T(blows ? d.floor_rise_db : d.room_rise_db);
    if (loudness_db < level_) {
      level_ = level_ + T(d.floor_fall) * (loudness_db - level_);
    } else {
      level_ = loudness_db < level_ + rise ? loudness_db : level_ + rise;
    }
    if (level_ < T(kMinFloorDb)) level_ = T(kMinFloorDb);
  }

  void set(T loudness_db) {
    level_ = loudness_db < T(kMinFloorDb) ? T(kMinFloorDb) : loudness_db;
    known_ = true;
  }

  bool known() const { return known_; }
  T level_db() const { return level_; }

 private:
  T level_ = T(kMinFloorDb);
  int warm_ = 0;
  bool known_ = false;
};

/// Means over quiet frames: unweighted at first, with forgetting later.
template <class T>
class QuietMean {
 public:
  void add(const Observation<T>& seen, float span_frames) {
    if (count_ < span_frames) count_ += 1.0F;
    const T share = T(1.0F / count_);
    rms_ = rms_ + share * (seen.rms - rms_);
    band_power_ = band_power_ + share * (seen.band_power - band_power_);
    loudness_db_ = loudness_db_ + share * (seen.loudness_db - loudness_db_);
  }

  /// Sets the means from earlier knowledge; `loudness_db` is the current loudness.
  void set(T rms, T band_power, T loudness_db, float count) {
    rms_ = rms;
    band_power_ = band_power;
    loudness_db_ = loudness_db;
    count_ = count;
  }

  bool known() const { return count_ > 0; }
  T rms() const { return rms_; }
  T band_power() const { return band_power_; }
  T loudness_db() const { return loudness_db_; }

 private:
  T rms_ = T(0.0F);
  T band_power_ = T(0.0F);
  T loudness_db_ = T(kMinFloorDb);
  float count_ = 0;
};

/// Tracks floor and quiet means together.
template <class T>
class Background {
 public:
  /// `sudden`: the sound began suddenly and continues; `blows`: it also sounds like blowing.
  void end_hop(T loudness_db, bool sudden, bool blows, const Design& d) {
    floor_.follow(loudness_db, blows, d);
    if (!floor_.known()) return;
    follow_room(d);
    if (!sudden && swell_db_ < loudness_db) swell_db_ = loudness_db;
    if (floor_.level_db() < swell_db_) swell_db_ = swell_db_ + T(d.swell_fall) * (floor_.level_db() - swell_db_);
  }

  void end_frame(const Observation<T>& seen, const Design& d) {
    if (seen.loudness_db < T(kNothingDb) || !floor_.known()) return;
    const T floor = floor_.level_db();
    const bool quiet = seen.loudness_db < floor + T(kQuietDb) && last_floor_ < floor + T(1.0F);
    last_floor_ = floor;
    run_ = quiet ? run_ + 1 : 0;
    if (run_ <= d.quiet_run_frames) return;
    // A room quieter than assumed resets the means: a long blow had been taken for the background.
    if (mean_.known() && seen.loudness_db < mean_.loudness_db() - T(kQuietDb)) mean_ = {};
    mean_.add(seen, d.quiet_span_frames);
  }

  /// Sets the background from earlier knowledge; `loudness_db` is the current loudness.
  void set(T rms, T band_power, T loudness_db, const Design& d) {
    mean_.set(rms, band_power, loudness_db, d.quiet_span_frames);
  }

  /// Loudness of the room, including its recent swells (sea, a labouring fan), which may recur.
  T floor_db() const {
    const T swell = swell_db_ - T(kSwellDb);
    return floor_.level_db() < swell ? swell : floor_.level_db();
  }

  /// Rise of the floor above the room's, dB, ≥ 0.
  T rise_db() const { return room_db_ < floor_.level_db() ? floor_.level_db() - room_db_ : T(0.0F); }

  const QuietMean<T>& mean() const { return mean_; }

 private:
  /// Tracks the room's floor: the mean over the first seconds, later it only falls.
  void follow_room(const Design& d) {
    const T floor = floor_.level_db();
    if (room_hops_ == 0) room_db_ = floor;
    if (room_hops_ < d.room_hops) ++room_hops_;
    const float share = room_hops_ < d.room_hops ? 1.0F / static_cast<float>(room_hops_) : d.room_fall;
    if (floor < room_db_ || room_hops_ < d.room_hops) room_db_ = room_db_ + T(share) * (floor - room_db_);
  }

  Floor<T> floor_;
  QuietMean<T> mean_;
  T swell_db_ = T(kMinFloorDb);  ///< recent maximum loudness without a sudden beginning
  T room_db_ = T(kMinFloorDb);
  T last_floor_ = T(kMinFloorDb);
  int run_ = 0;
  int room_hops_ = 0;
};

}  // namespace wisp::wind
