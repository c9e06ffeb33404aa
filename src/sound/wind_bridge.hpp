#pragma once
// What to take for the wind while something else is heard.
//
// Another sound can only add to the level: under a voice or a knock the wind is at most what is measured, and most
// likely what it was just before (and, where that is known, what it is just after).

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "sound/wind_design.hpp"
#include "sound/wind_kernel.hpp"
#include "sound/wind_math.hpp"
#include "sound/wind_verdict.hpp"

namespace wisp::wind {

constexpr float kHeardDb = 8;  ///< loudness over the floor from which a sound counts as one
constexpr float kBlowingLikeness = 0.5F;

template <class T>
bool is_heard(const Observation<T>& seen, T floor_db) {
  return floor_db + T(kHeardDb) < seen.loudness_db;
}

template <class T>
bool sounds_like_blowing(const Observation<T>& seen) {
  return T(kBlowingLikeness) < seen.likeness;
}

/// Speed as far as anything is heard at all: the background's own flicker is no wind.
template <class T>
T heard_speed(T speed, const Observation<T>& seen, T floor_db) {
  return speed * audible(seen.loudness_db - floor_db, kHeardDb, 1.0F);
}

/// Live: frames that sound like blowing pass, and those in which nothing is heard. In others the wind is at most what
/// it was before them, dying away in half a second.
///
/// "Before" is 50 ms before, since it takes some time until a voice is known for one. Wind that swings fast sounds like
/// something else for a few frames, too: for 80 ms after blowing it is still believed.
template <class T>
class LiveBridge {
 public:
  T end_frame(T speed, const Observation<T>& seen, T floor_db, const Design& d) {
    const bool heard = is_heard(seen, floor_db);
    if (!heard || sounds_like_blowing(seen)) {
      believed_frames_ = heard ? d.trust_frames : 0;
      foreign_frames_ = 0;
      before_[at_ % before_.size()] = speed;
      ++at_;
      return speed;
    }
    if (foreign_frames_ == 0) most_ = settled(d);
    if (++foreign_frames_ <= believed_frames_) return speed;
    most_ = most_ * T(d.bridge_keep);
    if (most_ < T(1e-6F)) most_ = T(0.0F);
    return speed < most_ ? speed : most_;
  }

 private:
  /// Mean of the frames 50 to 100 ms ago.
  T settled(const Design& d) const {
    T sum = T(0.0F);
    const std::size_t n = static_cast<std::size_t>(d.bridge_delay_frames);
    for (std::size_t i = 0; i < n; ++i) sum = sum + before_[(at_ + before_.size() - n - 1 - i) % before_.size()];
    return sum / T(static_cast<float>(n));
  }

  std::array<T, 128> before_{};  ///< frames that passed; at most 101 are looked at
  std::size_t at_ = 0;
  int believed_frames_ = 0;
  int foreign_frames_ = 0;
  T most_ = T(0.0F);
};

/// Frames [begin, end) in which something else than blowing is heard.
struct ForeignSound {
  std::size_t begin = 0;
  std::size_t end = 0;
};

/// Stretches of another sound that are longer than fast swings of the wind make them, with 50 ms before each, in which
/// it was not yet known for one.
inline std::vector<ForeignSound> foreign_sounds(const std::vector<Observation<float>>& seen, float floor_db,
                                                const Design& d) {
  std::vector<ForeignSound> found;
  const std::size_t early = static_cast<std::size_t>(d.bridge_delay_frames);
  for (std::size_t begin = 0; begin < seen.size();) {
    std::size_t end = begin;
    while (end < seen.size() && is_heard(seen[end], floor_db) && !sounds_like_blowing(seen[end])) ++end;
    if (end - begin > 2 * static_cast<std::size_t>(d.trust_frames))
      found.push_back({begin - std::min(begin, early), end});
    begin = end + 1;
  }
  return found;
}

/// The same for a recording, which knows what comes after: under another sound the wind is at most the straight line
/// from what it was before to what it is after. `speeds` are heard_speed()s, replaced by the wind.
inline void bridge_recording(const std::vector<Observation<float>>& seen, float floor_db, const Design& d,
                             std::vector<float>& speeds) {
  const auto mean = [&speeds](std::size_t from, std::size_t to) {
    float sum = 0;
    for (std::size_t k = from; k < to; ++k) sum += speeds[k];
    return from < to ? sum / static_cast<float>(to - from) : 0.0F;
  };
  const std::size_t around = static_cast<std::size_t>(d.bridge_delay_frames);
  const std::vector<ForeignSound> sounds = foreign_sounds(seen, floor_db, d);
  for (std::size_t i = 0; i < sounds.size(); ++i) {
    const std::size_t begin = sounds[i].begin;
    const std::size_t end = sounds[i].end;
    const std::size_t left = i == 0 ? 0 : sounds[i - 1].end;
    const std::size_t right = i + 1 == sounds.size() ? speeds.size() : std::max(sounds[i + 1].begin, end);
    float before = mean(std::max(left, begin - std::min(begin, around)), begin);
    float after = mean(end, std::min(right, end + around));
    if (begin == 0) before = after;
    if (end == speeds.size()) after = before;
    for (std::size_t k = begin; k < end; ++k) {
      const float share = (static_cast<float>(k - begin) + 0.5F) / static_cast<float>(end - begin);
      speeds[k] = std::min(speeds[k], before + share * (after - before));
    }
  }
}

}  // namespace wisp::wind
