#pragma once
// How strong a gust is at this microphone: the 95th percentile of the level while it blows.

#include <array>
#include <cstddef>

#include "sound/wind_math.hpp"

namespace wisp::wind {

/// A histogram over decibels that forgets slowly.
template <class T>
class GustLevel {
 public:
  /// Begins with a level that weighs as much as `frames` of blowing.
  void start(T db, float frames) {
    counts_.fill(T(0.0F));
    count(db, T(frames));
  }

  /// Counts one frame of blowing; earlier ones weigh `keep` of what they did.
  void add(T db, T keep) {
    for (T& held : counts_) {
      held = held * keep;
      if (held < T(1e-6F)) held = T(0.0F);
    }
    count(db, T(1.0F));
  }

  /// The 95th percentile, dB.
  T high_db() const { return high_; }

 private:
  static constexpr int kBins = 81;
  static constexpr float kStepDb = 1.5F;
  static constexpr float kLeastDb = -100;

  void count(T db, T weight) {
    T place = (db - T(kLeastDb)) * T(1 / kStepDb);
    if (place < T(0.0F)) place = T(0.0F);
    if (T(kBins - 1.001F) < place) place = T(kBins - 1.001F);
    const std::size_t bin = static_cast<std::size_t>(plain(place));
    const T above = place - T(static_cast<float>(bin));
    counts_[bin] = counts_[bin] + weight * (T(1.0F) - above);
    counts_[bin + 1] = counts_[bin + 1] + weight * above;
    find_high();
  }

  // Each bin's count is spread evenly over its width.
  void find_high() {
    T all = T(0.0F);
    for (const T& held : counts_) all = all + held;
    T left = T(0.05F) * all;
    for (std::size_t bin = counts_.size(); bin-- > 0;) {
      const T held = counts_[bin];
      if (T(0.0F) < held && !(held < left)) {
        high_ = T(kLeastDb) + T(kStepDb) * (T(static_cast<float>(bin) + 0.5F) - left / held);
        return;
      }
      left = left - held;
    }
  }

  std::array<T, kBins> counts_{};
  T high_ = T(0.0F);
};

}  // namespace wisp::wind
