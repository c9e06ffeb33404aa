#pragma once
// Bands that distinguish blowing from speech, and their power per hop.

#include "sound/wind_design.hpp"
#include "sound/wind_math.hpp"

namespace wisp::wind {

/// Sums over one hop, without the filters' gains.
template <class T>
struct BandSums {
  T total = T(0.0F);
  T low = T(0.0F);
  T high = T(0.0F);
  T voice = T(0.0F);
  T voice_fourth = T(0.0F);

  void add(const BandSums& other) {
    total = total + other.total;
    low = low + other.low;
    high = high + other.high;
    voice = voice + other.voice;
    voice_fourth = voice_fourth + other.voice_fourth;
  }
};

/// Filters of one channel.
template <class T>
class Bands {
 public:
  explicit Bands(const Design& d) : high_pass_(d.high_pass), low_pass_(d.low_pass), low_(d.low), high_(d.high) {}

  /// Filters a sample at the analysis rate; returns the voice band's sample.
  T push(T x) {
    const T total = high_pass_.high(x);
    const T voice = low_pass_.low(total);
    const T low = low_.band(x);
    const T high = high_.band(x);
    sums_.total = sums_.total + total * total;
    sums_.low = sums_.low + low * low;
    sums_.high = sums_.high + high * high;
    const T square = voice * voice;
    sums_.voice = sums_.voice + square;
    sums_.voice_fourth = sums_.voice_fourth + square * square;
    return voice;
  }

  const BandSums<T>& sums() const { return sums_; }

  /// Ends the hop. Sets inaudible filter state to 0, as some machines flush denormal numbers and others do not.
  void end_hop() {
    sums_ = {};
    high_pass_.hush();
    low_pass_.hush();
    low_.hush();
    high_.hush();
  }

 private:
  Filter<T> high_pass_, low_pass_, low_, high_;
  BandSums<T> sums_;
};

}  // namespace wisp::wind
