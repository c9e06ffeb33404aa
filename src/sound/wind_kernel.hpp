#pragma once
// Arithmetic of the wind estimator, over any number type: from samples to the observation of a frame.
//
// The features follow C. M. Nelke et al., who distinguish wind noise from speech by its low band and by the lack of
// harmonics. tools/fit_blowing.py fits the classifier; docs/explanation/wind.md has figures.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "sound/wind_design.hpp"
#include "sound/wind_features.hpp"
#include "sound/wind_likeness_weights.hpp"
#include "sound/wind_math.hpp"

namespace wisp::wind {

/// Features of the last 50 ms of sound.
template <class T>
struct Features {
  T low_db = T(0.0F);          ///< power near 126 Hz relative to the total above 100 Hz
  T high_db = T(0.0F);         ///< power near 2.6 kHz relative to the total above 100 Hz
  T voicing = T(0.0F);         ///< periodicity with peak hold, 0 to 1
  T tone = T(0.0F);            ///< steadiness of periodicity, 0 to 1
  T peaked = T(0.0F);          ///< log of the voice band's kurtosis relative to a Gaussian's, −1 to 3
  T voice_db = T(0.0F);        ///< power of the voice band relative to the total above 100 Hz
  T newest_db = T(0.0F);       ///< power of the voice band in the newest 10 ms relative to the 50 ms
  T flutter_db = T(0.0F);      ///< mean absolute change of the newest power from hop to hop, over 150 ms
  T clipped = T(0.0F);         ///< share of samples at full scale: a blow overloads the capsule
  T loudness_db = T(-120.0F);  ///< power of the voice band (100–900 Hz)
};

/// Observation of one frame, before it is compared with a background.
template <class T>
struct Observation {
  T rms = T(0.0F);             ///< root mean square of all samples
  T band_power = T(0.0F);      ///< mean square of the whitened voice band (100–900 Hz), smoothed as in WindOptions
  T clipped = T(0.0F);         ///< share of samples at full scale
  T loudness_db = T(-120.0F);  ///< as in Features, at the frame's end
  T likeness = T(0.0F);        ///< probability, 0 to 1, that the sound is blowing, independent of its strength
  T likeness_now = T(0.0F);    ///< likeness of the newest hop alone, without a gust's tail
};

/// Returns the classifier's probability of blowing, 0 to 1: a layer of rectified sums, then a logistic unit.
template <class T>
T likeness_of(const Features<T>& f) {
  const T features[] = {f.low_db,   f.high_db,   f.voicing,    f.tone,   f.peaked,
                        f.voice_db, f.newest_db, f.flutter_db, f.clipped};
  T z = T(kLikenessOffset);
  for (int unit = 0; unit < kLikenessUnits; ++unit) {
    T sum = T(kLikenessBias[unit]);
    for (int i = 0; i < kLikenessFeatures; ++i) sum = sum + T(kLikenessFirst[unit][i]) * features[i];
    if (T(0.0F) < sum) z = z + T(kLikenessSecond[unit]) * sum;
  }
  return sigmoid(z);
}

/// Extends the likeness over the soft end of a gust, which the classifier alone cannot distinguish from other sounds.
/// After 50 ms of likeness above 0.8, the last such likeness is a minimum for half a second, or until the sound is 3 dB
/// louder than its softest since, as a beginning voice is.
template <class T>
class Tail {
 public:
  T end_hop(T likeness, T loudness_db) {
    if (T(0.8F) < likeness) {
      sure_hops_ = sure_hops_ < kSureHops ? sure_hops_ + 1 : kSureHops;
      softest_db_ = loudness_db;
      kept_ = likeness;
      left_hops_ = sure_hops_ == kSureHops ? 50 : left_hops_;
      return likeness;
    }
    sure_hops_ = 0;
    if (left_hops_ == 0) return likeness;
    if (softest_db_ + T(3.0F) < loudness_db) {
      left_hops_ = 0;
      return likeness;
    }
    if (loudness_db < softest_db_) softest_db_ = loudness_db;
    --left_hops_;
    return likeness < kept_ ? kept_ : likeness;
  }

 private:
  static constexpr int kSureHops = 5;

  int sure_hops_ = 0;
  int left_hops_ = 0;
  T softest_db_ = T(0.0F);
  T kept_ = T(0.0F);
};

template <class T>
class Kernel {
 public:
  explicit Kernel(const Design& design) : d_(design), voicing_(design) {
    for (int c = 0; c < d_.channels; ++c) channels_.emplace_back(d_);
    per_channel_ = T(1.0F / static_cast<float>(d_.channels));
    per_hop_ = T(1.0F / static_cast<float>(d_.channels * d_.hop));
    per_sample_ = T(1.0F / static_cast<float>(d_.channels * d_.hop * d_.box * d_.decimation));
  }

  /// Takes one sample of every channel. Returns whether a hop has ended, so that features() is new.
  bool push(const float* samples) {
    bool due = false;
    // NOLINTNEXTLINE(clang-analyzer-core.CallAndMessage): there are as many channels as its caller filled
    for (std::size_t c = 0; c < channels_.size(); ++c) due = take(channels_[c], T(held(samples[c])));
    ++samples_;
    return due && analyse();
  }

  /// Returns the observation of the samples since the last frame, and starts the next frame.
  Observation<T> end_frame() {
    gather();
    Observation<T> seen;
    if (samples_ > 0) {
      const T share = per_channel_ / T(static_cast<float>(samples_));
      using std::sqrt;
      seen.rms = sqrt(audible_power(power_ * share));
      seen.clipped = T(static_cast<float>(clipped_)) * share;
    }
    if (analysed_ > 0) {
      const T power = frame_band_ * (T(d_.level_gain) * per_channel_ / T(static_cast<float>(analysed_)));
      band_power_ = audible_power(band_power_ + T(d_.smoothing) * (power - band_power_));
    }
    seen.band_power = band_power_;
    seen.loudness_db = features_.loudness_db;
    seen.likeness = likeness_;
    seen.likeness_now = likeness_now_;
    samples_ = clipped_ = analysed_ = 0;
    power_ = frame_band_ = T(0.0F);
    return seen;
  }

  const Features<T>& features() const { return features_; }
  T likeness() const { return likeness_; }
  bool began_suddenly() const { return began_suddenly_; }

  /// Declares that the stream begins during an unknown sound.
  void begin_unknown() { sudden_.begin_unknown(); }

  /// Returns one channel's differenced voice band over the last hop, at the rate of the voicing analysis.
  std::span<const T> voice_hop(std::size_t channel) const {
    return {channels_[channel].history.hop(), static_cast<std::size_t>(d_.hop / d_.voice_step)};
  }

 private:
  struct Channel {
    explicit Channel(const Design& d) : decimator(d), bands(d), history(d) {}
    Decimator<T> decimator;
    Bands<T> bands;
    VoiceHistory<T> history;
    T before = T(0.0F);  ///< the voice band's last sample
  };

  static float held(float x) {
    if (!(x >= -8.0F)) return x < -8.0F ? -8.0F : 0.0F;  // NaN becomes 0
    return x > 8.0F ? 8.0F : x;
  }

  // Flushes powers below −240 dB to 0, as some machines flush denormal numbers and some do not.
  static T audible_power(T power) { return power < T(1e-24F) ? T(0.0F) : power; }

  bool take(Channel& channel, T x) {
    group_power_ = group_power_ + x * x;
    const float at = plain(x);
    const bool full = at >= 0.999F || at <= -0.999F;  // 16-bit clipping gives 32767 or, encoded, slightly less
    clipped_ += full;
    hop_clipped_ += full;
    return channel.decimator.push(x);
  }

  // Adds the sum of squares since the last call to the frame's: one float sum of 192000 squares would lose digits.
  void gather() {
    power_ = power_ + group_power_;
    group_power_ = T(0.0F);
  }

  bool analyse() {
    gather();
    for (auto& channel : channels_) {
      const T voice = channel.bands.push(channel.decimator.value());
      channel.history.push(voice);
      // A level is the power of the voice band after a filter that rises above 300 Hz, to flatten wind's falling
      // spectrum, so that it varies less. Below it is flat, for microphones that pass few high frequencies.
      const T levelled = voice - T(d_.level_zero) * channel.before;
      channel.before = voice;
      frame_band_ = frame_band_ + levelled * levelled;
    }
    ++analysed_;
    if (++in_hop_ < d_.hop) return false;
    in_hop_ = 0;
    end_hop();
    return true;
  }

  void end_hop() {
    BandSums<T> sums;
    std::size_t loudest = 0;
    for (std::size_t c = 0; c < channels_.size(); ++c) {
      if (channels_[loudest].bands.sums().voice < channels_[c].bands.sums().voice) loudest = c;
      sums.add(channels_[c].bands.sums());
    }
    smooth(sums);
    voicing_.end_hop(channels_[loudest].history.hop(), fresh(sums.voice));
    features_.voicing = voicing_.voicing();
    features_.tone = voicing_.tone();
    for (auto& channel : channels_) {
      channel.bands.end_hop();
      channel.history.end_hop();
    }
    describe(sums.voice * per_hop_);
    began_suddenly_ = sudden_.end_hop(features_.loudness_db, d_);
    likeness_now_ = began_suddenly_ && judged(sums.voice) ? likeness_of(features_) : T(0.0F);
    likeness_ = tail_.end_hop(likeness_now_, features_.loudness_db);
  }

  /// Returns whether the sound exceeds −110 dB and began more than two hops ago: before, a voice shows no period yet.
  bool judged(T voice_sum) const {
    const T newest = T(d_.power_approach) * voice_sum * per_hop_;
    return T(1e-11F) < mean_.voice * T(d_.voice_gain) && newest < T(0.5F) * mean_.voice;
  }

  /// Returns the ratio of a hop's power to the 50 ms mean, at most 1.
  T fresh(T voice_sum) const {
    const T power = voice_sum * per_hop_;
    return power < mean_.voice ? power / mean_.voice : T(1.0F);
  }

  void smooth(const BandSums<T>& sums) {
    const auto follow = [this](T& mean, T sum) {
      mean = audible_power(mean + T(d_.power_approach) * (sum * per_hop_ - mean));
    };
    follow(mean_.total, sums.total);
    follow(mean_.low, sums.low);
    follow(mean_.high, sums.high);
    follow(mean_.voice, sums.voice);
    follow(mean_.voice_fourth, sums.voice_fourth);
    const T full = T(static_cast<float>(hop_clipped_)) * per_sample_;
    features_.clipped = audible_power(features_.clipped + T(d_.power_approach) * (full - features_.clipped));
    hop_clipped_ = 0;
  }

  void describe(T newest_voice) {
    const auto db = [](T power, float gain) { return decibels(power * T(gain)); };
    const T total = db(mean_.total, d_.total_gain);
    features_.low_db = db(mean_.low, d_.low_gain) - total;
    features_.high_db = db(mean_.high, d_.high_gain) - total;
    features_.loudness_db = db(mean_.voice, d_.voice_gain);
    features_.voice_db = features_.loudness_db - total;
    const T newest = db(newest_voice, d_.voice_gain), change = newest - newest_db_;
    newest_db_ = newest;
    features_.newest_db = newest - features_.loudness_db;
    features_.flutter_db =
        features_.flutter_db +
        T(d_.tone_approach) * ((change < T(0.0F) ? T(0.0F) - change : change) - features_.flutter_db);
    const T gaussian = T(3.0F) * mean_.voice * mean_.voice;
    T peaked = T(-1.0F);
    if (T(1e-24F) < gaussian) peaked = T(0.6931471806F) * log2_of(T(1e-6F) + mean_.voice_fourth / gaussian);
    if (peaked < T(-1.0F)) peaked = T(-1.0F);
    if (T(3.0F) < peaked) peaked = T(3.0F);
    features_.peaked = peaked;
  }

  Design d_;
  std::vector<Channel> channels_;
  Voicing<T> voicing_;
  T per_channel_ = T(1.0F);
  T per_hop_ = T(1.0F);
  T per_sample_ = T(1.0F);
  int in_hop_ = 0;
  std::int64_t samples_ = 0, clipped_ = 0, analysed_ = 0, hop_clipped_ = 0;
  T group_power_ = T(0.0F), power_ = T(0.0F), frame_band_ = T(0.0F), band_power_ = T(0.0F);
  BandSums<T> mean_;
  T newest_db_ = T(-120.0F);
  Features<T> features_;
  Sudden<T> sudden_;
  bool began_suddenly_ = false;
  Tail<T> tail_;
  T likeness_ = T(0.0F);
  T likeness_now_ = T(0.0F);
};

}  // namespace wisp::wind
