#pragma once
// What is strong must last: a knock, a sneeze, a spark are as loud as hard blowing for a tenth of a second, and the
// lips that blow a candle out take longer.

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
    const T median = middle_of(n);
    const T lasted = median < T(1.0F) ? T(1.0F) : median;
    return wind < lasted ? wind : lasted;
  }

 private:
  /// The median by counting: a selection from the library takes a page more to fetch.
  T middle_of(std::size_t n) const {
    for (std::size_t i = 0; i < n; ++i) {
      std::size_t below = 0;
      std::size_t equal = 0;
      for (std::size_t j = 0; j < n; ++j) {
        if (last_[j] < last_[i]) ++below;
        if (!(last_[j] < last_[i]) && !(last_[i] < last_[j])) ++equal;
      }
      if (below <= n / 2 && n / 2 < below + equal) return last_[i];
    }
    return last_[0];
  }

  static constexpr std::size_t kMostFrames = 128;  ///< 120 ms at 1000 frames a second

  std::array<T, kMostFrames> last_{};
  std::size_t at_ = 0;
};

}  // namespace wisp::wind
