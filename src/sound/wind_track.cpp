#include "wisp/sound/wind_track.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>
#include <utility>

#include "base/statistics.hpp"
#include "sound/wind_design.hpp"
#include "sound/wind_kernel.hpp"
#include "sound/wind_levels.hpp"
#include "sound/wind_verdict.hpp"

namespace wisp {
namespace {

// Wind of a recording during other sounds, from the bands between a voice's harmonics. A voice occupies few of the
// narrow bands between 60 and 1000 Hz; wind occupies all of them, with exponentially distributed power: a quarter of
// the bands are below ln 4/3 of their means. With S the spectrum of wind 1 and N that of the background, the wind's
// power is therefore the q at which a quarter of the bands are below ln 4/3 · (q S + N), however loud the others are.

/// Tables over the window's length: one period of cosine and of sine, and the Hann window.
struct Tables {
  explicit Tables(std::size_t length) : cosine(length), sine(length), window(length) {
    for (std::size_t i = 0; i < length; ++i) {
      const wind::Turn turn = wind::turn_of(static_cast<double>(i) / static_cast<double>(length));
      cosine[i] = static_cast<float>(turn.cos);
      sine[i] = static_cast<float>(turn.sin);
      window[i] = static_cast<float>(0.5 - 0.5 * turn.cos);
    }
  }

  std::vector<float> cosine, sine, window;
};

float power_at(std::size_t turns, const std::vector<float>& sound, const Tables& tables) {
  float re = 0;
  float im = 0;
  std::size_t at = 0;
  for (const float x : sound) {
    re += x * tables.cosine[at];
    im += x * tables.sine[at];
    at += turns;
    if (at >= sound.size()) at -= sound.size();
  }
  return re * re + im * im;
}

/// Powers of narrow bands, one row per frame.
class Spectra {
 public:
  /// Computes powers in 93 ms windows centred at `middles` (s). `channels`: differenced voice bands, at `rate_hz`.
  Spectra(const std::vector<std::vector<float>>& channels, double rate_hz, const std::vector<double>& middles) {
    const auto length = static_cast<std::size_t>(0.093 * rate_hz + 0.5);
    const double width_hz = rate_hz / static_cast<double>(length);
    const auto first = static_cast<std::size_t>(60 / width_hz + 1);
    bands_ = static_cast<std::size_t>(1000 / width_hz) + 1 - first;
    powers_.assign(middles.size() * bands_, 0.0F);
    const Tables tables(length);
    std::vector<float> piece(length);
    for (std::size_t k = 0; k < middles.size(); ++k) {
      const auto begin = static_cast<std::ptrdiff_t>(middles[k] * rate_hz) - static_cast<std::ptrdiff_t>(length / 2);
      for (const std::vector<float>& sound : channels) {
        for (std::size_t i = 0; i < length; ++i) {
          const std::ptrdiff_t at = begin + static_cast<std::ptrdiff_t>(i);
          const bool there = at >= 0 && at < static_cast<std::ptrdiff_t>(sound.size());
          piece[i] = there ? sound[static_cast<std::size_t>(at)] * tables.window[i] : 0.0F;
        }
        for (std::size_t b = 0; b < bands_; ++b) powers_[k * bands_ + b] += power_at(first + b, piece, tables);
      }
    }
  }

  const float* frame(std::size_t k) const { return powers_.data() + k * bands_; }

  /// Adds `weight` times the powers of frame `k` to `sum`.
  void add(std::size_t k, double weight, std::vector<double>& sum) const {
    sum.resize(bands_, 0.0);
    for (std::size_t b = 0; b < bands_; ++b) sum[b] += weight * static_cast<double>(frame(k)[b]);
  }

 private:
  std::size_t bands_ = 0;
  std::vector<float> powers_;
};

/// Mean powers in the bands of Spectra.
struct BandMeans {
  std::vector<double> wind;  ///< of wind 1, without the background
  std::vector<double> room;  ///< of the background
};

/// Returns the power of the wind in a frame relative to wind 1: the lower quartile over bands of each band's q.
float power_between(const float* powers, const BandMeans& means) {
  std::vector<double> needed;
  for (std::size_t b = 0; b < means.wind.size(); ++b) {
    if (means.wind[b] > 0)
      needed.push_back((static_cast<double>(powers[b]) / 0.2876820724517809 - means.room[b]) / means.wind[b]);
  }
  if (needed.empty()) return 0;
  const auto quarter = needed.begin() + static_cast<std::ptrdiff_t>(needed.size() / 4);
  std::nth_element(needed.begin(), quarter, needed.end());
  return static_cast<float>(std::max(*quarter, 0.0));
}

using Seen = std::vector<wind::Observation<float>>;

constexpr float kQuietSeconds = 0.25F;      // minimum duration of a stretch without wind
constexpr float kSilentDb = -80;            // a track is silent if the loudness of every frame is below
constexpr float kBlowingConfidence = 0.5F;  // frames of higher confidence count as blowing
constexpr double kShortestPuff = 0.1;  // seconds: a knock is above half of its peak for at most this, a puff longer

// Criteria of a knock: the wind exceeds `wind` for at most `seconds`, reaches `peak`, and does not exceed `wind` for
// `seconds` before and after (between the short peaks of a gust it does). The first entry is for knocks far stronger
// than wind, which last longer as the room reverberates.
struct Knock {
  float wind, peak;
  double seconds;
};
constexpr Knock kKnocks[] = {{1.5F, 6, 0.3}, {0.15F, 0, 0.1}};

/// Returns the 5 % quantile of loudness over frames that contain any sound; at least kMinFloorDb.
float find_floor(const Seen& seen) {
  std::vector<float> loudness;
  for (const auto& one : seen) {
    if (one.loudness_db >= wind::kNothingDb) loudness.push_back(one.loudness_db);
  }
  if (loudness.empty()) return wind::kMinFloorDb;
  return std::max(quantile(std::move(loudness), 0.05F), wind::kMinFloorDb);
}

bool is_quiet(const wind::Observation<float>& one, float floor_db) {
  return one.loudness_db >= wind::kNothingDb && one.loudness_db < floor_db + wind::kQuietDb;
}

/// Marks the frames of all quiet stretches that have at least `least` frames.
std::vector<bool> quiet_stretches(const Seen& seen, float floor_db, std::size_t least) {
  std::vector<bool> marks(seen.size(), false);
  for (std::size_t begin = 0; begin < seen.size();) {
    std::size_t end = begin;
    while (end < seen.size() && is_quiet(seen[end], floor_db)) ++end;
    if (end - begin >= least)
      std::fill(marks.begin() + static_cast<std::ptrdiff_t>(begin), marks.begin() + static_cast<std::ptrdiff_t>(end),
                true);
    begin = end + 1;
  }
  return marks;
}

struct Means {
  double rms = 0;
  double band_power = 0;
  std::size_t frames = 0;
};

template <class Choose>
Means means_of(const Seen& seen, Choose choose) {
  Means means;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    if (!choose(i)) continue;
    means.rms += static_cast<double>(seen[i].rms);
    means.band_power += static_cast<double>(seen[i].band_power);
    ++means.frames;
  }
  if (means.frames == 0) return means;
  means.rms /= static_cast<double>(means.frames);
  means.band_power /= static_cast<double>(means.frames);
  return means;
}

/// Finds the 95th percentile of the excess band power during blowing, dB. Returns false if there is no blowing.
bool find_gusts(const Seen& seen, const wind::Surroundings<float>& around, float& gust_db) {
  std::vector<float> gusts;
  for (const auto& one : seen) {
    const float power = wind::power_over(one, around.band_power);
    if (power > 0 && wind::confidence_of(one, around.floor_db) > kBlowingConfidence)
      gusts.push_back(wind::decibels(power));
  }
  if (gusts.empty()) return false;
  gust_db = quantile(std::move(gusts), 0.95F);
  return true;
}

/// Computes BandMeans: `room` from quiet frames, `wind` from those with confidence above kBlowingConfidence.
BandMeans band_means(const Spectra& spectra, const Seen& seen, const std::vector<bool>& quiet,
                     const wind::Surroundings<float>& around) {
  BandMeans means;
  double blowing_power = 0;
  double blowing_frames = 0;
  double quiet_frames = 0;
  const double one = static_cast<double>(wind::from_decibels(around.gust_db));
  for (std::size_t k = 0; k < seen.size(); ++k) {
    if (quiet[k]) {
      spectra.add(k, 1, means.room);
      quiet_frames += 1;
    } else if (wind::confidence_of(seen[k], around.floor_db) > kBlowingConfidence) {
      spectra.add(k, 1, means.wind);
      blowing_frames += 1;
      blowing_power += static_cast<double>(wind::power_over(seen[k], around.band_power)) / one;
    }
  }
  means.room.resize(means.wind.size(), 0.0);
  for (double& power : means.room) power /= std::max(quiet_frames, 1.0);
  for (std::size_t b = 0; b < means.wind.size(); ++b)
    means.wind[b] = (means.wind[b] - blowing_frames * means.room[b]) / std::max(blowing_power, 1e-9);
  return means;
}

/// Returns the wind of a frame: `measured` from the level, or, if smaller, `between` from the bands between a voice's
/// harmonics; the latter only for sound unlike blowing, or if `measured` is far above it (a voice over wind).
float wind_of(float measured, bool foreign, float between) {
  constexpr float kMuch = 1.35F, kAtLeast = 0.08F;
  return foreign || measured > kMuch * between + kAtLeast ? std::min(measured, between) : measured;
}

std::vector<WindFrame> frames_of(const Seen& seen, const wind::Surroundings<float>& around, const wind::Design& d,
                                 const Spectra& spectra, const BandMeans& means) {
  std::vector<WindFrame> frames;
  for (std::size_t k = 0; k < seen.size(); ++k) {
    WindFrame frame = wind::verdict(seen[k], around, d.power_exponent);
    frame.index = static_cast<std::int64_t>(k);
    const bool foreign = around.floor_db + wind::kHeardDb < seen[k].loudness_db && !wind::sounds_like_blowing(seen[k]);
    const float power = power_between(spectra.frame(k), means);
    const float between = power > 0 ? wind::exp2_of(wind::log2_of(std::max(power, 1e-12F)) * d.power_exponent) : 0.0F;
    frame.wind = wind_of(wind::heard_speed(frame.speed, seen[k], around.floor_db), foreign, between);
    frames.push_back(frame);
  }
  return frames;
}

/// Replaces the wind during knocks on the table by the larger wind of the frames before and after. Knocks are measured
/// as wind, in nearly calm recordings as many times the real maximum, but stay above half of their peak for at most
/// kShortestPuff, less than any blow. `seconds_at` returns the beginning of a frame.
template <class SecondsAt>
void pass_over_knocks(std::vector<WindFrame>& frames, const Knock& knock, const SecondsAt& seconds_at) {
  using Place = std::vector<WindFrame>::iterator;
  const auto above = [](float wind) { return [wind](const WindFrame& frame) { return frame.wind > wind; }; };
  const auto weaker = [](const WindFrame& a, const WindFrame& b) { return a.wind < b.wind; };
  const auto seconds = [&](Place from, Place to) {
    return seconds_at(to - frames.begin()) - seconds_at(from - frames.begin());
  };
  const auto rise = [&](Place from) { return std::find_if(from, frames.end(), above(knock.wind)); };
  Place last = frames.begin();  // end of the previous run above knock.wind
  for (Place begin = rise(last), next = begin; begin != frames.end(); begin = next) {
    const Place end = std::find_if_not(begin, frames.end(), above(knock.wind));
    next = rise(end);
    const bool alone = (last == frames.begin() || seconds(last, begin) >= knock.seconds) &&
                       (next == frames.end() || seconds(end, next) >= knock.seconds);
    last = end;
    if (!alone || seconds(begin, end) > knock.seconds) continue;
    const auto peak = std::max_element(begin, end, weaker);
    const auto risen = std::find_if(begin, end, above(peak->wind / 2));
    const auto faded = std::find_if_not(peak, end, above(peak->wind / 2));
    if (peak->wind < knock.peak || seconds(risen, faded) > kShortestPuff) continue;
    const float before = begin == frames.begin() ? 0 : std::prev(begin)->wind;
    const float around = std::max(before, end == frames.end() ? 0 : end->wind);
    std::for_each(begin, end, [around](WindFrame& frame) { frame.wind = around; });
  }
}

}  // namespace

struct WindTracker::State {
  State(const SoundFormat& sound, const WindOptions& given)
      : format(sound),
        options(given),
        design(wind::design(sound, given)),
        kernel(design),
        bands(static_cast<std::size_t>(sound.channels)) {
    next_frame_at = sample_at(end_seconds());
  }

  std::int64_t sample_at(double seconds) const { return static_cast<std::int64_t>(seconds * format.rate_hz + 0.5); }

  /// Returns the end of the current frame, seconds.
  double end_seconds() const { return seconds_at(seen.size() + 1); }

  void feed(std::span<const float> samples) {
    const std::size_t channels = bands.size();
    for (std::size_t i = 0; i + channels <= samples.size(); i += channels) hear(samples.data() + i);
  }

  void hear(const float* one) {
    if (kernel.push(one)) keep_hop();
    if (++position < next_frame_at) return;
    seen.push_back(kernel.end_frame());
    next_frame_at = sample_at(end_seconds());
  }

  void keep_hop() {
    for (std::size_t c = 0; c < bands.size(); ++c) {
      const auto hop = kernel.voice_hop(c);
      bands[c].insert(bands[c].end(), hop.begin(), hop.end());
    }
  }

  /// Returns the beginning of frame k, which is the end of frame k − 1, seconds.
  double seconds_at(std::size_t k) const { return static_cast<double>(k) / options.frame_rate_hz; }

  Spectra spectra() const {
    std::vector<double> middles;
    for (std::size_t k = 0; k < seen.size(); ++k)
      middles.push_back((static_cast<double>(k) + 0.5) / options.frame_rate_hz);
    return {bands, design.analysis_rate_hz / design.voice_step, middles};
  }

  SoundFormat format;
  WindOptions options;
  wind::Design design;
  wind::Kernel<float> kernel;
  std::vector<std::vector<float>> bands;  ///< differenced voice band of each channel at about 4 kHz, for Spectra
  Seen seen;
  std::int64_t position = 0;
  std::int64_t next_frame_at = 0;
};

WindTracker::WindTracker(std::unique_ptr<State> state) : state_(std::move(state)) {}
WindTracker::WindTracker(WindTracker&&) noexcept = default;
WindTracker& WindTracker::operator=(WindTracker&&) noexcept = default;
WindTracker::~WindTracker() = default;

Result<WindTracker> WindTracker::create(const SoundFormat& format, const WindOptions& options) {
  if (auto ok = wind::check(format, options); !ok) return ok.error();
  return WindTracker(std::make_unique<State>(format, options));
}

void WindTracker::feed(std::span<const float> samples) { state_->feed(samples); }

Result<WindTrack> WindTracker::finish() const {
  const Seen& seen = state_->seen;
  WindTrack track;
  track.seconds = static_cast<double>(state_->position) / state_->format.rate_hz;
  if (seen.empty()) {
    return Error{"wind track: the sound lasts " + wind::decimal(track.seconds) +
                 " s, expected at least one video frame (" + wind::decimal(state_->end_seconds()) + " s)"};
  }
  wind::Surroundings<float> around;
  around.floor_db = find_floor(seen);
  const std::size_t least = static_cast<std::size_t>(kQuietSeconds * state_->options.frame_rate_hz) + 1;
  const std::vector<bool> stretches = quiet_stretches(seen, around.floor_db, least);
  Means means = means_of(seen, [&](std::size_t i) { return stretches[i]; });
  track.background_found = means.frames > 0;
  if (!track.background_found)
    means = means_of(seen, [&](std::size_t i) { return is_quiet(seen[i], around.floor_db); });
  around.rms = static_cast<float>(means.rms);
  around.band_power = static_cast<float>(means.band_power);
  around.gust_db = state_->design.first_gust_db;
  const bool blows = find_gusts(seen, around, around.gust_db);

  track.one_rms = std::sqrt(wind::from_decibels(around.gust_db));
  const Spectra spectra = state_->spectra();
  track.frames = frames_of(seen, around, state_->design, spectra, band_means(spectra, seen, stretches, around));
  const auto seconds_at = [&](std::ptrdiff_t k) { return state_->seconds_at(static_cast<std::size_t>(k)); };
  for (const Knock& knock : kKnocks) pass_over_knocks(track.frames, knock, seconds_at);
  const float share = 1 / static_cast<float>(seen.size());
  track.silent = true;
  for (std::size_t k = 0; k < seen.size(); ++k) {
    track.blowing_share += track.frames[k].wind > 0.05F ? share : 0.0F;
    track.clipped_share += track.frames[k].clipped * share;
    track.silent = track.silent && seen[k].loudness_db < kSilentDb;
  }
  track.quiet_share = static_cast<float>(means.frames) * share;
  track.calibration = {around.rms, std::sqrt(around.band_power), around.floor_db,
                       blows ? std::sqrt(wind::from_decibels(around.gust_db)) : 0.0F};
  return track;
}

Result<WindTrack> wind_from_sound(std::span<const float> interleaved, const SoundFormat& format,
                                  const WindOptions& options) {
  auto tracker = WindTracker::create(format, options);
  if (!tracker) return tracker.error();
  tracker->feed(interleaved);
  return tracker->finish();
}

}  // namespace wisp
