#pragma once
// Computes the wind of a frame from its observation and the reference levels: measurement, wind during other sounds,
// and proof of strong wind.
//
// Other sounds only add to the level: during a voice or a knock the wind is at most the measured level, and most likely
// as strong as just before. Strong wind has to last and to sound like blowing throughout: a knock, a sneeze or a spark
// is as loud as hard blowing for a tenth of a second, and a drum or a plosive resembles blowing until the note or vowel
// after it is recognised.

#include <array>
#include <cmath>
#include <cstddef>

#include "sound/wind_design.hpp"
#include "sound/wind_kernel.hpp"
#include "sound/wind_math.hpp"
#include "wisp/sound/wind_level.hpp"

namespace wisp::wind {

/// Reference levels for observations.
template <class T>
struct Surroundings {
  T rms = T(0.0F);         ///< root mean square of the background
  T band_power = T(0.0F);  ///< band power of the background
  T floor_db = T(0.0F);    ///< loudness of the background
  T gust_db = T(0.0F);     ///< band power at wind 1
};

constexpr float kSureDb = 10;  ///< loudness over the floor at which audibility halves the confidence of blowing

/// Returns a weight of loudness over the floor: logistic from 0 to 1, 0.5 at `sure_db`, of scale `width_db`.
template <class T>
T audible(T over_floor_db, float sure_db, float width_db) {
  return sigmoid((over_floor_db - T(sure_db)) * T(1 / width_db));
}

template <class T>
T confidence_of(const Observation<T>& seen, T floor_db) {
  return seen.likeness * audible(seen.loudness_db - floor_db, kSureDb, 1.5F);
}

/// Returns the band power in excess of the background's, at least 0.
template <class T>
T power_over(const Observation<T>& seen, T background) {
  return background < seen.band_power ? seen.band_power - background : T(0.0F);
}

/// Fills all fields of a frame except its wind and index.
template <class T>
WindFrame verdict(const Observation<T>& seen, const Surroundings<T>& around, float power_exponent) {
  using std::sqrt;
  const T power = power_over(seen, around.band_power);
  const T db = decibels(power);
  T speed = T(0.0F);
  if (T(1e-12F) < power) speed = exp2_of((db - around.gust_db) * T(power_exponent * 0.3321928095F));
  WindFrame frame;
  frame.rms = plain(seen.rms);
  frame.rms_clean = around.rms < seen.rms ? plain(seen.rms - around.rms) : 0.0F;
  frame.level = plain(T(sqrt(power)));
  frame.speed = plain(speed);
  frame.confidence = plain(confidence_of(seen, around.floor_db));
  frame.background = plain(around.rms);
  frame.clipped = plain(seen.clipped);
  return frame;
}

constexpr float kHeardDb = 8;    ///< loudness over the floor at which heard_speed() halves the speed
constexpr float kForeignDb = 3;  ///< live: above this loudness over the floor, sound unlike blowing counts as foreign
constexpr float kBlowingLikeness = 0.5F;

template <class T>
bool sounds_like_blowing(const Observation<T>& seen) {
  return T(kBlowingLikeness) < seen.likeness;
}

/// Returns the speed, reduced towards 0 below kHeardDb over the floor: fluctuations of the background are no wind.
template <class T>
T heard_speed(T speed, const Observation<T>& seen, T floor_db) {
  return speed * audible(seen.loudness_db - floor_db, kHeardDb, 1.0F);
}

/// Bounds the live wind during foreign sound (heard, but unlike blowing). Other frames pass unchanged. In foreign ones
/// the wind is at most its mean before the sound, which decays with a time constant of half a second. The mean ends
/// about 50 ms earlier, as detecting a voice takes time. Rapidly varying wind also sounds foreign for a few frames, so
/// after blowing the speed still passes for as long as the blowing lasted, at most 80 ms.
template <class T>
class LiveBridge {
 public:
  T believed(T speed, const Observation<T>& seen, T floor_db, const Design& d) {
    const bool heard = floor_db + T(kForeignDb) < seen.loudness_db;
    if (!heard || sounds_like_blowing(seen)) {
      if (believed_frames_ < d.trust_frames) ++believed_frames_;
      if (!heard) believed_frames_ = 0;
      foreign_frames_ = 0;
      return speed;
    }
    if (foreign_frames_ == 0) most_ = settled(d);
    if (++foreign_frames_ <= believed_frames_) return speed;
    believed_frames_ = 0;
    most_ = most_ * T(d.bridge_keep);
    if (most_ < T(1e-6F)) most_ = T(0.0F);
    return speed < most_ ? speed : most_;
  }

  /// Stores the final wind of a frame.
  void end_frame(T wind) { before_[at_++ % before_.size()] = wind; }

 private:
  /// Returns the mean wind of n frames (n: bridge_delay_frames, about 50 ms), of which the last is n + 1 frames ago.
  T settled(const Design& d) const {
    T sum = T(0.0F);
    const std::size_t n = static_cast<std::size_t>(d.bridge_delay_frames);
    for (std::size_t i = 0; i < n; ++i) sum = sum + before_[(at_ + before_.size() - n - 1 - i) % before_.size()];
    return sum / T(static_cast<float>(n));
  }

  std::array<T, 128> before_{};  ///< winds of past frames; at most 102 are used
  std::size_t at_ = 0;
  int believed_frames_ = 0;
  int foreign_frames_ = 0;
  T most_ = T(0.0F);
};

/// Limits the live wind: it takes 0.08 s to rise to 1, and passes 1 only after evidence, which is the sum of wind above
/// 1 over time: 0.15 s of wind 1.6 or 0.08 s of 3.2 suffice. Evidence ends after 0.24 s without blowing; blowing below
/// 1 leaves it unchanged. Wind inferred from earlier sound (a gust's tail, under another sound) counts as no blowing.
template <class T>
class Sustained {
 public:
  /// `blows`: whether the frame by itself sounds like blowing.
  T end_frame(T wind, bool blows, const Design& d) {
    const bool strong = T(1.0F) < wind;
    if (!blows) evidence_ = evidence_ - T(1.0F);
    if (blows && strong) evidence_ = evidence_ + wind;
    if (T(d.sustain_frames) < evidence_) {
      evidence_ = T(d.sustain_frames);
      lasts_ = true;
    }
    if (evidence_ < T(0.0F)) {
      evidence_ = T(0.0F);
      lasts_ = false;
    }
    T most = before_ + T(d.wind_step);
    if (T(1.0F) < most) most = T(1.0F);
    before_ = !lasts_ && most < wind ? most : wind;
    return before_;
  }

 private:
  T evidence_ = T(0.0F);  ///< sum of wind above 1, minus one per frame without blowing
  bool lasts_ = false;
  T before_ = T(0.0F);  ///< the wind that passed in the last frame
};

}  // namespace wisp::wind
