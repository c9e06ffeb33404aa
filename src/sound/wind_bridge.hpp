#pragma once
// Estimates the wind during other sounds.
//
// Other sounds only add to the level: during a voice or a knock the wind is at most the measured level, and most likely
// what it was just before (and, where known, just after).

#include <array>
#include <cstddef>

#include "sound/wind_design.hpp"
#include "sound/wind_kernel.hpp"
#include "sound/wind_math.hpp"
#include "sound/wind_verdict.hpp"

namespace wisp::wind {

constexpr float kHeardDb = 8;    ///< loudness over the floor from which a sound counts
constexpr float kForeignDb = 3;  ///< live: loudness over the floor from which a sound may be foreign
constexpr float kBlowingLikeness = 0.5F;

template <class T>
bool sounds_like_blowing(const Observation<T>& seen) {
  return T(kBlowingLikeness) < seen.likeness;
}

/// Share of the wind that counts by loudness over the floor: fluctuation of the background is no wind.
template <class T>
T heard_speed(T speed, const Observation<T>& seen, T floor_db) {
  return speed * audible(seen.loudness_db - floor_db, kHeardDb, 1.0F);
}

/// Live estimate. Frames that sound like blowing, or in which nothing is heard, pass unchanged. In others the wind is
/// at most that before them, decaying within half a second.
///
/// "Before" is 50 ms earlier, as detecting a voice takes time. Rapidly varying wind also sounds foreign for a few
/// frames, so after blowing the measurement is still accepted for as long as that lasted, at most 80 ms.
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

  /// Takes the frame's wind as it was passed on.
  void end_frame(T wind) { before_[at_++ % before_.size()] = wind; }

 private:
  /// Mean of the frames 50 to 100 ms ago.
  T settled(const Design& d) const {
    T sum = T(0.0F);
    const std::size_t n = static_cast<std::size_t>(d.bridge_delay_frames);
    for (std::size_t i = 0; i < n; ++i) sum = sum + before_[(at_ + before_.size() - n - 1 - i) % before_.size()];
    return sum / T(static_cast<float>(n));
  }

  std::array<T, 128> before_{};  ///< past frames; at most 101 are used
  std::size_t at_ = 0;
  int believed_frames_ = 0;
  int foreign_frames_ = 0;
  T most_ = T(0.0F);
};

}  // namespace wisp::wind
