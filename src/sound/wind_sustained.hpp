#pragma once
// What is strong must last: a knock, a sneeze, a spark are as loud as hard blowing for a tenth of a second, and the
// lips that blow a candle out take longer.

#include <algorithm>
#include <array>
#include <cstddef>

#include "sound/wind_design.hpp"
#include "sound/wind_math.hpp"

namespace wisp::wind {

/// Wind up to 1 passes as it comes; what exceeds it, up to the median of the last frames (120 ms).
template <class T>
class Sustained {
 public:
  T end_frame(T wind, const Design& d) {
    const auto n = static_cast<std::size_t>(d.sustain_frames);
    last_[at_] = wind;
    at_ = (at_ + 1) % n;
    if (!(T(1.0F) < wind)) return wind;
    std::array<T, kMostFrames> sorted = last_;
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(n / 2);
    std::nth_element(sorted.begin(), middle, sorted.begin() + static_cast<std::ptrdiff_t>(n));
    const T lasted = *middle < T(1.0F) ? T(1.0F) : *middle;
    return wind < lasted ? wind : lasted;
  }

 private:
  static constexpr std::size_t kMostFrames = 128;  ///< 120 ms at 1000 frames a second

  std::array<T, kMostFrames> last_{};
  std::size_t at_ = 0;
};

}  // namespace wisp::wind
