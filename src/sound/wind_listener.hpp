#pragma once
// All of the live estimator but the clock: sound in, frames out when told, over any number type.

#include <cstdint>

#include "sound/wind_background.hpp"
#include "sound/wind_bridge.hpp"
#include "sound/wind_design.hpp"
#include "sound/wind_gusts.hpp"
#include "sound/wind_kernel.hpp"
#include "sound/wind_verdict.hpp"

namespace wisp::wind {

template <class T>
class Listener {
 public:
  explicit Listener(const Design& d) : d_(d), kernel_(d) { gusts_.start(T(d.first_gust_db), d.first_gust_frames); }

  /// Takes one sample of every channel.
  void push(const float* samples) {
    if (kernel_.push(samples)) background_.end_hop(kernel_.features().loudness_db, d_);
  }

  WindFrame end_frame() {
    const Observation<T> seen = kernel_.end_frame();
    background_.end_frame(seen, d_);
    const QuietMean<T>& quiet = background_.mean();
    const T floor = background_.floor_db();
    if (background_.frames_to_calibrate() == 0 && T(kGustConfidence) < confidence_of(seen, floor)) {
      const T power = power_over(seen, quiet.band_power());
      if (T(0.0F) < power) gusts_.add(decibels(power), T(d_.gust_keep));
    }
    WindFrame frame = verdict(seen, {quiet.rms(), quiet.band_power(), floor, gusts_.high_db()}, d_.power_exponent);
    frame.wind = plain(bridge_.end_frame(heard_speed(T(frame.speed), seen, floor), seen, floor, d_));
    return frame;
  }

  Background<T>& background() { return background_; }
  const Background<T>& background() const { return background_; }
  GustLevel<T>& gusts() { return gusts_; }
  const GustLevel<T>& gusts() const { return gusts_; }

 private:
  static constexpr float kGustConfidence = 0.8F;

  Design d_;
  Kernel<T> kernel_;
  Background<T> background_;
  GustLevel<T> gusts_;
  LiveBridge<T> bridge_;
};

}  // namespace wisp::wind
