#pragma once
// Levels that the live estimator adapts: that of the background (sound without wind), and the reference level, at which
// wind is 1.
//
// A gust must not be its own reference: a person who blows hard from the start would calibrate the estimator to hard
// blowing. So the reference level starts at a typical value for microphones at arm's length and is constant during a
// gust. After it, the level moves to where the gust is a soft breath or a hard blow, weighted by their likelihoods.

#include <array>
#include <cstddef>

#include "sound/wind_design.hpp"
#include "sound/wind_kernel.hpp"
#include "sound/wind_math.hpp"

namespace wisp::wind {

constexpr float kMinFloorDb = -95;  ///< lower bound of the floor: only gated microphones are quieter
constexpr float kQuietDb = 6;       ///< sound less than this over the floor is quiet: background without wind
constexpr float kSwellDb = 3;       ///< floor_db() is at most this far below the background's recent maximum

/// Floor of loudness. It starts at the loudness after the first kWarmHops hops of sound, falls to softer sound with a
/// time constant of 50 ms, and rises slowly during blowing, nine times as fast during other sound.
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

/// Means over quiet frames: arithmetic over the first `span_frames`, later exponential with this time constant.
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

  /// Sets the means from earlier knowledge; `loudness_db` is the background's, `count` their weight in frames.
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
    // If it is quieter than the mean background, the mean was that of a long blow, and starts again.
    if (mean_.known() && seen.loudness_db < mean_.loudness_db() - T(kQuietDb)) mean_ = {};
    mean_.add(seen, d.quiet_span_frames);
  }

  /// Sets the means from earlier knowledge; `loudness_db` is the background's. The floor itself is still measured.
  void set(T rms, T band_power, T loudness_db, const Design& d) {
    mean_.set(rms, band_power, loudness_db, d.quiet_span_frames);
  }

  /// Returns the background's loudness: the floor, or 3 dB below the recent maximum of sound that swelled (sea, fan).
  T floor_db() const {
    const T swell = swell_db_ - T(kSwellDb);
    return floor_.level_db() < swell ? swell : floor_.level_db();
  }

  /// Returns the rise of the floor above room_db_ (see follow_room()), dB, at least 0.
  T rise_db() const { return room_db_ < floor_.level_db() ? floor_.level_db() - room_db_ : T(0.0F); }

  const QuietMean<T>& mean() const { return mean_; }

 private:
  /// Updates room_db_: the floor's mean over the first 3 s; afterwards it follows the floor only downwards.
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

/// Histogram of one gust's frames over their level in dB.
template <class T>
class GustLevel {
 public:
  void clear() {
    counts_.fill(0);
    frames_ = 0;
  }

  void add(T db) {
    T place = (db - T(kMinDb)) * T(1 / kStepDb);
    if (place < T(0.0F)) place = T(0.0F);
    if (T(kBins - 1.0F) < place) place = T(kBins - 1.0F);
    ++counts_[static_cast<std::size_t>(plain(place))];
    ++frames_;
  }

  int frames() const { return frames_; }

  /// Returns the 80th percentile, dB: a gust's beginning and end are soft.
  T high_db() const {
    int above = frames_ / 5;
    std::size_t bin = counts_.size() - 1;
    while (bin > 0 && above >= counts_[bin]) above -= counts_[bin--];
    return T(kMinDb) + T(kStepDb) * T(static_cast<float>(bin) + 0.5F);
  }

 private:
  static constexpr int kBins = 120;
  static constexpr float kStepDb = 1;
  static constexpr float kMinDb = -100;

  std::array<int, kBins> counts_{};
  int frames_ = 0;
};

template <class T>
class Reference {
 public:
  /// Starts with a level `db` that has the weight of `gusts` gusts.
  void start(T db, float gusts) {
    first_db_ = level_db_ = db;
    learned_ = gusts;
    end();
  }

  /// Adds a frame, of level `db`, to the gust if it certainly blows; after enough other frames, learns from the gust.
  void hear(bool blows, T db, const Design& d) {
    if (blows) {
      rest_frames_ = 0;
      gust_.add(db);
      return;
    }
    if (gust_.frames() == 0 || ++rest_frames_ < d.gust_rest_frames) return;
    if (gust_.frames() >= d.min_gust_frames) learn(gust_.high_db());
    end();
  }

  /// Set the level of wind 1 by a guided calibration: 4 dB above a soft breath, 17 dB below a hard blow. With both:
  /// their mean if the blow gives the higher level, otherwise the breath's. Adaptation continues from there.
  void set_soft(T gust_db) {
    soft_db_ = gust_db + T(kSoftDb);
    knows_soft_ = true;
    set_known();
  }
  void set_hard(T gust_db) {
    hard_db_ = gust_db - T(kHardDb);
    knows_hard_ = true;
    set_known();
  }

  T level_db() const { return level_db_; }

  static constexpr float kKnownGusts = 3;  ///< weight of a stored or calibrated level against heard gusts, in gusts

 private:
  static constexpr float kHardDb = 17;     ///< mean level of a hard blow above that of wind 1
  static constexpr float kSoftDb = 4;      ///< mean level of a soft breath below that of wind 1
  static constexpr float kSpreadDb = 6;    ///< standard deviation of both levels
  static constexpr float kNeither = 0.1F;  ///< likelihood of neither kind: gusts far from both move the level little
  static constexpr float kMaxGusts = 6;    ///< maximum weight of the past, in gusts
  static constexpr float kFallDb = 8;      ///< maximum fall below the initial level
  static constexpr float kRiseDb = 12;     ///< maximum rise above the initial level

  void learn(T gust_db) {
    const T hard = (gust_db - level_db_ - T(kHardDb)) * T(1 / kSpreadDb);
    const T soft = (gust_db - level_db_ + T(kSoftDb)) * T(1 / kSpreadDb);
    const T like_hard = exp2_of(hard * hard * T(-0.7213475204F));
    const T like_soft = exp2_of(soft * soft * T(-0.7213475204F));
    const T step = T(kSpreadDb) * (like_hard * hard + like_soft * soft) / (like_hard + like_soft + T(kNeither));
    level_db_ = level_db_ + T(1.0F / (learned_ + 1.0F)) * step;
    if (level_db_ < first_db_ - T(kFallDb)) level_db_ = first_db_ - T(kFallDb);
    if (first_db_ + T(kRiseDb) < level_db_) level_db_ = first_db_ + T(kRiseDb);
    if (learned_ < kMaxGusts) learned_ += 1.0F;
  }

  void set_known() {
    T level = knows_soft_ ? soft_db_ : hard_db_;
    if (knows_soft_ && knows_hard_ && soft_db_ < hard_db_) level = T(0.5F) * (soft_db_ + hard_db_);
    start(level, kKnownGusts);
  }

  void end() {
    gust_.clear();
    rest_frames_ = 0;
  }

  GustLevel<T> gust_;
  T first_db_ = T(0.0F);
  T level_db_ = T(0.0F);
  T soft_db_ = T(0.0F);
  T hard_db_ = T(0.0F);
  bool knows_soft_ = false;
  bool knows_hard_ = false;
  float learned_ = 1;
  int rest_frames_ = 0;
};

}  // namespace wisp::wind
