#pragma once
// From what was observed and what is known of the background to the frame that is handed out.

#include <cmath>

#include "run/wind_kernel.hpp"
#include "run/wind_math.hpp"
#include "wisp/run/wind_level.hpp"

namespace wisp::wind {

/// What the frame is set against.
struct Background {
  float rms = 0;
  float band_power = 0;
  float gust_db = 0;  ///< band power of wind 1
};

inline float root_of(float x) { return std::sqrt(x); }

inline float from_decibels(float db) { return exp2_of(db * 0.3321928095F); }

/// 0 … 1: how sure it is that something is heard `above_floor_db` over the floor.
inline float audible(float above_floor_db) { return sigmoid((above_floor_db - 12.0F) * (1.0F / 1.5F)); }

inline WindFrame verdict(const Observation<float>& seen, float confidence, const Background& background,
                         float exponent) {
  WindFrame frame;
  frame.rms = seen.rms;
  frame.background = background.rms;
  frame.rms_clean = seen.rms > background.rms ? seen.rms - background.rms : 0.0F;
  const float power = seen.band_power > background.band_power ? seen.band_power - background.band_power : 0.0F;
  frame.level = root_of(power);
  // Decibels over the gust level; at −120 dB of power and below there is no wind.
  if (power > 1e-12F) frame.speed = from_decibels((decibels(power) - background.gust_db) * exponent);
  frame.confidence = confidence;
  float open = (confidence - 0.2F) * (1.0F / 0.6F);
  if (open < 0) open = 0;
  if (open > 1) open = 1;
  frame.wind = frame.speed * open;
  frame.clipped = seen.clipped;
  return frame;
}

}  // namespace wisp::wind
