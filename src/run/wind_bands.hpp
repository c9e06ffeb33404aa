#pragma once
// The bands that tell blowing from talking, and their powers over a hop.

#include "run/wind_design.hpp"
#include "run/wind_math.hpp"

namespace wisp::wind {

/// Sums over one hop. Gains of the filters are left out of all but the voice band's.
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

/// One channel's filters.
template <class T>
class Bands {
 public:
  explicit Bands(const Design& d)
      : total_(d.total),
        low_(d.low),
        high_(d.high),
        voice_high_(d.voice_high),
        voice_low_(d.voice_low),
        voice_scale_(static_cast<float>(d.voice_high.gain * d.voice_low.gain)) {}

  /// Takes a sample at the analysis rate; returns the voice band's.
  T push(T x) {
    const T total = total_.high(x);
    const T low = low_.band(x);
    const T high = high_.band(x);
    const T voice = voice_scale_ * voice_low_.low(voice_high_.high(x));
    sums_.total = sums_.total + total * total;
    sums_.low = sums_.low + low * low;
    sums_.high = sums_.high + high * high;
    const T square = voice * voice;
    sums_.voice = sums_.voice + square;
    sums_.voice_fourth = sums_.voice_fourth + square * square;
    return voice;
  }

  const BandSums<T>& sums() const { return sums_; }

  /// Ends the hop. What is too small to hear leaves the filters, before it becomes a number that some machines flush.
  void end_hop() {
    sums_ = {};
    total_.hush();
    low_.hush();
    high_.hush();
    voice_high_.hush();
    voice_low_.hush();
  }

 private:
  Filter<T> total_, low_, high_, voice_high_, voice_low_;
  T voice_scale_;
  BandSums<T> sums_;
};

}  // namespace wisp::wind
