#pragma once
// Converts an observation, given background and gust level, to a wind frame.

#include <cmath>

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

constexpr float kSureDb = 10;        ///< loudness over the floor from which blowing is distinguished from the room
constexpr float kMinPower = 1e-12F;  ///< band power below which there is no wind

/// Confidence, 0 to 1, that loudness exceeds the floor.
template <class T>
T audible(T over_floor_db, float sure_db, float width_db) {
  return sigmoid((over_floor_db - T(sure_db)) * T(1 / width_db));
}

template <class T>
T confidence_of(const Observation<T>& seen, T floor_db) {
  return seen.likeness * audible(seen.loudness_db - floor_db, kSureDb, 1.5F);
}

/// Band power in excess of the background's.
template <class T>
T power_over(const Observation<T>& seen, T background) {
  return background < seen.band_power ? seen.band_power - background : T(0.0F);
}

/// Fills all fields of a frame except its wind.
template <class T>
WindFrame verdict(const Observation<T>& seen, const Surroundings<T>& around, float power_exponent) {
  using std::sqrt;
  const T power = power_over(seen, around.band_power);
  const T db = decibels(power);
  T speed = T(0.0F);
  if (T(kMinPower) < power) speed = exp2_of((db - around.gust_db) * T(power_exponent * 0.3321928095F));
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

}  // namespace wisp::wind
