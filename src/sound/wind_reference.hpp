#pragma once
// Gust level of a microphone: the level that equals wind 1.
//
// A gust must not be its own reference: a person who blows hard from the start would calibrate the estimator to hard
// blowing. So the level starts at a typical value for microphones at arm's length, is constant during a gust, and moves
// after each gust to the level at which the gust was a soft breath or a hard blow, whichever is likelier.

#include <array>
#include <cstddef>

#include "sound/wind_design.hpp"
#include "sound/wind_math.hpp"

namespace wisp::wind {

/// Level of one gust, as a histogram over decibels.
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

  /// 80th percentile, dB, since a gust is soft at its ends.
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

  /// Takes a frame: whether it certainly blows, and its level in dB.
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

  /// A guided calibration heard certainly soft breath, or hard blowing. It sets the level: halfway where both are known
  /// and far enough apart, else by the breath, which must not extinguish a flame. Adaptation continues from there.
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

  static constexpr float kKnownGusts = 3;  ///< weight of a given or calibrated level, in gusts

 private:
  static constexpr float kHardDb = 17;     ///< level of a hard blow above wind 1,
  static constexpr float kSoftDb = 4;      ///< level of a soft breath below it,
  static constexpr float kSpreadDb = 6;    ///< and the standard deviation of either
  static constexpr float kNeither = 0.1F;  ///< likelihood of a gust of neither kind, which hardly moves the level
  static constexpr float kMaxGusts = 6;    ///< memory, in gusts
  static constexpr float kFallDb = 8;      ///< maximum fall below the initial level,
  static constexpr float kRiseDb = 12;     ///< and maximum rise above it, as microphones differ

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
