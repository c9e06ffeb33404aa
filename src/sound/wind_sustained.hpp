#pragma once
// What is strong must last: a knock, a sneeze, a spark are as loud as hard blowing for a tenth of a second, and the
// lips that blow a candle out take longer.

#include <algorithm>

#include "sound/wind_design.hpp"

namespace wisp::wind {

/// Wind up to 1 passes as it comes; what exceeds it, once that has gone on for 120 ms, and until it has paused for
/// twice as long. Swings within a gust are no pauses.
template <class T>
class Sustained {
 public:
  T end_frame(T wind, const Design& d) {
    const bool strong = T(1.0F) < wind;
    evidence_ = std::clamp(evidence_ + (strong ? 2 : -1), 0, 2 * d.sustain_frames);
    if (evidence_ == 2 * d.sustain_frames) lasts_ = true;
    if (evidence_ == 0) lasts_ = false;
    return strong && !lasts_ ? T(1.0F) : wind;
  }

 private:
  int evidence_ = 0;  ///< two a strong frame, less one a frame that is not
  bool lasts_ = false;
};

}  // namespace wisp::wind
