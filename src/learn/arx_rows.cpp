#include "arx_rows.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace wisp {
namespace {

std::string known_channels(const Recording& recording) {
  std::string list;
  for (const Channel& channel : recording.channels) list += (list.empty() ? "" : ", ") + channel.name;
  return list.empty() ? "none" : list;
}

std::string name_of(const Recording& recording, std::size_t index) {
  return recording.source.empty() ? "recording " + std::to_string(index) : recording.source;
}

Result<void> find_samples(std::span<const Recording> recordings, Signals& signals) {
  for (std::size_t r = 0; r < recordings.size(); ++r) {
    const Recording& recording = recordings[r];
    auto& samples = signals.samples.emplace_back();
    for (const std::string& name : signals.names) {
      const auto index = find_channel(recording, name);
      if (!index) {
        return Error{name_of(recording, r) + " has no channel '" + name + "'; it has: " + known_channels(recording)};
      }
      samples.emplace_back(recording.channels[*index].samples);
    }
    signals.episodes.push_back(episodes(recording));
    const double rate = recordings.front().rate_hz;
    if (std::abs(recording.rate_hz - rate) > 1e-6 * rate) {
      return Error{name_of(recording, r) + " has " + std::to_string(recording.rate_hz) + " samples a second and " +
                   name_of(recordings.front(), 0) + " has " + std::to_string(rate) +
                   "; one fit needs one rate: resample one of them"};
    }
  }
  return {};
}

struct Sums {
  double sum = 0;
  std::size_t count = 0;
};

// Compensated by blocks: the error does not grow with the number of samples.
Sums finite_sum(std::span<const double> samples, double offset, bool squared) {
  constexpr std::size_t kBlock = 256;
  Sums total;
  double lost = 0;
  for (std::size_t begin = 0; begin < samples.size(); begin += kBlock) {
    double sum = 0;
    const auto block = samples.subspan(begin, std::min(kBlock, samples.size() - begin));
    for (double sample : block) {
      if (std::isnan(sample)) continue;
      const double value = sample - offset;
      sum += squared ? value * value : value;
      ++total.count;
    }
    const double term = sum - lost;
    const double next = total.sum + term;
    lost = (next - total.sum) - term;
    total.sum = next;
  }
  return total;
}

Sums sum_over_recordings(const Signals& signals, int channel, double offset, bool squared) {
  Sums total;
  for (const auto& samples : signals.samples) {
    const Sums part = finite_sum(samples[channel], offset, squared);
    total.sum += part.sum;
    total.count += part.count;
  }
  return total;
}

double largest_magnitude(const Signals& signals, int channel) {
  double largest = 0;
  for (const auto& samples : signals.samples) {
    for (double sample : samples[channel]) {
      if (std::abs(sample) > largest) largest = std::abs(sample);
    }
  }
  return largest;
}

std::size_t total_rows(const Signals& signals) {
  std::size_t rows = 0;
  for (const auto& samples : signals.samples) rows += samples.front().size();
  return rows;
}

// A mean is known to some 1e-16 of the largest sample; what is left of a constant channel is below this share of it.
constexpr double kStandsStill = 1e-13;

Result<void> scale_channel(Signals& signals, int channel, ArxOffset offset) {
  const Sums mean = sum_over_recordings(signals, channel, 0.0, false);
  if (mean.count == 0) return Error{"channel '" + signals.names[channel] + "' has no sample that is not missing"};
  if (!std::isfinite(mean.sum)) {
    return Error{"channel '" + signals.names[channel] + "' holds an infinite or overflowing sample"};
  }
  double centre = 0;
  if (offset != ArxOffset::kNone) centre = mean.sum / static_cast<double>(mean.count);
  const Sums square = sum_over_recordings(signals, channel, centre, true);
  const double rms = std::sqrt(square.sum / static_cast<double>(square.count));
  const bool still = rms <= kStandsStill * largest_magnitude(signals, channel);
  signals.offset[channel] = centre;
  signals.deviation[channel] = still ? 0.0 : rms;
  signals.scale[channel] = still ? 0.0 : std::ldexp(1.0, -std::ilogb(rms));
  signals.missing |= mean.count != total_rows(signals);
  return {};
}

// Marks every target row that a missing sample would enter. Nothing is allocated where nothing is missing.
std::vector<std::uint8_t> unusable_rows(const Signals& signals, std::size_t recording,
                                        const std::vector<std::vector<int>>& lags) {
  std::vector<std::uint8_t> bad;
  if (!signals.missing) return bad;
  const std::size_t rows = signals.samples[recording].front().size();
  bad.assign(rows, 0);
  for (int c = 0; c < signals.channels(); ++c) {
    const auto samples = signals.samples[recording][c];
    for (std::size_t s = 0; s < rows; ++s) {
      if (!std::isnan(samples[s])) continue;
      for (int lag : lags[c]) {
        if (s + lag < rows) bad[s + lag] = 1;
      }
    }
  }
  return bad;
}

void add_runs(RowPlan& plan, std::size_t recording, std::size_t begin, std::size_t end,
              const std::vector<std::uint8_t>& bad) {
  std::size_t t = begin;
  while (t < end) {
    std::size_t stop = end;
    if (!bad.empty()) {
      while (t < end && bad[t]) ++t, ++plan.rows_left_out;
      stop = t;
      while (stop < end && !bad[stop]) ++stop;
    }
    if (stop > t) plan.runs.push_back({recording, t, stop});
    plan.rows += stop - t;
    t = stop;
  }
}

}  // namespace

Result<Signals> find_signals(std::span<const Recording> recordings, const ChannelChoice& channels) {
  if (recordings.empty()) return Error{"no recording to learn from"};
  if (channels.outputs.empty()) return Error{"no output channel was named"};
  Signals signals;
  signals.outputs = static_cast<int>(channels.outputs.size());
  signals.inputs = static_cast<int>(channels.inputs.size());
  signals.names = channels.outputs;
  signals.names.insert(signals.names.end(), channels.inputs.begin(), channels.inputs.end());
  if (auto ok = find_samples(recordings, signals); !ok) return ok.error();
  signals.offset.assign(signals.names.size(), 0.0);
  signals.scale.assign(signals.names.size(), 1.0);
  signals.deviation.assign(signals.names.size(), 0.0);
  signals.missing = true;
  return signals;
}

Result<Signals> gather_signals(std::span<const Recording> recordings, const ChannelChoice& channels, ArxOffset offset) {
  auto signals = find_signals(recordings, channels);
  if (!signals) return signals;
  signals->missing = false;
  for (int c = 0; c < signals->channels(); ++c) {
    if (auto ok = scale_channel(*signals, c, offset); !ok) return ok.error();
  }
  return signals;
}

std::vector<std::vector<int>> lags_in_use(const Signals& signals, std::span<const LaggedChannel> columns) {
  std::vector<std::vector<int>> lags(signals.channels());
  for (int i = 0; i < signals.outputs; ++i) lags[i].push_back(0);
  for (const LaggedChannel& column : columns) {
    if (column.channel != kConstantChannel) lags[column.channel].push_back(column.lag);
  }
  for (auto& list : lags) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  }
  return lags;
}

RowPlan plan_rows(const Signals& signals, const std::vector<std::vector<int>>& lags, int first_sample) {
  RowPlan plan;
  plan.first_sample = first_sample;
  for (std::size_t r = 0; r < signals.samples.size(); ++r) {
    const auto bad = unusable_rows(signals, r, lags);
    for (const Episode& episode : signals.episodes[r]) {
      if (episode.size() <= static_cast<std::size_t>(first_sample)) {
        ++plan.episodes_skipped;
        continue;
      }
      // A sample that is missing before the episode began does not matter: history starts at its first row.
      const std::size_t before = plan.rows;
      add_runs(plan, r, episode.begin + first_sample, episode.end, bad);
      plan.rows > before ? ++plan.episodes_used : ++plan.episodes_skipped;
    }
  }
  return plan;
}

void copy_scaled(const Signals& signals, std::size_t recording, int channel, std::size_t begin, std::size_t end,
                 double* out) {
  const double offset = signals.offset[channel];
  const double scale = signals.scale[channel];
  const double* in = signals.samples[recording][channel].data();
  for (std::size_t t = begin; t < end; ++t) *out++ = (in[t] - offset) * scale;
}

}  // namespace wisp
