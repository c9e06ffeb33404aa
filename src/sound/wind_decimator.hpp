#pragma once
// Decimates sound to the analysis rate.

#include <cstddef>
#include <vector>

#include "sound/wind_design.hpp"

namespace wisp::wind {

/// One channel: the mean of `box` samples, a low-pass, decimation by `decimation`. All channels of a stream run in
/// step.
template <class T>
class Decimator {
 public:
  explicit Decimator(const Design& d)
      : box_(d.box),
        decimation_(d.decimation),
        taps_(d.taps.begin(), d.taps.end()),
        history_(2 * taps_.size(), T(0.0F)) {}

  /// Takes a sample; returns whether a value() is ready.
  bool push(T x) {
    sum_ = box_count_ == 0 ? x : sum_ + x;
    if (++box_count_ < box_) return false;
    box_count_ = 0;
    if (taps_.empty()) return true;
    // Stored twice, so that the window that starts after the newest value is contiguous.
    history_[at_] = sum_;
    history_[at_ + taps_.size()] = sum_;
    at_ = at_ + 1 == taps_.size() ? 0 : at_ + 1;
    if (++phase_ < decimation_) return false;
    phase_ = 0;
    return true;
  }

  T value() const {
    if (taps_.empty()) return sum_;
    const std::size_t n = taps_.size();
    const T* window = history_.data() + at_;
    T sum = n % 2 == 1 ? taps_[n / 2] * window[n / 2] : T(0.0F);
    for (std::size_t i = 0; i < n / 2; ++i) sum = sum + taps_[i] * (window[i] + window[n - 1 - i]);
    return sum;
  }

 private:
  int box_;
  int decimation_;
  std::vector<T> taps_;
  std::vector<T> history_;
  std::size_t at_ = 0;
  int box_count_ = 0;
  int phase_ = 0;
  T sum_ = T(0.0F);
};

}  // namespace wisp::wind
