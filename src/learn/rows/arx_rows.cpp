#include "learn/rows/arx_rows.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "learn/numeric/stream_kernels.hpp"

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
    if (std::abs(recording.rate_hz - rate) > 1e-3 * rate) {
      return Error{name_of(recording, r) + " has " + std::to_string(recording.rate_hz) + " samples a second and " +
                   name_of(recordings.front(), 0) + " has " + std::to_string(rate) +
                   "; one fit needs one rate: resample one of them"};
    }
  }
  return {};
}

ChannelSums block_sums(const double* samples, std::size_t rows, double reference) {
  Pair sum[4] = {};
  Pair square[4] = {};
  std::size_t t = 0;
  for (; t + 8 <= rows; t += 8) {
    for (std::size_t k = 0; k < 4; ++k) {
      const Pair value = load_pair(samples + t + 2 * k) - Pair{reference, reference};
      sum[k] += value;
      square[k] += value * value;
    }
  }
  const Pair total = (sum[0] + sum[1]) + (sum[2] + sum[3]);
  const Pair total_square = (square[0] + square[1]) + (square[2] + square[3]);
  ChannelSums sums{total[0] + total[1], total_square[0] + total_square[1], rows};
  for (; t < rows; ++t) {
    const double value = samples[t] - reference;
    sums.sum += value;
    sums.square += value * value;
  }
  return sums;
}

ChannelSums block_sums_of_present(const double* samples, std::size_t rows, double reference) {
  ChannelSums sums;
  for (std::size_t t = 0; t < rows; ++t) {
    if (std::isnan(samples[t])) continue;
    const double value = samples[t] - reference;
    sums.sum += value;
    sums.square += value * value;
    ++sums.count;
  }
  return sums;
}

// Sums block by block, which keeps the rounding error nearly independent of the number of samples.
ChannelSums channel_sums(const Signals& signals, int channel, double reference) {
  ChannelSums total;
  for (const auto& samples : signals.samples) {
    const auto series = samples[channel];
    for (std::size_t begin = 0; begin < series.size(); begin += kBlockRows) {
      const std::size_t rows = std::min(kBlockRows, series.size() - begin);
      ChannelSums part = block_sums(series.data() + begin, rows, reference);
      if (std::isnan(part.sum)) part = block_sums_of_present(series.data() + begin, rows, reference);
      total.sum += part.sum;
      total.square += part.square;
      total.count += part.count;
    }
  }
  return total;
}

double first_present(const Signals& signals, int channel) {
  for (const auto& samples : signals.samples) {
    for (double sample : samples[channel]) {
      if (!std::isnan(sample)) return sample;
    }
  }
  return 0;
}

std::size_t total_rows(const Signals& signals) {
  std::size_t rows = 0;
  for (const auto& samples : signals.samples) rows += samples.front().size();
  return rows;
}

Result<void> scale_channel(Signals& signals, int channel, ArxOffset offset) {
  const double reference = first_present(signals, channel);
  const ChannelSums sums = channel_sums(signals, channel, reference);
  const std::string name = "channel '" + signals.names[channel] + "'";
  if (sums.count == 0)
    return Error{name + " has no sample that is not missing, expected numbers: is it the right column?"};
  if (!std::isfinite(sums.sum) || !std::isfinite(sums.square)) {
    return Error{name + " holds an infinite sample, or samples so large that their squares overflow"};
  }
  const ChannelPoint point = operating_point(sums, reference, offset);
  signals.offset[channel] = point.offset;
  signals.scale[channel] = point.scale;
  signals.missing |= sums.count != total_rows(signals);
  return {};
}

// Marks every target row with a missing sample in its regression. Allocates nothing where nothing is missing.
std::vector<std::uint8_t> unusable_rows(const Signals& signals, std::size_t recording, const LagLayout& layout,
                                        int first_channel) {
  std::vector<std::uint8_t> bad;
  if (!signals.missing) return bad;
  const std::size_t rows = signals.samples[recording].front().size();
  bad.assign(rows, 0);
  for (int c = first_channel; c < signals.channels(); ++c) {
    const auto samples = signals.samples[recording][c];
    for (std::size_t s = 0; s < rows; ++s) {
      if (!std::isnan(samples[s])) continue;
      for (int lag : layout.lags(c)) {
        if (s + static_cast<std::size_t>(lag) < rows) bad[s + static_cast<std::size_t>(lag)] = 1;
      }
    }
  }
  return bad;
}

void add_runs(RowPlan& plan, const RowRun& rows, const std::vector<std::uint8_t>& bad) {
  std::size_t t = rows.begin;
  while (t < rows.end) {
    std::size_t stop = rows.end;
    if (!bad.empty()) {
      while (t < rows.end && bad[t]) ++t, ++plan.rows_left_out;
      stop = t;
      while (stop < rows.end && !bad[stop]) ++stop;
    }
    if (stop > t) plan.runs.push_back({rows.recording, t, stop});
    plan.rows += stop - t;
    t = stop;
  }
}

// Adds the usable rows of a recording. History starts at an episode's first row and plan.first_sample is at least every
// lag, so missing samples of the episode before cannot reach into this one.
void plan_recording(const Signals& signals, std::size_t recording, const LagLayout& layout, int first_channel,
                    RowPlan& plan) {
  const auto bad = unusable_rows(signals, recording, layout, first_channel);
  for (const Episode& episode : signals.episodes[recording]) {
    const std::size_t before = plan.rows, first = static_cast<std::size_t>(plan.first_sample);
    if (episode.size() > first) add_runs(plan, {recording, episode.begin + first, episode.end}, bad);
    ++(plan.rows > before ? plan.episodes_used : plan.episodes_skipped);
  }
}

void copy_scaled(const double* in, std::size_t rows, double offset, double scale, double* out) {
  std::size_t t = 0;
  for (; t + 2 <= rows; t += 2) {
    store_pair(out + t, (load_pair(in + t) - Pair{offset, offset}) * Pair{scale, scale});
  }
  for (; t < rows; ++t) out[t] = (in[t] - offset) * scale;
}

}  // namespace

LagLayout::LagLayout(int outputs, int inputs, std::span<const LaggedChannel> used)
    : outputs_(outputs), lags_(outputs + inputs), columns_{{kConstantChannel, 0}} {
  for (int i = 0; i < outputs; ++i) lags_[i].push_back(0);
  for (const LaggedChannel& column : used) {
    if (column.channel != kConstantChannel) lags_[column.channel].push_back(column.lag);
  }
  for (int c = 0; c < channels(); ++c) {
    std::sort(lags_[c].begin(), lags_[c].end());
    lags_[c].erase(std::unique(lags_[c].begin(), lags_[c].end()), lags_[c].end());
    first_.push_back(size());
    for (int lag : lags_[c]) columns_.push_back({c, lag});
    if (!lags_[c].empty()) history_ = std::max(history_, lags_[c].back());
  }
}

int LagLayout::find(LaggedChannel column) const {
  if (column.channel == kConstantChannel) return 0;
  const auto& lags = lags_[column.channel];
  const auto place = std::lower_bound(lags.begin(), lags.end(), column.lag);
  if (place == lags.end() || *place != column.lag) return -1;
  return first_[column.channel] + static_cast<int>(place - lags.begin());
}

ChannelPoint operating_point(const ChannelSums& sums, double reference, ArxOffset offset) {
  // RMS relative to the mean below which a channel counts as constant: the variation is rounding.
  constexpr double kStandsStill = 1e-14;
  const double n = static_cast<double>(sums.count);
  const double shift = sums.sum / n;
  const double centre = reference + shift;
  const double variance = std::max(0.0, sums.square / n - shift * shift);
  const bool at_zero = offset == ArxOffset::kNone;
  const double rms = std::sqrt(at_zero ? variance + centre * centre : variance);
  const bool still = rms <= kStandsStill * std::abs(centre) || rms < std::numeric_limits<double>::min();
  return {at_zero ? 0.0 : centre, still ? 0.0 : std::ldexp(1.0, -std::ilogb(rms))};
}

Result<Signals> find_signals(std::span<const Recording> recordings, const ChannelChoice& channels) {
  if (recordings.empty()) return Error{"no recording was given"};
  if (channels.outputs.empty()) return Error{"no output channel was named"};
  Signals signals;
  signals.outputs = static_cast<int>(channels.outputs.size());
  signals.inputs = static_cast<int>(channels.inputs.size());
  signals.names = channels.outputs;
  signals.names.insert(signals.names.end(), channels.inputs.begin(), channels.inputs.end());
  if (auto ok = find_samples(recordings, signals); !ok) return ok.error();
  signals.offset.assign(signals.names.size(), 0.0);
  signals.scale.assign(signals.names.size(), 1.0);
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

Signals middle_of(const Signals& signals, std::size_t most) {
  const std::size_t total = total_rows(signals);
  Signals out = signals;
  for (std::size_t r = 0; total > most && r < out.samples.size(); ++r) {
    const std::size_t all = out.samples[r].front().size();
    // all · most may overflow the 32 bits of WebAssembly's size_t.
    const auto rows = static_cast<std::size_t>(std::uint64_t{all} * most / total), first = (all - rows) / 2;
    for (auto& samples : out.samples[r]) samples = samples.subspan(first, rows);
    for (Episode& episode : out.episodes[r]) {
      episode.begin = std::clamp(episode.begin, first, first + rows) - first;
      episode.end = std::clamp(episode.end, first, first + rows) - first;
    }
    std::erase_if(out.episodes[r], [](const Episode& episode) { return episode.size() == 0; });
  }
  return out;
}

RowPlan plan_rows(const Signals& signals, const LagLayout& layout, int first_sample) {
  RowPlan plan{{.first_sample = first_sample}, {}};
  for (std::size_t r = 0; r < signals.samples.size(); ++r) plan_recording(signals, r, layout, 0, plan);
  return plan;
}

RowPlan plan_part(const Signals& signals, const LagLayout& layout, int first_sample, const RowPart& part) {
  RowPlan plan{{.first_sample = first_sample}, {}};
  const auto bad = unusable_rows(signals, 0, layout, 0);
  const auto within = [&](std::size_t row) { return row >= part.begin && row < part.end; };
  for (const Episode& episode : signals.episodes[0]) {
    const std::size_t first = episode.begin + static_cast<std::size_t>(first_sample);
    const bool too_short = episode.end <= first;
    if (!too_short && within(first)) ++plan.episodes_used;
    if (too_short && (within(episode.end) || (part.last && episode.end == part.end))) ++plan.episodes_skipped;
    if (too_short) continue;
    add_runs(plan, {0, std::max(first, part.begin), std::min(episode.end, part.end)}, bad);
  }
  return plan;
}

RowPlan plan_input_rows(const Signals& signals, std::size_t recording, const LagLayout& layout, int first_sample) {
  RowPlan plan{{.first_sample = first_sample}, {}};
  plan_recording(signals, recording, layout, signals.outputs, plan);
  return plan;
}

void ScaledBlock::load(const RowRun& rows) {
  rows_ = rows.end - rows.begin;
  const std::size_t begin = rows.begin - static_cast<std::size_t>(history_);
  const std::size_t length = rows_ + static_cast<std::size_t>(history_);
  // Series at equal offsets of a page would evict each other from the cache, so their stride is an odd number of lines.
  stride_ = (length + 15) / 16 * 16 + 8;
  samples_.resize(stride_ * static_cast<std::size_t>(signals_.channels()));
  for (int c = 0; c < signals_.channels(); ++c) {
    copy_scaled(signals_.samples[rows.recording][c].data() + begin, length, signals_.offset[c], signals_.scale[c],
                samples_.data() + static_cast<std::size_t>(c) * stride_);
  }
}

}  // namespace wisp
