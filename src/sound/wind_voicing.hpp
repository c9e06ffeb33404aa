#pragma once
// Periodicity of sound in the range of a voice's pitch.

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "sound/wind_design.hpp"
#include "sound/wind_math.hpp"

namespace wisp::wind {

/// Buffer of one channel's voice band at a lower rate (near 4 kHz), differenced to equalise a voice's harmonics: this
/// hop's samples, and before them as many as the longest period has.
template <class T>
class VoiceHistory {
 public:
  explicit VoiceHistory(const Design& d)
      : before_hop_(static_cast<std::size_t>(d.last_lag)),
        samples_(before_hop_ + static_cast<std::size_t>(d.hop / d.voice_step), T(0.0F)),
        at_(before_hop_),
        step_(d.voice_step) {}

  void push(T voice) {
    if (++phase_ < step_) return;
    phase_ = 0;
    samples_[at_++] = voice - before_;
    before_ = voice;
  }

  /// The hop's first sample; samples of one longest period are readable before it.
  const T* hop() const { return samples_.data() + before_hop_; }

  void end_hop() {
    std::copy(samples_.end() - static_cast<std::ptrdiff_t>(before_hop_), samples_.end(), samples_.begin());
    at_ = before_hop_;
  }

 private:
  std::size_t before_hop_;
  std::vector<T> samples_;
  std::size_t at_;
  int step_;
  int phase_ = 0;
  T before_ = T(0.0F);
};

/// Voicing and tone, from the normalised autocorrelation over periods of 70 to 400 Hz.
///
/// Voicing is its maximum in the last three hops (30 ms). Tone is the maximum of its mean over 150 ms: noise, however
/// low, averages out, while chords remain, whose common period is too long for voicing. Peaks of both are held and
/// decay in 300 ms, to bridge the gaps between syllables and notes. Both change only in proportion to new sound, so
/// sound that persists in the 50 ms mean powers keeps its voicing and tone. The three hops' sums are stored, so that
/// each hop computes only its own products.
template <class T>
class Voicing {
 public:
  explicit Voicing(const Design& d)
      : first_lag_(d.first_lag),
        length_(d.hop / d.voice_step),
        lags_(static_cast<std::size_t>(d.last_lag - d.first_lag + 1)),
        release_(d.voice_release),
        tone_approach_(d.tone_approach),
        means_(lags_, T(0.0F)) {
    for (auto& hop : window_) {
      hop.products.assign(lags_, T(0.0F));
      hop.delayed.assign(lags_, T(0.0F));
    }
  }

  /// Takes a hop of samples, preceded by one longest period; `fresh` is the hop's power over the 50 ms mean, 0 to 1.
  void end_hop(const T* now, T fresh) {
    slot_ = (slot_ + 1) % window_.size();
    sum(now, window_[slot_]);
    const T most = largest();
    hold(voicing_, most, fresh);
    average(window_[slot_], fresh);
  }

  T voicing() const { return voicing_; }  ///< 0 to 1
  T tone() const { return tone_; }        ///< 0 to 1

 private:
  struct Hop {
    T energy = T(0.0F);
    std::vector<T> products;  ///< products with the sound one lag earlier
    std::vector<T> delayed;   ///< energy of the sound one lag earlier
  };

  void sum(const T* now, Hop& hop) const {
    hop.energy = T(0.0F);
    for (int i = 0; i < length_; ++i) hop.energy = hop.energy + now[i] * now[i];
    T delayed = T(0.0F);
    for (int i = 0; i < length_; ++i) delayed = delayed + now[i - first_lag_] * now[i - first_lag_];
    for (std::size_t k = 0; k < lags_; ++k) {
      const T* then = now - first_lag_ - static_cast<int>(k);
      T product = T(0.0F);
      for (int i = 0; i < length_; ++i) product = product + now[i] * then[i];
      hop.products[k] = product;
      hop.delayed[k] = delayed;
      if (k + 1 < lags_) delayed = delayed + then[-1] * then[-1] - then[length_ - 1] * then[length_ - 1];
    }
  }

  T largest() const {
    using std::sqrt;
    const T energy = window_[0].energy + window_[1].energy + window_[2].energy;
    T most = T(0.0F);
    for (std::size_t k = 0; k < lags_; ++k) {
      const T product = window_[0].products[k] + window_[1].products[k] + window_[2].products[k];
      const T delayed = window_[0].delayed[k] + window_[1].delayed[k] + window_[2].delayed[k];
      const T square = energy * delayed;
      if (square < T(kMinSquare) || product < T(0.0F)) continue;
      const T share = product / sqrt(square);
      if (most < share) most = share;
    }
    return most < T(1.0F) ? most : T(1.0F);
  }

  /// Follows a rise immediately and decays in 300 ms.
  void hold(T& held, T now, T fresh) const {
    held = held < now ? now : held + release_ * fresh * (now - held);
    if (held < T(1e-6F)) held = T(0.0F);
  }

  void average(const Hop& hop, T fresh) {
    T most = T(0.0F);
    const bool heard = T(kMinEnergy) < hop.energy;
    const T scale = heard ? T(1.0F) / hop.energy : T(0.0F);
    const T share = tone_approach_ * fresh;
    for (std::size_t k = 0; k < lags_; ++k) {
      T& mean = means_[k];
      mean = mean + share * (hop.products[k] * scale - mean);
      if (mean < T(1e-6F) && T(-1e-6F) < mean) mean = T(0.0F);
      if (most < mean) most = mean;
    }
    if (T(1.0F) < most) most = T(1.0F);
    hold(tone_, most, fresh);
  }

  static constexpr float kMinEnergy = 1e-12F;
  static constexpr float kMinSquare = 1e-24F;  // energy below which sound counts as silent

  int first_lag_;
  int length_;
  std::size_t lags_;
  T release_;
  std::array<Hop, 3> window_;
  std::size_t slot_ = 0;
  T tone_approach_;
  std::vector<T> means_;  ///< mean normalised autocorrelation per lag
  T voicing_ = T(0.0F);
  T tone_ = T(0.0F);
};

}  // namespace wisp::wind
