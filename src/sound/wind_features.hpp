#pragma once
// Parts of the wind estimator, over any number type: decimation to the analysis rate; band powers that distinguish
// blowing from speech; detection of sudden onsets (gusts begin within a few tenths of a second, cars, the sea and
// trains swell over seconds); periodicity in the range of a voice's pitch.

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "sound/wind_design.hpp"
#include "sound/wind_math.hpp"

namespace wisp::wind {

/// Brings a channel to the analysis rate: mean of `box` samples, low-pass, decimation. A stream's channels run in step.
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
    // Each value is stored twice, at a distance of one window, so that every window is contiguous.
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

/// Sums over one hop of squared samples of each band (voice_fourth: of fourth powers), before the filters' gains.
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

  /// Clears the sums and calls hush() on every filter.
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

constexpr float kNothingDb = -110;  ///< loudness below which there is no sound at all (a muted or starting stream)
constexpr int kWarmHops = 15;       ///< hops until the 50 ms mean is settled

/// Detects sudden sound of any kind: from a rise of the loudness by kStartDb over its slow mean until it is less than
/// kEndDb over that mean's value before the rise. So sound that begins during a voice and outlasts it also counts.
template <class T>
class Sudden {
 public:
  /// For streams that may begin during any sound: the first sound heard is taken as the background, unless half a
  /// second of digital silence precedes it, as from a gated microphone.
  void begin_unknown() {
    heard_hops_ = 0;
    nothing_hops_ = 0;
  }

  /// Takes a hop's loudness. Returns whether the sound began suddenly and has not ended since.
  bool end_hop(T loudness_db, const Design& d) {
    if (heard_hops_ < kWarmHops) {
      begin(loudness_db);
      return false;
    }
    if (sounding_ && loudness_db < before_db_ + T(kEndDb)) sounding_ = false;
    if (!sounding_ && slow_db_ + T(kStartDb) < loudness_db) {
      sounding_ = true;
      before_db_ = slow_db_;
    }
    const float share = loudness_db < slow_db_ ? d.slow_fall : d.slow_rise;
    slow_db_ = slow_db_ + T(share) * (loudness_db - slow_db_);
    return sounding_;
  }

 private:
  void begin(T loudness_db) {
    sounding_ = false;
    slow_db_ = T(kRoomDb);
    if (loudness_db < T(kNothingDb)) {
      if (++nothing_hops_ == 50) heard_hops_ = kWarmHops;  // half a second
      return;
    }
    ++heard_hops_;
    slow_db_ = loudness_db;
  }

  // Background loudness assumed at a recording's beginning, so that a gust there counts as sudden.
  static constexpr float kRoomDb = -73;
  static constexpr float kStartDb = 6.5F;  ///< minimum rise over the slow mean (0.35 s) at a sudden beginning
  static constexpr float kEndDb = 3;       ///< sudden sound ends less than this over the slow mean before it

  T slow_db_ = T(kRoomDb);
  T before_db_ = T(kRoomDb);
  bool sounding_ = false;
  int heard_hops_ = kWarmHops;
  int nothing_hops_ = 0;
};

/// Buffer of one channel's voice band at a lower rate (near 4 kHz), differenced to equalise a voice's harmonics. Holds
/// the current hop and, before it, the samples of one longest period (last_lag).
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

  /// Returns the hop's first sample; last_lag samples before it are readable too.
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

/// Voicing and tone, from the normalised autocorrelation at lags of 1/400 to 1/70 s. Voicing is the autocorrelation's
/// maximum over lags in the last three hops (30 ms). Tone is the maximum over lags of its mean over 150 ms: noise
/// averages out, chords remain, whose common period is too long for voicing. Both rise at once and decay with a time
/// constant of 300 ms, to bridge the gaps between syllables and notes; in hops much softer than the 50 ms mean they
/// decay more slowly, as that mean still consists of the earlier sound. Three hops' sums are stored, so that each hop
/// computes only its own products.
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
      if (square < T(1e-24F) || product < T(0.0F)) continue;  // silence: each energy is below 1e-12
      const T share = product / sqrt(square);
      if (most < share) most = share;
    }
    return most < T(1.0F) ? most : T(1.0F);
  }

  /// Updates a held peak: rises immediately, decays with a time constant of 300 ms / fresh.
  void hold(T& held, T now, T fresh) const {
    held = held < now ? now : held + release_ * fresh * (now - held);
    if (held < T(1e-6F)) held = T(0.0F);
  }

  void average(const Hop& hop, T fresh) {
    T most = T(0.0F);
    const bool heard = T(1e-12F) < hop.energy;
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
