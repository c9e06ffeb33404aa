#pragma once
// Requires strong wind to last and to sound like blowing throughout: a knock, a sneeze or a spark are as loud as hard
// blowing for a tenth of a second, and a drum or a plosive resembles it until the following note is recognised.

#include "sound/wind_design.hpp"

namespace wisp::wind {

/// Wind takes 0.08 s to rise to 1. The excess passes after sufficient evidence: 0.24 s of wind 1, or less time the
/// stronger it is (0.15 s of 1.6, 0.08 s of 3.2), until an equally long pause. Softer blowing counts neither as
/// evidence nor as pause. Wind inferred from earlier sound (a gust's tail, wind under another sound) is a pause.
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
  T evidence_ = T(0.0F);  ///< sum of strong wind, minus one per frame without blowing
  bool lasts_ = false;
  T before_ = T(0.0F);  ///< the wind that passed in the last frame
};

}  // namespace wisp::wind
