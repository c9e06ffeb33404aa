#include "wisp/simulate/leaf_drops.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "simulate/leaf/leaf_flight.hpp"
#include "simulate/option_range.hpp"
#include "simulate/random_numbers.hpp"

namespace wisp {
namespace {

using flow::RandomNumbers;

constexpr double kMaxRows = 2147483648.0;
constexpr double kMaxGust = 30;            // m/s, of each component of a measured wind
constexpr double kCloneDifference = 0.05;  // standard deviation of a clone's start: rad, m/s; of its spin 0.5 rad/s
constexpr double kLeadSeconds = 0.5;       // from the start of a fall to the onset of its gust, ± 20 %

// Random streams, one per purpose.
enum Purpose : std::uint64_t { kStart = 31, kDifference = 32, kGust = 33, kWindSeed = 34 };

Result<void> check(const LeafDropsOptions& o, double episodes) {
  auto good = flow::check_ranges("leaf drops", {
                                                   {"drops", static_cast<double>(o.drops), 1, 100000},
                                                   {"seconds", o.seconds, 0.1, 3600},
                                                   {"settle_seconds", o.settle_seconds, 0, 60},
                                                   {"rate_hz", o.rate_hz, 1, 10000},
                                                   {"threads", static_cast<double>(o.threads), 0, 256},
                                               });
  if (!good) return good;
  const double rows = episodes * o.seconds * o.rate_hz;
  if (rows > kMaxRows)
    return Error{"leaf drops: " + std::to_string(rows) +
                 " rows are too many, expected at most 2147483648; take fewer "
                 "drops, fewer seconds or a lower rate"};
  if (!o.track.rows.empty() && !(o.track.rate_hz > 0)) return Error{"leaf drops: the wind's rate is not above 0"};
  for (const auto& row : o.track.rows) {
    for (double speed : row) {
      if (!(std::abs(speed) <= kMaxGust)) return Error{"leaf drops: the wind is not within 30 m/s"};
    }
  }
  return wisp::check(o.leaf);
}

std::size_t rows_of(const LeafDropsOptions& o) {
  return static_cast<std::size_t>(std::max(2.0, std::round(o.seconds * o.rate_hz)));
}

// Returns a random attitude, and velocities typical of a fall.
LeafState random_start(RandomNumbers random) {
  LeafState state;
  for (double& part : state.attitude) part = random.normal();
  state.attitude = leaf::normalised(state.attitude);
  for (double& part : state.velocity) part = 0.3 * random.normal();
  for (double& part : state.spin) part = 3 * random.normal();
  return state;
}

LeafState a_little_different(LeafState state, double difference, RandomNumbers random) {
  const double x = difference * random.normal(), y = difference * random.normal(), z = difference * random.normal();
  const leaf::Quaternion turn = leaf::turning(state.attitude, {x, y, z});
  for (std::size_t k = 0; k < 4; ++k) state.attitude[k] += turn[k];
  state.attitude = leaf::normalised(state.attitude);
  for (double& part : state.velocity) part += difference * random.normal();
  for (double& part : state.spin) part += 10 * difference * random.normal();
  return state;
}

// Channels in the order of the file.
enum Column : std::size_t { kWind = 0, kPosition = 3, kAttitude = 6, kColumns = 10 };

Recording empty_recording(const LeafDropsOptions& o, std::size_t episodes) {
  Recording recording;
  recording.source = "simulated leaf";
  recording.rate_hz = o.rate_hz;
  const std::size_t rows = episodes * rows_of(o);
  const char* const names[kColumns] = {"wind.x", "wind.y", "wind.z", "pos.x", "pos.y",
                                       "pos.z",  "q.w",    "q.x",    "q.y",   "q.z"};
  for (std::size_t k = 0; k < kColumns; ++k) {
    const char* unit = k < kPosition ? "m/s" : k < kAttitude ? "m" : "1";
    recording.channels.push_back(
        {names[k], unit, k < kPosition ? Role::kInput : Role::kOutput, std::vector<double>(rows)});
  }
  recording.episode_ids.resize(rows);
  const double leaf[] = {o.leaf.length, o.leaf.width, o.leaf.areal_density};
  set_numbers_attribute(recording, "leaf_length_width_density", leaf);
  recording.attributes.push_back({"seed", std::to_string(o.seed)});
  return recording;
}

// Writes a fall into the rows of its episode in the recording.
class EpisodeWriter {
 public:
  EpisodeWriter(Recording& recording, std::size_t episode, std::size_t rows)
      : recording_(recording), episode_(episode), row_(episode * rows) {}

  void add(const LeafState& state, const std::array<double, 3>& wind) {
    if (first_) origin_ = state.position;
    const auto& q = state.attitude;
    const double along = first_ ? q[0] : q[0] * last_[0] + q[1] * last_[1] + q[2] * last_[2] + q[3] * last_[3];
    const double sign = along < 0 ? -1 : 1;
    for (std::size_t k = 0; k < 4; ++k) {
      last_[k] = sign * q[k];
      put(kAttitude + k, last_[k]);
    }
    for (std::size_t k = 0; k < 3; ++k) {
      put(kPosition + k, state.position[k] - origin_[k]);
      put(kWind + k, wind[k]);
    }
    recording_.episode_ids[row_++] = static_cast<std::int64_t>(episode_);
    first_ = false;
  }

 private:
  void put(std::size_t channel, double value) { recording_.channels[channel].samples[row_] = value; }

  Recording& recording_;
  std::size_t episode_;
  std::size_t row_;
  bool first_ = true;
  std::array<double, 3> origin_{};
  std::array<double, 4> last_{};
};

Result<void> record(LeafFlight& flight, const LeafWind& wind, const LeafDropsOptions& o, EpisodeWriter writer) {
  const std::size_t rows = rows_of(o);
  for (std::size_t row = 0; row < rows; ++row) {
    if (row > 0)
      if (auto good = flight.advance(1 / o.rate_hz); !good) return good;
    const LeafState& s = flight.state();
    writer.add(s, wind.at(s.position, leaf_world_velocity(s), flight.seconds()).velocity);
  }
  return {};
}

// Returns a flight from a random start, advanced by settle_seconds, to the beginning of the recording.
Result<LeafFlight> settled(const LeafDropsOptions& o, const LeafWind& wind, std::uint64_t drop) {
  RandomNumbers random(o.seed, (kStart << 32) + drop);
  auto flight = LeafFlight::begin(o.leaf, wind, random_start(random));
  if (!flight || o.settle_seconds == 0) return flight;
  if (auto good = flight->advance(o.settle_seconds); !good) return good.error();
  return flight;
}

LeafWind wind_of(const LeafDropsOptions& o, std::size_t drop) {
  if (!o.track.rows.empty()) {
    MeasuredWind track = o.track;
    track.begins += o.settle_seconds;
    return LeafWind::of_track(std::move(track));
  }
  if (!o.gusts) return {};
  return LeafWind::gusty(flow::random_word(o.seed + 1, kWindSeed, drop), o.settle_seconds + o.seconds);
}

Result<void> fall(const LeafDropsOptions& o, std::size_t drop, Recording& recording) {
  const LeafWind wind = wind_of(o, drop);
  auto flight = settled(o, wind, drop);
  if (!flight) return flight.error();
  return record(*flight, wind, o, {recording, drop, rows_of(o)});
}

// Calls `work` with 0 … count−1, on all threads. Returns the error of the failing call of lowest index.
template <class Work>
Result<void> in_parallel(const LeafDropsOptions& o, std::size_t count, Work work) {
  const std::size_t cores = std::max(1U, std::thread::hardware_concurrency());
  const std::size_t threads = std::min(count, o.threads > 0 ? static_cast<std::size_t>(o.threads) : cores);
  std::atomic<std::size_t> next{0}, done{0};
  std::mutex mutex;
  std::optional<std::pair<std::size_t, Error>> failure;
  const auto labour = [&](bool reports) {
    for (std::size_t k = next++; k < count; k = next++) {
      if (const Result<void> good = work(k); !good) {
        const std::lock_guard lock(mutex);
        if (!failure || k < failure->first) failure = {k, good.error()};
      }
      const double share = static_cast<double>(++done) / static_cast<double>(count);
      if (reports && o.on_progress) o.on_progress(share);
    }
  };
  std::vector<std::thread> others;
  for (std::size_t k = 1; k < threads; ++k) others.emplace_back(labour, false);
  labour(true);
  for (std::thread& other : others) other.join();
  if (failure) return Error{"drop " + std::to_string(failure->first + 1) + ": " + failure->second.message};
  return {};
}

// Returns a gust like those of LeafWind::gusty(), but with its onset after about kLeadSeconds and in any direction.
Gust one_gust(const LeafPairsOptions& o, std::uint64_t index) {
  const std::uint64_t seed = flow::random_word(o.drops.seed + 1, kWindSeed, index);
  Gust gust = LeafWind::gusty(seed, 2 * LeafWind::kRestSeconds).gusts().front();
  RandomNumbers random(o.drops.seed, (kGust << 32) + index);
  gust.start = kLeadSeconds * random.uniform(0.8, 1.2);
  // Uniform over all directions, up and down included.
  const double up = random.uniform(-1, 1), over_ground = std::sqrt(1 - up * up);
  for (auto* vector : {&gust.velocity, &gust.slowness}) {
    auto& [x, y, z] = *vector;
    z = up * std::hypot(x, y);
    x *= over_ground;
    y *= over_ground;
  }
  return gust;
}

// Simulates the falls of all clones of one gust, each with the gust and without.
Result<void> fall_in_pairs(const LeafPairsOptions& o, std::size_t index, LeafPairs& pairs) {
  const LeafDropsOptions& d = o.drops;
  const LeafWind calm, windy = LeafWind::of_gusts({one_gust(o, index)});
  const auto before = settled(d, calm, index);
  if (!before) return before.error();
  LeafState start = before->state();
  start.position = {};
  for (int clone = 0; clone < o.clones; ++clone) {
    const std::size_t episode = index * static_cast<std::size_t>(o.clones) + static_cast<std::size_t>(clone);
    const LeafState own = a_little_different(start, kCloneDifference, {d.seed, (kDifference << 32) + episode});
    for (const bool blows : {false, true}) {
      const LeafWind& wind = blows ? windy : calm;
      auto flight = LeafFlight::begin(d.leaf, wind, own);
      if (!flight) return flight.error();
      auto good = record(*flight, wind, d, {blows ? pairs.windy : pairs.calm, episode, rows_of(d)});
      if (!good) return good;
    }
  }
  return {};
}

}  // namespace

Result<Recording> simulate_leaf_drops(const LeafDropsOptions& options) {
  if (auto good = check(options, options.drops); !good) return good.error();
  const auto drops = static_cast<std::size_t>(options.drops);
  Recording recording = empty_recording(options, drops);
  auto good = in_parallel(options, drops, [&](std::size_t drop) { return fall(options, drop, recording); });
  if (!good) return good.error();
  return recording;
}

Result<LeafPairs> simulate_leaf_pairs(const LeafPairsOptions& options) {
  auto good = flow::check_ranges("leaf pairs", {{"clones", static_cast<double>(options.clones), 1, 10000}});
  if (!good) return good.error();
  const LeafDropsOptions& drops = options.drops;
  if (good = check(drops, static_cast<double>(drops.drops) * options.clones); !good) return good.error();
  const auto gusts = static_cast<std::size_t>(drops.drops);
  const std::size_t episodes = gusts * static_cast<std::size_t>(options.clones);
  LeafPairs pairs{empty_recording(drops, episodes), empty_recording(drops, episodes)};
  for (Recording* recording : {&pairs.windy, &pairs.calm}) {
    recording->attributes.push_back({"pair", "leaf-" + std::to_string(drops.seed)});
    recording->attributes.push_back({"clones", std::to_string(options.clones)});
  }
  good = in_parallel(drops, gusts, [&](std::size_t gust) { return fall_in_pairs(options, gust, pairs); });
  if (!good) return good.error();
  return pairs;
}

}  // namespace wisp
