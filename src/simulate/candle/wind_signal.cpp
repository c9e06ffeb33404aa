#include "simulate/candle/wind_signal.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "record/number_text.hpp"
#include "simulate/option_range.hpp"
#include "simulate/random_numbers.hpp"

namespace wisp {
namespace {

constexpr double kRate = 240;          // samples per second: 40 times the default bandwidth of the noise
constexpr double kLongest = 86400;     // longest wind, s
constexpr double kStrongest = 10;      // strongest recorded wind, m/s: CandleRig clamps stronger wind
constexpr double kFadeSeconds = 0.12;  // rise and decay time of a blow
constexpr double kBlowOutSpeed = 3;    // speed of a blow-out, m/s
constexpr double kBlowOutSeconds = 0.3;
constexpr double kBlowOutRamp = 0.03;  // rise and decay time of a puff or blow-out, s
constexpr double kQuietBefore = 0.5;   // s of calm before a puff, so that no other wind extinguishes the flame
constexpr double kQuietAfter = 1.0;    // s of calm after lighting, so that the flame survives
constexpr double kWeakestPuff = 1.2;   // speed of the weakest puff, m/s: a candle survives it
constexpr double kStrongestPuff = 4;
constexpr double kShortestPuff = 0.05;  // duration of the shortest puff, s
constexpr double kLongestPuff = 0.6;
constexpr double kClosestPuffs = 2;  // minimum of the option puff_every, s

Result<void> check(const WindSignalOptions& o, double seconds) {
  return flow::check_ranges("wind", {
                                        {"most", o.most, 0, 10},
                                        {"noise", o.noise, 0, 10},
                                        {"bandwidth_hz", o.bandwidth_hz, 0.1, 50},
                                        {"gust", o.gust, 0, 10},
                                        {"rest_share", o.rest_share, 0, 0.9},
                                        {"blow_out_at", o.blow_out_at, -kLongest, kLongest},
                                        {"puff_every", o.puff_every, 0, kLongest},
                                        {"relight_after", o.relight_after, -kLongest, kLongest},
                                        {"seconds", seconds, 0, kLongest},
                                    });
}

// Returns 0 at the ends of [0, length], 1 between, with raised-cosine slopes.
double plateau(double t, double length, double rise, double fall) {
  if (t <= 0 || t >= length) return 0;
  const double up = std::min(1.0, t / rise);
  const double down = std::min(1.0, (length - t) / fall);
  return 0.25 * (1 - std::cos(std::numbers::pi * up)) * (1 - std::cos(std::numbers::pi * down));
}

// Adds a gust: a quick rise, a slower decay.
void add_gust(std::vector<double>& wind, flow::RandomNumbers& random, double start, double peak) {
  const double length = random.uniform(0.15, 1.2);
  const double rise = length * random.uniform(0.1, 0.4);
  const auto first = static_cast<std::size_t>(start * kRate);
  for (std::size_t k = first; k < wind.size() && static_cast<double>(k - first) < length * kRate; ++k)
    wind[k] += peak * plateau(static_cast<double>(k - first) / kRate, length, rise, length - rise);
}

// Alternates blows and rests. A blow has a steady part, wideband noise and a few gusts.
std::vector<double> gusts(const WindSignalOptions& o, std::size_t count) {
  std::vector<double> wind(count, 0.0);
  flow::LowPass band(o.bandwidth_hz, kRate);
  flow::RandomNumbers noise(o.seed, 1);
  flow::RandomNumbers random(o.seed, 2);
  std::size_t k = 0;
  while (k < count) {
    const double length = random.uniform(2, 6);
    const double rest = length * o.rest_share / (1 - o.rest_share) * random.uniform(0.5, 1.5);
    const double steady = random.uniform(0.1, 0.5) * o.most;
    const double strength = o.noise * random.uniform(0.4, 1.4);
    const double sign = o.both_sides && random.uniform() < 0.5 ? -1 : 1;
    const std::size_t end = std::min(count, k + static_cast<std::size_t>(length * kRate));
    std::vector<double> blow(end - k);
    for (double& value : blow) value = steady + strength * band.next(noise.normal());
    for (double start = random.uniform(0.1, 1.0); start < length; start += random.uniform(0.4, 2.0))
      add_gust(blow, random, start, o.gust * random.uniform(0.4, 1.4));
    for (std::size_t n = 0; n < blow.size(); ++n)
      wind[k + n] = sign * std::clamp(blow[n], 0.0, o.most) *
                    plateau(static_cast<double>(n) / kRate, length, kFadeSeconds, kFadeSeconds);
    k = end + static_cast<std::size_t>(rest * kRate);
  }
  return wind;
}

// Returns the options for draughts of a closed room; of `o` only the seed is used. A flame's brightness then varies by
// 0.6 to 1.6 % over 10 s (mean of eight seeds: 1.0 %). With a third of this wind a capture takes the flame for a lamp.
WindSignalOptions draughts(const WindSignalOptions& o) {
  return {
      .most = 0.05, .noise = 0.015, .bandwidth_hz = 1, .gust = 0, .rest_share = 0, .both_sides = true, .seed = o.seed};
}

std::vector<double> air(const WindSignalOptions& o, std::size_t count) {
  switch (o.kind) {
    case WindKind::kCalm:
      return std::vector<double>(count, 0.0);
    case WindKind::kDraughts:
      return gusts(draughts(o), count);
    case WindKind::kGusts:
      return gusts(o, count);
  }
  return {};
}

// A puff. The wind is calm from kQuietBefore before the puff until kQuietAfter after the candle is relit.
struct Puff {
  double at = 0;
  double speed = kBlowOutSpeed;
  double seconds = kBlowOutSeconds;
};

void add_puff(const Puff& puff, double relight_after, std::vector<double>& wind) {
  const double quiet_until = relight_after < 0 ? 1e9 : relight_after + kQuietAfter;
  for (std::size_t k = 0; k < wind.size(); ++k) {
    const double t = static_cast<double>(k) / kRate - puff.at;
    if (t > -kQuietBefore && t < quiet_until)
      wind[k] = puff.speed * plateau(t, puff.seconds + 2 * kBlowOutRamp, kBlowOutRamp, kBlowOutRamp);
  }
}

std::vector<Puff> puffs(const WindSignalOptions& o, double seconds) {
  std::vector<Puff> all;
  if (o.blow_out_at >= 0) all.push_back({o.blow_out_at});
  if (o.puff_every == 0) return all;
  flow::RandomNumbers random(o.seed, 3);
  for (double at = o.puff_every; at < seconds; at += o.puff_every) {
    const double speed = random.uniform(kWeakestPuff, kStrongestPuff);
    const double length = kShortestPuff * std::pow(kLongestPuff / kShortestPuff, random.uniform());
    all.push_back({at, speed, length});
  }
  return all;
}

// Interpolates missing samples linearly, and at the ends by the nearest sample. Returns whether there was any sample.
bool fill_missing(std::vector<double>& samples) {
  std::size_t last = samples.size();
  for (std::size_t k = 0; k < samples.size(); ++k) {
    if (std::isnan(samples[k])) continue;
    for (std::size_t m = last == samples.size() ? 0 : last + 1; m < k; ++m) {
      const double t = last == samples.size() ? 1.0 : static_cast<double>(m - last) / static_cast<double>(k - last);
      samples[m] = last == samples.size() ? samples[k] : samples[last] + t * (samples[k] - samples[last]);
    }
    last = k;
  }
  if (last == samples.size()) return false;
  std::fill(samples.begin() + static_cast<std::ptrdiff_t>(last) + 1, samples.end(), samples[last]);
  return true;
}

using flow::RandomNumbers;

constexpr double kOtherLevel = 0.05;  // typical root mean square of a sound other than wind

// A two-pole resonance.
class Resonance {
 public:
  Resonance() = default;
  Resonance(double frequency_hz, double decay_seconds, double rate_hz) {
    const double radius = std::exp(-1 / (decay_seconds * rate_hz));
    const double angle = 2 * std::numbers::pi * std::min(frequency_hz, 0.45 * rate_hz) / rate_hz;
    a1_ = 2 * radius * std::cos(angle);
    a2_ = -radius * radius;
    // With this gain the impulse response has an amplitude of about 1.
    gain_ = std::sin(angle);
  }

  double next(double x) {
    const double y = gain_ * x + a1_ * y1_ + a2_ * y2_;
    y2_ = y1_;
    y1_ = std::abs(y) < 1e-20 ? 0.0 : y;
    return y1_;
  }

 private:
  double a1_ = 0, a2_ = 0, gain_ = 0, y1_ = 0, y2_ = 0;
};

// Occasional other sounds of about unit level, silence between: syllables of a voice, or a few knocks on the table.
class OtherSounds {
 public:
  /// `a_second`: reciprocal of the mean pause between sounds, 1/s; 0: no sounds.
  OtherSounds(double rate_hz, double a_second, std::uint64_t seed)
      : rate_hz_(rate_hz), a_second_(a_second), random_(seed, 3) {
    wait();
  }

  double next() {
    if (!sounding()) {
      if (gap_-- > 0) return 0;
      start();
    }
    const double value = is_voice_ ? voice() : knock();
    if (++place_ >= length_) wait();
    return value;
  }

  bool sounding() const { return place_ < length_; }

 private:
  void wait() {
    const double seconds = a_second_ > 0 ? random_.uniform(0.3, 1.7) / a_second_ : 1e9;
    gap_ = static_cast<std::int64_t>(seconds * rate_hz_);
    place_ = length_ = 0;
  }

  void start() {
    is_voice_ = random_.uniform() < 0.5;
    place_ = 0;
    phase_ = 1;
    if (is_voice_) {
      length_ = static_cast<std::int64_t>(random_.uniform(0.4, 1.2) * rate_hz_);
      pitch_hz_ = random_.uniform(95, 220);
      glide_ = random_.uniform(-0.25, 0.1);
      syllable_seconds_ = random_.uniform(0.16, 0.28);
      resonances_ = {Resonance(random_.uniform(350, 750), 0.006, rate_hz_),
                     Resonance(random_.uniform(1000, 1900), 0.004, rate_hz_), Resonance(2600, 0.003, rate_hz_)};
    } else {
      length_ = static_cast<std::int64_t>(random_.uniform(0.2, 0.7) * rate_hz_);
      knock_seconds_ = random_.uniform(0.15, 0.3);
      resonances_ = {Resonance(random_.uniform(120, 300), 0.02, rate_hz_),
                     Resonance(random_.uniform(500, 900), 0.01, rate_hz_), Resonance(1800, 0.004, rate_hz_)};
    }
  }

  double voice() {
    const double t = static_cast<double>(place_) / rate_hz_;
    phase_ += pitch_hz_ * (1 + glide_ * t) / rate_hz_;
    double pulse = 0;
    if (phase_ >= 1) {
      phase_ -= 1;
      pulse = 1;
    }
    const double mouth = 0.5 * (1 - std::cos(2 * std::numbers::pi * t / syllable_seconds_));
    const double ends = std::min(1.0, 30 * static_cast<double>(length_ - place_) / rate_hz_);
    return 2.2 * mouth * ends *
           (resonances_[0].next(pulse) + 0.5 * resonances_[1].next(pulse) + 0.25 * resonances_[2].next(pulse));
  }

  double knock() {
    const auto every = static_cast<std::int64_t>(knock_seconds_ * rate_hz_);
    const double blow = place_ % std::max<std::int64_t>(every, 1) == 0 ? 1 : 0;
    return 4 * (resonances_[0].next(blow) + 0.6 * resonances_[1].next(blow) + 0.3 * resonances_[2].next(blow));
  }

  double rate_hz_;
  double a_second_;
  RandomNumbers random_;
  std::array<Resonance, 3> resonances_;
  std::int64_t gap_ = 0;    // samples until the next sound begins
  std::int64_t place_ = 0;  // position in the sound, samples
  std::int64_t length_ = 0;
  bool is_voice_ = false;
  double pitch_hz_ = 0, glide_ = 0, phase_ = 0, syllable_seconds_ = 0, knock_seconds_ = 0;
};

Result<void> check(const VirtualMicrophoneOptions& o) {
  return flow::check_ranges("virtual microphone", {
                                                      {"rate_hz", o.rate_hz, 4000, 192000},
                                                      {"exponent", o.exponent, 0.5, 4},
                                                      {"level", o.level, 1e-6, 1},
                                                      {"corner_hz", o.corner_hz, 20, std::min(5000.0, 0.4 * o.rate_hz)},
                                                      {"hiss", o.hiss, 0, 0.1},
                                                      {"other_sounds", o.other_sounds, 0, 10},
                                                  });
}

}  // namespace

Result<WindSignal> WindSignal::generate(const WindSignalOptions& options, double seconds) {
  if (auto good = check(options, seconds); !good) return good.error();
  if (options.puff_every > 0 && options.puff_every < kClosestPuffs)
    return Error{"wind: puff_every is " + std::to_string(options.puff_every) + ", expected 0, or 2 s and more"};
  const double latest = std::max(options.blow_out_at, options.puff_every);  // of the first puffs of both options
  if (latest > 0 && latest >= seconds)
    return Error{"wind: a puff at " + number_text(latest, 6) + " s is not before its end at " +
                 number_text(seconds, 6) + " s"};
  WindSignal signal;
  signal.rate_hz_ = kRate;
  const auto count = static_cast<std::size_t>(std::ceil(seconds * kRate)) + 1;
  signal.samples_ = air(options, count);
  for (const Puff& puff : puffs(options, seconds)) {
    add_puff(puff, options.relight_after, signal.samples_);
    if (options.relight_after >= 0) signal.relights_.push_back(puff.at + options.relight_after);
  }
  std::sort(signal.relights_.begin(), signal.relights_.end());
  return signal;
}

Result<WindSignal> WindSignal::from_recording(const Recording& recording) {
  const auto inputs = channels_with_role(recording, Role::kInput);
  if (inputs.size() != 1)
    return Error{recording.source + ": " + std::to_string(inputs.size()) +
                 " input channels, expected one to take as wind"};
  if (!(recording.rate_hz > 0)) return Error{recording.source + ": no rate, expected samples a second above 0"};
  const Channel& channel = recording.channels[inputs.front()];
  WindSignal signal;
  signal.rate_hz_ = recording.rate_hz;
  signal.samples_ = channel.samples;
  if (!fill_missing(signal.samples_))
    return Error{recording.source + ": channel '" + channel.name + "' has no samples, expected a wind in m/s"};
  const auto strong = std::ranges::find_if(signal.samples_, [](double v) { return !(std::abs(v) <= kStrongest); });
  if (strong == signal.samples_.end()) return signal;
  return Error{recording.source + ": " + channel.name + " in row " +
               std::to_string(strong - signal.samples_.begin() + 1) + " is " + std::to_string(*strong) +
               ", expected a wind within 10 m/s"};
}

double WindSignal::at(double seconds) const {
  const double place = std::clamp(seconds * rate_hz_, 0.0, static_cast<double>(samples_.size() - 1));
  const auto k = std::min(static_cast<std::size_t>(place), samples_.size() - 1);
  const std::size_t next = std::min(k + 1, samples_.size() - 1);
  return samples_[k] + (place - static_cast<double>(k)) * (samples_[next] - samples_[k]);
}

struct VirtualMicrophone::Parts {
  explicit Parts(const VirtualMicrophoneOptions& o)
      : options(o),
        wind_noise(o.seed, 1),
        hiss_noise(o.seed, 2),
        rumble(o.corner_hz, o.rate_hz),
        others(o.rate_hz, o.other_sounds, o.seed) {}

  VirtualMicrophoneOptions options;
  flow::RandomNumbers wind_noise, hiss_noise;
  flow::LowPass rumble;
  OtherSounds others;
};

VirtualMicrophone::VirtualMicrophone(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
VirtualMicrophone::VirtualMicrophone(VirtualMicrophone&&) noexcept = default;
VirtualMicrophone& VirtualMicrophone::operator=(VirtualMicrophone&&) noexcept = default;
VirtualMicrophone::~VirtualMicrophone() = default;

Result<VirtualMicrophone> VirtualMicrophone::create(const VirtualMicrophoneOptions& options) {
  if (auto good = check(options); !good) return good.error();
  return VirtualMicrophone(std::make_unique<Parts>(options));
}

void VirtualMicrophone::hear(std::span<const float> wind, std::span<float> sound) {
  Parts& p = *parts_;
  const VirtualMicrophoneOptions& o = p.options;
  for (std::size_t k = 0; k < sound.size(); ++k) {
    const double speed = std::abs(static_cast<double>(wind[k]));
    const double loudness = o.level * (o.exponent == 2 ? speed * speed : std::pow(speed, o.exponent));
    double value = loudness * p.rumble.next(p.wind_noise.normal()) + o.hiss * p.hiss_noise.normal();
    value += kOtherLevel * p.others.next();
    sound[k] = static_cast<float>(std::clamp(value, -1.0, 1.0));
  }
}

}  // namespace wisp
