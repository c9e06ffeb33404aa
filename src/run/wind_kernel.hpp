#pragma once
// The estimator's arithmetic, over any number type: from samples to what was observed in a frame.

#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "run/wind_design.hpp"
#include "run/wind_math.hpp"

namespace wisp::wind {

/// What one frame's sound says by itself, before it is set against a background.
template <class T>
struct Observation {
  T rms = T(0.0F);          ///< of all samples
  T band_power = T(0.0F);   ///< mean square of the voice band
  T loudness_db = T(0.0F);  ///< of that band, 50 ms mean
  T likeness = T(0.0F);     ///< 0 to 1: sounds like blowing, not talking, whatever its strength
  T clipped = T(0.0F);      ///< share of samples at full scale
};

/// Sums of one hop.
template <class T>
struct BandSums {
  T total = T(0.0F);
  T low = T(0.0F);
  T high = T(0.0F);
  T voice = T(0.0F);
  T voice_fourth = T(0.0F);
};

/// One channel's way through the filters.
template <class T>
struct ChannelState {
  T box_sum = T(0.0F);
  std::vector<T> history;  ///< of the low-pass, written twice so that any window of it is one piece
  SectionState<T> total, low, high, voice_high, voice_low;
  BandSums<T> sums;
  std::vector<T> halved;  ///< the voice band at half rate, differenced: the last `last_lag` samples and this hop's
  T before = T(0.0F);     ///< the voice band two samples ago
};

template <class T>
class Kernel {
 public:
  explicit Kernel(const Design& design) : d_(design), channels_(static_cast<std::size_t>(design.channels)) {
    for (auto& channel : channels_) {
      channel.history.assign(2 * d_.taps.size(), T(0.0F));
      channel.halved.assign(static_cast<std::size_t>(d_.last_lag + d_.hop / 2), T(0.0F));
    }
    lags_ = static_cast<std::size_t>(d_.last_lag - d_.first_lag + 1);
    products_.assign(kWindowHops * lags_, T(0.0F));
    delayed_.assign(kWindowHops * lags_, T(0.0F));
    half_scale_ = T(static_cast<float>(d_.voice_high.gain * d_.voice_low.gain));
    per_channel_ = T(1.0F) / T(static_cast<float>(d_.channels));
  }

  /// Takes one sample of every channel.
  void push(const float* samples) {
    for (int c = 0; c < d_.channels; ++c) take(channels_[static_cast<std::size_t>(c)], T(held(samples[c])));
    ++samples_;
    if (++box_count_ < d_.box) return;
    box_count_ = 0;
    for (auto& channel : channels_) decimate(channel);
    if (++phase_ < d_.decimation) return;
    phase_ = 0;
    gather();
    for (auto& channel : channels_) analyse(channel);
    if (++in_hop_ == d_.hop) end_hop();
  }

  /// What the samples since the last frame say; starts the next frame.
  Observation<T> end_frame() {
    gather();
    Observation<T> seen;
    if (samples_ > 0) {
      const T share = per_channel_ / T(static_cast<float>(samples_));
      seen.rms = root(power_ * share);
      seen.clipped = T(static_cast<float>(clipped_)) * share;
    }
    if (analysed_ > 0) band_power_ = frame_band_ / T(static_cast<float>(analysed_)) * per_channel_;
    seen.band_power = band_power_;
    seen.loudness_db = loudness_db_;
    seen.likeness = likeness_;
    samples_ = clipped_ = analysed_ = 0;
    power_ = frame_band_ = T(0.0F);
    return seen;
  }

  T loudness_db() const { return loudness_db_; }
  bool ended_hop() { return std::exchange(ended_hop_, false); }

 private:
  static constexpr std::size_t kWindowHops = 3;  // 30 ms of sound for a voice's period

  static float held(float x) {
    if (!(x >= -8.0F)) return x < -8.0F ? -8.0F : 0.0F;  // NaN becomes 0
    return x > 8.0F ? 8.0F : x;
  }

  void take(ChannelState<T>& channel, T x) {
    group_power_ = group_power_ + x * x;
    if (plain(x) >= 0.999F || plain(x) <= -0.999F) ++clipped_;
    channel.box_sum = box_count_ == 0 ? x : channel.box_sum + x;
  }

  // Sums of a few samples first, then their sum: a second of 192 kHz keeps its digits in single precision.
  void gather() {
    power_ = power_ + group_power_;
    group_power_ = T(0.0F);
  }

  void decimate(ChannelState<T>& channel) {
    if (d_.taps.empty()) return;
    channel.history[static_cast<std::size_t>(at_)] = channel.box_sum;
    channel.history[static_cast<std::size_t>(at_) + d_.taps.size()] = channel.box_sum;
    if (&channel == &channels_.back() && ++at_ == static_cast<int>(d_.taps.size())) at_ = 0;
  }

  T filtered(const ChannelState<T>& channel) const {
    if (d_.taps.empty()) return channel.box_sum;
    const std::size_t n = d_.taps.size();
    const T* window = channel.history.data() + at_;
    T sum = T(0.0F);
    for (std::size_t i = 0; i < n / 2; ++i) sum = sum + T(d_.taps[i]) * (window[i] + window[n - 1 - i]);
    if (n % 2 == 1) sum = sum + T(d_.taps[n / 2]) * window[n / 2];
    return sum;
  }

  void analyse(ChannelState<T>& channel) {
    T x = filtered(channel);
    const T t = pass_high(d_.total, channel.total, x);
    const T lo = pass_band(d_.low, channel.low, x);
    const T hi = pass_band(d_.high, channel.high, x);
    const T y =
        half_scale_ * pass_low(d_.voice_low, channel.voice_low, pass_high(d_.voice_high, channel.voice_high, x));
    BandSums<T>& sums = channel.sums;
    sums.total = sums.total + t * t;
    sums.low = sums.low + lo * lo;
    sums.high = sums.high + hi * hi;
    const T y2 = y * y;
    sums.voice = sums.voice + y2;
    sums.voice_fourth = sums.voice_fourth + y2 * y2;
    frame_band_ = frame_band_ + y2;
    if (&channel == &channels_.front()) ++analysed_;
    if (in_hop_ % 2 == 1) {
      channel.halved[static_cast<std::size_t>(d_.last_lag + in_hop_ / 2)] = y - channel.before;
      channel.before = y;
    }
  }

  void end_hop() {
    in_hop_ = 0;
    BandSums<T> sums;
    std::size_t loudest = 0;
    for (std::size_t c = 0; c < channels_.size(); ++c) {
      const BandSums<T>& one = channels_[c].sums;
      if (plain(one.voice) > plain(channels_[loudest].sums.voice)) loudest = c;
      sums.total = sums.total + one.total;
      sums.low = sums.low + one.low;
      sums.high = sums.high + one.high;
      sums.voice = sums.voice + one.voice;
      sums.voice_fourth = sums.voice_fourth + one.voice_fourth;
    }
    correlate(channels_[loudest].halved);
    for (auto& channel : channels_) {
      channel.sums = {};
      auto& halved = channel.halved;
      for (int i = 0; i < d_.last_lag; ++i) {
        halved[static_cast<std::size_t>(i)] = halved[static_cast<std::size_t>(i + d_.hop / 2)];
      }
    }
    smooth(sums);
    judge();
    ended_hop_ = true;
  }

  void correlate(const std::vector<T>& halved) {
    slot_ = (slot_ + 1) % kWindowHops;
    const int n = d_.hop / 2;
    const T* now = halved.data() + d_.last_lag;
    T energy = T(0.0F);
    for (int i = 0; i < n; ++i) energy = energy + now[i] * now[i];
    energies_[slot_] = energy;
    T delayed = T(0.0F);
    for (int i = 0; i < n; ++i) delayed = delayed + now[i - d_.first_lag] * now[i - d_.first_lag];
    for (std::size_t k = 0; k < lags_; ++k) {
      const int lag = d_.first_lag + static_cast<int>(k);
      T product = T(0.0F);
      for (int i = 0; i < n; ++i) product = product + now[i] * now[i - lag];
      products_[slot_ * lags_ + k] = product;
      delayed_[slot_ * lags_ + k] = delayed;
      if (k + 1 < lags_) delayed = delayed + now[-lag - 1] * now[-lag - 1] - now[n - 1 - lag] * now[n - 1 - lag];
    }
    T most = T(0.0F);
    for (std::size_t k = 0; k < lags_; ++k) {
      const T product = products_[k] + products_[lags_ + k] + products_[2 * lags_ + k];
      if (!(plain(product) > 0.0F)) continue;
      const T a = energies_[0] + energies_[1] + energies_[2];
      const T b = delayed_[k] + delayed_[lags_ + k] + delayed_[2 * lags_ + k];
      const T energy_product = a * b;
      if (!(plain(energy_product) > 1e-30F)) continue;
      const T r = product / root(energy_product);
      if (plain(r) > plain(most)) most = r;
    }
    voicing_ = plain(most) > plain(voicing_) ? most : voicing_ + T(d_.voice_release) * (most - voicing_);
  }

  void smooth(const BandSums<T>& sums) {
    const T scale = per_channel_ / T(static_cast<float>(d_.hop));
    const auto follow = [this](T& mean, T now) { mean = mean + T(d_.power_approach) * (now - mean); };
    follow(mean_.total, sums.total * scale);
    follow(mean_.low, sums.low * scale);
    follow(mean_.high, sums.high * scale);
    follow(mean_.voice, sums.voice * scale);
    follow(mean_.voice_fourth, sums.voice_fourth * scale);
  }

  void judge() {
    const auto db = [](T power, double gain) { return decibels(power * T(static_cast<float>(gain * gain))); };
    const T total = db(mean_.total, d_.total.gain);
    const T low = db(mean_.low, d_.low.gain) - total;
    const T high = db(mean_.high, d_.high.gain) - total;
    loudness_db_ = decibels(mean_.voice);
    const T square = T(3.0F) * mean_.voice * mean_.voice;
    T peaked = T(-1.0F);
    if (plain(square) > 1e-30F) peaked = T(0.6931471806F) * log2_of(T(1e-6F) + mean_.voice_fourth / square);
    if (plain(peaked) < -1.0F) peaked = T(-1.0F);
    if (plain(peaked) > 3.0F) peaked = T(3.0F);
    const T z = T(4.327F) + T(0.317F) * low - T(17.0F) * voicing_ - T(0.357F) * high - T(0.869F) * peaked;
    likeness_ = sigmoid(z) * sigmoid((T(0.70F) - voicing_) * T(25.0F));
  }

  static T root(T x) {
    using std::sqrt;
    return sqrt(x);
  }

  Design d_;
  std::vector<ChannelState<T>> channels_;
  std::size_t lags_ = 0;
  std::vector<T> products_, delayed_;  ///< per hop of the window and lag
  T energies_[kWindowHops] = {T(0.0F), T(0.0F), T(0.0F)};
  std::size_t slot_ = 0;
  T half_scale_ = T(1.0F);
  T per_channel_ = T(1.0F);
  int box_count_ = 0, phase_ = 0, at_ = 0, in_hop_ = 0;
  long long samples_ = 0, clipped_ = 0, analysed_ = 0;
  T group_power_ = T(0.0F), power_ = T(0.0F), frame_band_ = T(0.0F), band_power_ = T(0.0F);
  BandSums<T> mean_;
  T voicing_ = T(0.0F), loudness_db_ = T(-120.0F), likeness_ = T(0.0F);
  bool ended_hop_ = false;
};

}  // namespace wisp::wind
