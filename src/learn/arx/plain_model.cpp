#include "learn/arx/plain_model.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "learn/fit/arx_fit.hpp"
#include "learn/rows/arx_rows.hpp"
#include "record/number_text.hpp"

namespace wisp::arx {
namespace {

constexpr double kMinRange = 1e-120;  // minimum range of a channel; 1 / this: maximum magnitude. Keeps squares in range

ChannelSpan span_of(const std::string& name, std::span<const Recording> recordings) {
  ChannelSpan span;
  bool first = true;
  for (const Recording& recording : recordings) {
    const Channel& found = recording.channels[*find_channel(recording, name)];
    if (span.unit.empty()) span.unit = found.unit;
    for (double sample : found.samples) {
      if (std::isnan(sample)) continue;
      span.lowest = first ? sample : std::min(span.lowest, sample);
      span.highest = first ? sample : std::max(span.highest, sample);
      first = false;
    }
  }
  return span;
}

OrderMatrix matrix_of(const OrderChoice& choice, std::size_t rows, std::size_t columns) {
  if (const auto* matrix = std::get_if<OrderMatrix>(&choice)) return *matrix;
  return OrderMatrix(static_cast<int>(rows), static_cast<int>(columns), std::get<int>(choice));
}

// Text of an order matrix: one number where all entries are equal, otherwise row by row, as in "4,2;3,4".
std::string text_of(const OrderMatrix& orders) {
  const auto values = orders.values();
  if (std::adjacent_find(values.begin(), values.end(), std::not_equal_to<>()) == values.end()) {
    return values.empty() ? "0" : std::to_string(values.front());
  }
  std::string text;
  for (int i = 0; i < orders.rows(); ++i) {
    for (int j = 0; j < orders.columns(); ++j) {
      text += (j > 0 ? "," : i > 0 ? ";" : "") + std::to_string(orders(i, j));
    }
  }
  return text;
}

}  // namespace

Result<void> check_size(const std::string& name, const ChannelSpan& span) {
  const double size = std::max(std::abs(span.lowest), std::abs(span.highest)), range = span.highest - span.lowest;
  const bool tiny = range > 0 && range<kMinRange, huge = size> 1 / kMinRange;
  if (!tiny && !huge) return {};
  return Error{"channel '" + name + "' reaches from " + number_text(span.lowest, 6) + " to " +
               number_text(span.highest, 6) + ", whose squares no number holds: give it in another unit, near 1"};
}

Result<Sources> sources_of(std::span<const Recording> recordings, const ChannelChoice& channels) {
  if (const auto found = find_signals(recordings, channels); !found) return found.error();
  Sources sources{.rate_hz = recordings.front().rate_hz};
  for (const auto* names : {&channels.outputs, &channels.inputs}) {
    for (const std::string& name : *names) {
      sources.spans.push_back(span_of(name, recordings));
      if (auto ok = check_size(name, sources.spans.back()); !ok) {
        return Error{recordings.front().source + ": " + ok.error().message};
      }
    }
  }
  for (const Recording& recording : recordings) sources.files.push_back(recording.source);
  return sources;
}

Model plain_model(const std::string& name, const ChannelChoice& channels, const Sources& sources) {
  Model model;
  model.name = name;
  model.rate_hz = sources.rate_hz;
  auto span = sources.spans.begin();
  for (const std::string& output : channels.outputs) {
    model.outputs.push_back({.name = output, .unit = span->unit, .lowest = span->lowest, .highest = span->highest});
    ++span;
  }
  for (const std::string& input : channels.inputs) {
    model.inputs.push_back({.name = input, .unit = span->unit, .lowest = span->lowest, .highest = span->highest});
    ++span;
  }
  for (const std::string& file : sources.files) {
    model.training.sources.push_back(std::filesystem::path(file).filename().string());
  }
  model.training.inputs.assign(model.inputs.size(), {});
  return model;
}

std::vector<Recording> about_own_levels(std::span<const Recording> recordings, const ChannelChoice& channels,
                                        std::vector<double> means) {
  std::vector<Recording> out(recordings.begin(), recordings.end());
  std::size_t place = 0;
  for (const auto* names : {&channels.outputs, &channels.inputs}) {
    for (const std::string& name : *names) {
      std::vector<ChannelSums> sums(out.size());
      ChannelSums all;
      for (std::size_t r = 0; r < out.size(); ++r) {
        for (double x : out[r].channels[*find_channel(out[r], name)].samples) {
          if (!std::isnan(x)) sums[r].sum += x, ++sums[r].count;
        }
        all.sum += sums[r].sum, all.count += sums[r].count;
      }
      const double level = means.empty() ? all.sum / double(all.count) : means[place];
      for (std::size_t r = 0; r < out.size(); ++r) {
        if (sums[r].count == 0) continue;
        for (double& x : out[r].channels[*find_channel(out[r], name)].samples)
          x += level - sums[r].sum / double(sums[r].count);
      }
      ++place;
    }
  }
  return out;
}

Recording seen_by(const Model& model, const Recording& recording, std::vector<double>* moved) {
  const ChannelChoice channels = channels_of(model);
  Recording seen = recording;
  if (moved) moved->assign(channels.outputs.size(), 0.0);
  if (!model.training.own_levels) return seen;
  const auto& arx = std::get<ArxModel>(model.dynamics);
  std::vector<double> means = arx.output_mean;
  means.insert(means.end(), arx.input_mean.begin(), arx.input_mean.end());
  Recording level = about_own_levels({&seen, 1}, channels, std::move(means)).front();
  for (std::size_t i = 0; moved && i < moved->size(); ++i) {
    const std::size_t channel = *find_channel(seen, channels.outputs[i]);
    const auto &before = seen.channels[channel].samples, &after = level.channels[channel].samples;
    for (std::size_t t = 0; t < before.size(); ++t) {
      if (!std::isnan(before[t])) (*moved)[i] = after[t] - before[t];
    }
  }
  return level;
}

ChannelChoice channels_of(const Model& model) {
  ChannelChoice channels;
  for (const Input& input : model.inputs) channels.inputs.push_back(input.name);
  for (const Output& output : model.outputs) channels.outputs.push_back(output.name);
  return channels;
}

Result<ArxOrders> orders_of(const OrderChoice& na, const OrderChoice& nb, const OrderChoice& nk, Coupling coupling,
                            const ChannelChoice& channels) {
  const std::size_t ny = channels.outputs.size(), nu = channels.inputs.size();
  if (ny == 0) return Error{"no output channel was named"};
  ArxOrders orders{matrix_of(na, ny, ny), matrix_of(nb, ny, nu), matrix_of(nk, ny, nu)};
  if (auto ok = check_orders(orders, channels); !ok) return ok.error();
  const ArxOrders mask =
      make_orders({.outputs = static_cast<int>(ny), .inputs = 0, .na = 1, .nb = 0, .nk = 0, .coupling = coupling});
  for (int i = 0; i < orders.outputs(); ++i) {
    for (int j = 0; j < orders.outputs(); ++j) {
      if (mask.na(i, j) == 0) orders.na(i, j) = 0;
    }
  }
  return orders;
}

std::vector<Note> order_notes(const ArxOrders& orders, Coupling coupling) {
  return {{"na", text_of(orders.na)},
          {"nb", text_of(orders.nb)},
          {"nk", text_of(orders.nk)},
          {"coupling", std::string(word_of(coupling))}};
}

}  // namespace wisp::arx
