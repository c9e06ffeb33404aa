#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "run/arx/arx_program.hpp"
#include "run/arx/mode_lanes.hpp"
#include "run/arx/output_program.hpp"
#include "run/state/model_hash.hpp"

namespace wisp {
namespace {

using Taps = std::vector<ModeWeights>;
template <class Number>
using Row = std::array<Number, kOutputsAtOnce>;

// Outputs, by their numbers, whose taps differ in channels and coefficients alone.
using Group = std::vector<std::uint32_t>;

// Whether the taps of output b follow one another as those of a do: the same lags of the same kinds of channel.
// `aligned`: its own channel at the same places besides, so that the group's column of those is what it makes.
bool go_together(const Regression& regression, std::uint32_t a, std::uint32_t b, bool aligned) {
  const std::size_t outputs = regression.taps.size();
  const auto alike = [&](const ModeWeights& x, const ModeWeights& y) {
    const bool same_place = !aligned || (x.channel == a) == (y.channel == b);
    return x.lag == y.lag && (x.channel < outputs) == (y.channel < outputs) && same_place;
  };
  const Taps &ours = regression.taps[a], &theirs = regression.taps[b];
  return std::equal(ours.begin(), ours.end(), theirs.begin(), theirs.end(), alike);
}

std::vector<Group> groups_of(const Regression& regression, bool aligned) {
  std::vector<Group> groups;
  for (std::uint32_t i = 0; i < regression.taps.size(); ++i) {
    const auto takes = [&](const Group& group) {
      return group.size() < kOutputsAtOnce && go_together(regression, group.front(), i, aligned);
    };
    const auto group = std::find_if(groups.begin(), groups.end(), takes);
    if (group == groups.end()) {
      groups.push_back({i});
    } else {
      group->push_back(i);
    }
  }
  return groups;
}

// Aligned where that fills places: not where every output looks back at all others. None where most would be empty:
// a block's lanes may as well be.
std::vector<Group> groups_of(const Regression& regression) {
  if (regression.modes > 1) return {};
  for (const bool aligned : {true, false}) {
    std::vector<Group> groups = groups_of(regression, aligned);
    if (2 * groups.size() <= regression.taps.size()) return groups;
  }
  return {};
}

// A group's outputs; empty places are the first once more, so that its column is what others look back at.
Row<std::uint32_t> outputs_of(const Group& group) {
  Row<std::uint32_t> outputs;
  for (std::size_t place = 0; place < kOutputsAtOnce; ++place) outputs[place] = group[place < group.size() ? place : 0];
  return outputs;
}

// Where a channel's lanes begin in a block's sample.
Row<std::uint32_t> places_of(Row<std::uint32_t> channels) {
  for (std::uint32_t& channel : channels) channel *= kOutputsAtOnce;
  return channels;
}

// What a program consists of, before it is laid out.
struct Parts {
  std::vector<Row<std::uint32_t>> output, channel, shock, shock_place;
  std::vector<std::uint32_t> count, run_end, own, shock_end;
  std::vector<ColumnRun> runs;
  std::vector<ColumnSource> source;
  std::vector<Row<float>> coefficients, constant;
};

void add_taps(const Regression& regression, const Group& group, Parts& parts) {
  const Row<std::uint32_t> outputs = outputs_of(group);
  for (std::size_t k = 0; k < regression.taps[group[0]].size(); ++k) {
    Row<std::uint32_t> channels;
    Row<float> coefficients;
    for (std::size_t place = 0; place < kOutputsAtOnce; ++place) {
      const ModeWeights& tap = regression.taps[outputs[place]][k];
      channels[place] = tap.channel;
      coefficients[place] = tap.of_mode[0];
    }
    const auto found = std::find(parts.channel.begin(), parts.channel.end(), places_of(channels));
    const auto column = static_cast<std::uint32_t>(found - parts.channel.begin());
    if (found == parts.channel.end()) parts.channel.push_back(places_of(channels));
    const std::uint32_t lag = regression.taps[group[0]][k].lag;
    const auto continues = [&](const ColumnRun& run) {
      return run.column == column && run.first_lag == lag + run.count;
    };
    if (k == 0 || !continues(parts.runs.back())) parts.runs.push_back({column, lag, 0});
    ++parts.runs.back().count;
    parts.coefficients.push_back(coefficients);
  }
  parts.run_end.push_back(static_cast<std::uint32_t>(parts.runs.size()));
}

// The first shock of an output, by its place among all.
std::uint32_t first_shock(const Regression& regression, std::uint32_t output) {
  std::size_t first = 0;
  for (std::uint32_t i = 0; i < output; ++i) first += regression.shocks[i].size();
  return static_cast<std::uint32_t>(first);
}

// The shocks of a group's outputs, in their order; outputs that have fewer than others add 0 at the end.
void add_shocks(const Regression& regression, const Group& group, Parts& parts) {
  std::size_t most = 0;
  for (std::uint32_t output : group) most = std::max(most, regression.shocks[output].size());
  const Row<std::uint32_t> outputs = outputs_of(group);
  const std::uint32_t none = first_shock(regression, static_cast<std::uint32_t>(regression.shocks.size()));
  for (std::size_t k = 0; k < most; ++k) {
    Row<std::uint32_t> shock, place_of{};
    shock.fill(none);
    for (std::size_t place = 0; place < kOutputsAtOnce; ++place) {
      const auto& own = regression.shocks[outputs[place]];
      if (k >= own.size()) continue;
      shock[place] = first_shock(regression, outputs[place]) + static_cast<std::uint32_t>(k);
      place_of[place] = normal_place(own[k].channel);
    }
    parts.shock.push_back(shock);
    parts.shock_place.push_back(place_of);
  }
  parts.shock_end.push_back(static_cast<std::uint32_t>(parts.shock.size()));
}

// The columns that groups make themselves, and where the others come from.
void find_sources(const Regression& regression, Parts& parts) {
  parts.source.assign(parts.channel.size(), ColumnSource::kOutputs);
  for (std::size_t c = 0; c < parts.channel.size(); ++c) {
    const Row<std::uint32_t>& places = parts.channel[c];
    const bool one = std::count(places.begin(), places.end(), places[0]) == static_cast<long>(kOutputsAtOnce);
    if (places[0] >= regression.taps.size() * kOutputsAtOnce) {
      parts.source[c] = one ? ColumnSource::kOneRegressor : ColumnSource::kRegressors;
    } else if (one) {
      parts.source[c] = ColumnSource::kOneOutput;
    }
  }
  for (const Row<std::uint32_t>& output : parts.output) {
    const auto own = std::find(parts.channel.begin(), parts.channel.end(), places_of(output)) - parts.channel.begin();
    parts.own.push_back(static_cast<std::uint32_t>(own));
    if (own < static_cast<long>(parts.source.size())) parts.source[own] = ColumnSource::kGroup;
  }
}

Parts parts_of(const Regression& regression) {
  Parts parts;
  for (const Group& group : groups_of(regression)) {
    parts.count.push_back(static_cast<std::uint32_t>(group.size()));
    parts.output.push_back(outputs_of(group));
    Row<float>& constant = parts.constant.emplace_back();
    for (std::size_t k = 0; k < kOutputsAtOnce; ++k) constant[k] = regression.constant[outputs_of(group)[k]];
    add_taps(regression, group, parts);
    add_shocks(regression, group, parts);
  }
  find_sources(regression, parts);
  return parts;
}

template <class Number>
std::span<Number> laid_out(const std::vector<Number>& numbers, Arena& arena) {
  const auto out = arena.take<Number>(numbers.size());
  if (!arena.measures()) std::copy(numbers.begin(), numbers.end(), out.begin());
  return out;
}

template <class Number>
std::span<Number> laid_out(const std::vector<Row<Number>>& rows, Arena& arena) {
  std::vector<Number> numbers;
  for (const Row<Number>& row : rows) numbers.insert(numbers.end(), row.begin(), row.end());
  return laid_out(numbers, arena);
}

}  // namespace

OutputProgram make_output_program(const Regression& regression, Arena& arena) {
  const Parts parts = parts_of(regression);
  OutputProgram program;
  program.groups = parts.output.size();
  program.columns = parts.channel.size();
  program.shock_rows = parts.shock.size();
  program.output = laid_out(parts.output, arena);
  program.count = laid_out(parts.count, arena);
  program.run_end = laid_out(parts.run_end, arena);
  program.runs = laid_out(parts.runs, arena);
  program.channel = laid_out(parts.channel, arena);
  program.source = laid_out(parts.source, arena);
  program.own = laid_out(parts.own, arena);
  program.coefficients = laid_out(parts.coefficients, arena);
  program.constant = laid_out(parts.constant, arena);
  program.shock_end = laid_out(parts.shock_end, arena);
  program.shock = laid_out(parts.shock, arena);
  program.shock_place = laid_out(parts.shock_place, arena);
  return program;
}

namespace {

// Sums of probabilities as words. The last mode that can follow takes what rounding leaves over.
void fill_thresholds(std::span<const double> probabilities, std::uint32_t* thresholds) {
  double sum = 0;
  std::size_t last = 0;
  for (std::size_t k = 0; k < probabilities.size(); ++k) {
    if (probabilities[k] > 0) last = k;
  }
  for (std::size_t k = 0; k < probabilities.size(); ++k) {
    sum += probabilities[k];
    const double words = std::min(std::floor(sum * 4294967296.0), static_cast<double>(kAnyWord - 1));
    thresholds[k] = k >= last ? kAnyWord : static_cast<std::uint32_t>(words);
  }
}

}  // namespace

ModeProgram make_mode_program(const SwitchedArxModel& switched, Arena& arena) {
  const std::size_t modes = switched.modes.size();
  ModeProgram program{static_cast<int>(modes), switched.orders.outputs(),
                      arena.take<std::uint32_t>((modes + 1) * modes)};
  if (arena.measures()) return program;
  for (std::size_t k = 0; k < modes; ++k) {
    fill_thresholds(std::span(switched.transitions).subspan(k * modes, modes), &program.thresholds[k * modes]);
  }
  fill_thresholds(switched.initial, &program.thresholds[modes * modes]);
  return program;
}

std::uint64_t hash_of(const ModeProgram& program, std::uint64_t before) {
  std::uint64_t hash = hash_number(static_cast<std::uint32_t>(program.modes), before);
  for (std::uint32_t word : program.thresholds) hash = hash_number(word, hash);
  return hash;
}

}  // namespace wisp
