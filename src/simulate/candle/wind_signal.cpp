#include "simulate/candle/wind_signal.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "simulate/option_range.hpp"
#include "simulate/random_numbers.hpp"

namespace wisp {
namespace {

constexpr double kRate = 240;          // samples per second: forty times the noise's band
constexpr double kLongest = 86400;     // longest wind, s
constexpr double kFadeSeconds = 0.12;  // rise and decay time of a blow
constexpr double kBlowOutSpeed = 3;    // speed of a blow-out, m/s
constexpr double kBlowOutSeconds = 0.3;
constexpr double kBlowOutRamp = 0.03;  // rise and decay time of a blow-out, s
constexpr double kQuietBefore = 0.5;   // s of calm before a blow-out, so that the puff alone extinguishes
constexpr double kQuietAfter = 1.0;    // s of calm after lighting, so that the flame survives
constexpr double kWeakestPuff = 1.2;   // m/s: a candle survives it
constexpr double kStrongestPuff = 4;
constexpr double kShortestPuff = 0.05;  // duration of the shortest puff, s
constexpr double kLongestPuff = 0.6;
constexpr double kClosestPuffs = 2;  // least interval between puffs, s

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

// Draughts of a closed room, independent of the options for gusts: the brightness then varies by 0.6 to 1.6 % over ten
// seconds, by 1.0 % on average of eight. With draughts a third as strong the flame is refused as a lamp.
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

// A puff with calm around it, until some time after the candle is relit.
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

}  // namespace

Result<WindSignal> WindSignal::generate(const WindSignalOptions& options, double seconds) {
  if (auto good = check(options, seconds); !good) return good.error();
  if (options.puff_every > 0 && options.puff_every < kClosestPuffs)
    return Error{"wind: puff_every is " + std::to_string(options.puff_every) + ", expected 0, or 2 s and more"};
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
  if (inputs.size() != 1) {
    return Error{recording.source + ": " + std::to_string(inputs.size()) +
                 " input channels, expected one to take as wind"};
  }
  if (!(recording.rate_hz > 0)) return Error{recording.source + ": no rate, expected samples a second above 0"};
  const Channel& channel = recording.channels[inputs.front()];
  WindSignal signal;
  signal.rate_hz_ = recording.rate_hz;
  signal.samples_ = channel.samples;
  if (!fill_missing(signal.samples_))
    return Error{recording.source + ": channel '" + channel.name + "' has no samples, expected a wind in m/s"};
  return signal;
}

double WindSignal::at(double seconds) const {
  const double place = std::clamp(seconds * rate_hz_, 0.0, static_cast<double>(samples_.size() - 1));
  const auto k = std::min(static_cast<std::size_t>(place), samples_.size() - 1);
  const std::size_t next = std::min(k + 1, samples_.size() - 1);
  return samples_[k] + (place - static_cast<double>(k)) * (samples_[next] - samples_[k]);
}

double WindSignal::seconds() const { return static_cast<double>(samples_.size() - 1) / rate_hz_; }

}  // namespace wisp
