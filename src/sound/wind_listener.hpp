#pragma once
// The live estimator, over any number type: takes samples and ends a frame when its caller (WindLevel) says so.

#include "sound/wind_design.hpp"
#include "sound/wind_kernel.hpp"
#include "sound/wind_levels.hpp"
#include "sound/wind_verdict.hpp"

namespace wisp::wind {

template <class T>
class Listener {
 public:
  explicit Listener(const Design& d) : d_(d), kernel_(d) {
    reference_.start(T(d.first_gust_db), kFirstGusts);
    kernel_.begin_unknown();
  }

  void push(const float* samples) {
    if (!kernel_.push(samples)) return;
    background_.end_hop(kernel_.features().loudness_db, kernel_.began_suddenly(),
                        T(kBlowingLikeness) < kernel_.likeness(), d_);
  }

  WindFrame end_frame() {
    const Observation<T> seen = kernel_.end_frame();
    background_.end_frame(seen, d_);
    const QuietMean<T>& quiet = background_.mean();
    const T floor = background_.floor_db();
    const T power = power_over(seen, quiet.band_power());
    const bool blows = T(kGustConfidence) < confidence_of(seen, floor);
    hear_gust(blows && T(0.0F) < power, decibels(power));
    WindFrame frame = verdict(seen, {quiet.rms(), quiet.band_power(), floor, reference_.level_db()}, d_.power_exponent);
    const T believed = bridge_.believed(heard_speed(T(frame.speed), seen, floor), seen, floor, d_);
    const T wind = sustained_.end_frame(believed, T(kSureLikeness) < seen.likeness_now, d_);
    bridge_.end_frame(wind);
    frame.wind = plain(wind);
    return frame;
  }

  /// Uses the next `frames` frames for a guided calibration with the requested kind of wind.
  void calibrate(WindAsk ask, int frames) {
    ask_ = ask;
    asked_frames_ = frames;
    asked_.clear();
    heard_ask_ = false;
  }

  bool calibrating() const { return asked_frames_ > 0; }
  bool calibrated() const { return heard_ask_ && !calibrating(); }

  Background<T>& background() { return background_; }
  const Background<T>& background() const { return background_; }
  Reference<T>& reference() { return reference_; }
  const Reference<T>& reference() const { return reference_; }

 private:
  void hear_gust(bool blows, T power_db) {
    if (asked_frames_ == 0) return reference_.hear(blows, power_db, d_);
    if (blows) asked_.add(power_db);
    if (--asked_frames_ > 0 || asked_.frames() < d_.min_gust_frames) return;
    heard_ask_ = true;
    if (ask_ == WindAsk::kBreatheGently) reference_.set_soft(asked_.high_db());
    if (ask_ == WindAsk::kBlowHard) reference_.set_hard(asked_.high_db());
  }

  static constexpr float kGustConfidence = 0.8F;
  static constexpr float kSureLikeness = 0.65F;  ///< minimum likeness_now of a frame that proves strong wind
  static constexpr float kFirstGusts = 0.6F;     ///< weight of the option first_gust_rms against heard gusts, in gusts

  Design d_;
  Kernel<T> kernel_;
  Background<T> background_;
  Reference<T> reference_;
  LiveBridge<T> bridge_;
  Sustained<T> sustained_;
  GustLevel<T> asked_;  ///< level heard during a guided calibration
  WindAsk ask_ = WindAsk::kBreatheGently;
  int asked_frames_ = 0;
  bool heard_ask_ = false;
};

}  // namespace wisp::wind
