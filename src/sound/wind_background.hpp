#pragma once
// What the microphone hears when nobody blows, found while it listens.

#include "sound/wind_design.hpp"
#include "sound/wind_kernel.hpp"
#include "sound/wind_math.hpp"

namespace wisp::wind {

constexpr float kNothingDb = -110;  ///< of loudness: below, no sound comes at all (a muted or starting stream)
constexpr float kMinFloorDb = -95;  ///< a floor below this is a gated microphone's, not a room's
constexpr float kRoomDb = -70;      ///< a room at first hearing: no louder than this, so that a first gust is one
constexpr float kQuietDb = 6;       ///< of loudness over the floor: no wind below this
constexpr float kTopDb = 3;         ///< the floor lies at most so far below the loudest that the room was
constexpr int kWarmHops = 15;       ///< until the 50 ms mean has forgotten its start

/// The loudness that the sound keeps coming back to: falls to a softer sound within 50 ms, rises slowly.
template <class T>
class Floor {
 public:
  void follow(T loudness_db, const Design& d) {
    if (loudness_db < T(kNothingDb)) {
      warm_ = 0;
      return;
    }
    if (warm_ < kWarmHops) {
      ++warm_;
      if (known_ || warm_ < kWarmHops) return;
      set(loudness_db < T(kRoomDb) ? loudness_db : T(kRoomDb));
    }
    const T rise = T(d.floor_rise_db);
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

/// Means over quiet frames: plainly over the first ones, forgetting later.
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

/// Floor and quiet means together, and their calibration.
template <class T>
class Background {
 public:
  void end_hop(T loudness_db, const Design& d) { floor_.follow(loudness_db, d); }

  void end_frame(const Observation<T>& seen, const Design& d) {
    if (room_frames_ > 0) return learn_room(seen);
    if (room_db_ < T(kMinFloorDb) && floor_.known()) room_db_ = floor_.level_db();
    follow_top(seen.loudness_db, d);
    if (seen.loudness_db < T(kNothingDb) || !floor_.known()) return;
    const T floor = floor_.level_db();
    const bool quiet = seen.loudness_db < floor + T(kQuietDb) && last_floor_ < floor + T(1.0F);
    last_floor_ = floor;
    run_ = quiet ? run_ + 1 : 0;
    if (run_ <= d.quiet_run_frames) return;
    // A room that turns out quieter than believed is learned anew: what was taken for it was a long blow.
    if (mean_.known() && seen.loudness_db < mean_.loudness_db() - T(kQuietDb)) mean_ = {};
    mean_.add(seen, d.quiet_span_frames);
  }

  /// Takes the coming frames as the room without wind.
  void calibrate(int frames) {
    room_frames_ = frames;
    room_ = {};
    top_db_ = T(kMinFloorDb);
  }

  int frames_to_calibrate() const { return room_frames_; }

  void set(T rms, T band_power, T loudness_db, const Design& d) {
    mean_.set(rms, band_power, loudness_db, d.quiet_span_frames);
    floor_.set(loudness_db);
    room_db_ = last_floor_ = floor_.level_db();
    top_db_ = T(kMinFloorDb);
    room_frames_ = 0;
  }

  /// Loudness of the room. One that was calibrated may swell as it did then: the sea, a fan that labours.
  T floor_db() const {
    const T swell = top_db_ - T(kTopDb);
    return floor_.level_db() < swell ? swell : floor_.level_db();
  }

  /// How far the floor has risen since the room was learned, dB, not below 0.
  T rise_db() const { return room_db_ < floor_.level_db() ? floor_.level_db() - room_db_ : T(0.0F); }

  const QuietMean<T>& mean() const { return mean_; }

 private:
  void learn_room(const Observation<T>& seen) {
    room_.add(seen, 1e9F);
    if (top_db_ < seen.loudness_db) top_db_ = seen.loudness_db;
    mean_ = room_;
    floor_.set(room_.loudness_db());
    room_db_ = last_floor_ = floor_.level_db();
    run_ = 0;
    --room_frames_;
  }

  /// The room's own sounds, not loud enough to be heard as something else, lift what it may swell to.
  void follow_top(T loudness_db, const Design& d) {
    if (top_db_ < T(kMinFloorDb + 1)) return;  // never calibrated
    if (top_db_ < loudness_db && loudness_db < floor_db() + T(kQuietDb)) {
      const T most = top_db_ + T(d.top_rise_db);
      top_db_ = loudness_db < most ? loudness_db : most;
    } else if (loudness_db < top_db_) {
      top_db_ = top_db_ - T(d.top_fall_db);
    }
  }

  Floor<T> floor_;
  QuietMean<T> mean_;
  T top_db_ = T(kMinFloorDb);  ///< loudest that a calibrated room was
  QuietMean<T> room_;
  T room_db_ = T(kMinFloorDb - 1);  ///< the floor when the room was learned; below kMinFloorDb: it was not
  T last_floor_ = T(kMinFloorDb);
  int run_ = 0;
  int room_frames_ = 0;
};

}  // namespace wisp::wind
