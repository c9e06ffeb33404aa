#include "run/arx/arx_program.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "run/state/model_hash.hpp"

namespace wisp {
namespace {

constexpr double kMaxSum = 1e30;  // far below the largest float, so that no sum overflows

// Coefficients of one mode, in the layout of ArxModel and ArxMode.
struct ModeRows {
  const std::vector<std::vector<double>>& theta;
  const std::vector<double>& constant;
};

// Returns the taps of output i: inputs, then past outputs, each channel's newest sample last, as it is computed last.
std::vector<ModeWeights> taps_of(const ArxOrders& orders, std::span<const ModeRows> modes,
                                 const std::vector<double>& units, int i) {
  std::vector<ModeWeights> taps;
  // `at`: index one past the channel's coefficients in the row of theta, where lags ascend.
  const auto add = [&](int channel, int first_lag, int count, double sign, std::size_t at) {
    for (int lag = first_lag + count - 1; lag >= first_lag; --lag) {
      ModeWeights weights{static_cast<std::uint32_t>(channel), static_cast<std::uint32_t>(lag), {}};
      --at;
      for (const ModeRows& mode : modes) {
        weights.of_mode.push_back(kept(sign * mode.theta[i][at] * units[channel] / units[i]));
      }
      keep(taps, std::move(weights));
    }
  };
  std::size_t past = 0, end = 0;  // within the row: coefficients of outputs come first
  for (int j = 0; j < orders.outputs(); ++j) end += static_cast<std::size_t>(orders.na(i, j));
  for (int k = 0; k < orders.inputs(); ++k) {
    end += static_cast<std::size_t>(orders.nb(i, k));
    add(orders.outputs() + k, orders.nk(i, k), orders.nb(i, k), 1, end);
  }
  for (int j = 0; j < orders.outputs(); ++j) {
    past += static_cast<std::size_t>(orders.na(i, j));
    add(j, 1, orders.na(i, j), -1, past);
  }
  return taps;
}

Regression regression_of(const ArxOrders& orders, std::span<const ModeRows> modes, const std::vector<double>& units) {
  Regression out;
  out.modes = static_cast<int>(modes.size());
  out.history = orders.history();
  out.regressors = orders.inputs();
  for (int i = 0; i < orders.outputs(); ++i) {
    out.taps.push_back(taps_of(orders, modes, units, i));
    for (const ModeRows& mode : modes) out.constant.push_back(kept(mode.constant[i] / units[i]));
  }
  return out;
}

std::size_t count(const std::vector<std::vector<ModeWeights>>& rows) {
  std::size_t all = 0;
  for (const auto& row : rows) all += row.size();
  return all;
}

bool continues(const TapRun& run, const ModeWeights& tap) {
  return run.channel == tap.channel && run.first_lag == tap.lag + run.count;
}

std::vector<TapRun> runs_of(const std::vector<ModeWeights>& taps, std::uint32_t first_coefficient) {
  std::vector<TapRun> runs;
  for (const ModeWeights& tap : taps) {
    if (runs.empty() || !continues(runs.back(), tap)) runs.push_back({tap.channel, tap.lag, 0, first_coefficient});
    ++runs.back().count;
    ++first_coefficient;
  }
  return runs;
}

std::size_t count_runs(const Regression& regression) {
  std::size_t all = 0;
  for (const auto& row : regression.taps) all += runs_of(row, 0).size();
  return all;
}

// Returns whether two outputs are sums over the same samples in the same order.
bool are_twins(const std::vector<ModeWeights>& a, const std::vector<ModeWeights>& b) {
  const auto same = [](const ModeWeights& x, const ModeWeights& y) { return x.channel == y.channel && x.lag == y.lag; };
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), same);
}

void fill_rows(const Regression& regression, ArxProgram& program) {
  auto coefficient = program.coefficients.begin(), size = program.shock_size.begin();
  std::uint32_t run = 0, tap = 0, shock = 0;
  for (std::size_t i = 0; i < regression.taps.size(); ++i) {
    for (const TapRun& one : runs_of(regression.taps[i], tap)) program.runs[run++] = one;
    for (const ModeWeights& one : regression.taps[i]) {
      coefficient = std::copy(one.of_mode.begin(), one.of_mode.end(), coefficient);
    }
    tap += static_cast<std::uint32_t>(regression.taps[i].size());
    program.row_end[i] = run;
    const bool twin = i + 1 < regression.taps.size() && are_twins(regression.taps[i], regression.taps[i + 1]);
    program.twin[i] = twin ? static_cast<std::uint32_t>(regression.taps[i].size()) : 0;
    for (const ModeWeights& one : regression.shocks[i]) {
      program.shock[shock++] = one.channel;
      size = std::copy(one.of_mode.begin(), one.of_mode.end(), size);
    }
    program.shock_end[i] = shock;
  }
  std::copy(regression.constant.begin(), regression.constant.end(), program.constant.begin());
}

ArxProgram lay_out(const Regression& regression, const ResampledProgram& resampled, Arena& arena) {
  ArxProgram program;
  program.outputs = static_cast<int>(regression.taps.size());
  program.regressors = regression.regressors;
  program.modes = regression.modes;
  program.resampled = resampled;
  program.depth = std::max(regression.history + 1, 2);
  const auto ny = static_cast<std::size_t>(program.outputs), modes = static_cast<std::size_t>(program.modes);
  program.shocks = count(regression.shocks);
  program.runs = arena.take<TapRun>(count_runs(regression));
  program.row_end = arena.take<std::uint32_t>(ny);
  program.twin = arena.take<std::uint32_t>(ny);
  program.coefficients = arena.take<float>(count(regression.taps) * modes);
  program.constant = arena.take<float>(ny * modes);
  program.shock = arena.take<std::uint32_t>(program.shocks);
  program.shock_end = arena.take<std::uint32_t>(ny);
  program.shock_size = arena.take<float>(program.shocks * modes);
  if (!arena.measures()) fill_rows(regression, program);
  return program;
}

double total(std::span<const float> numbers) {
  double sum = 0;
  for (float number : numbers) sum += std::abs(number);
  return sum;
}

// Returns the unit of each channel: outputs, then regressors.
std::vector<double> channel_units(const Model& model) {
  std::vector<double> units;
  for (const ValueRange& range : moved_ranges(model)) units.push_back(channel_scale(range.lowest, range.highest));
  const auto regressors = static_cast<int>(regressor_count(model.inputs));
  for (int k = 0; k < regressors; ++k) units.push_back(regressor_scale(model, k));
  return units;
}

}  // namespace

float kept(double value) { return std::abs(value) < kMinCoefficient ? 0.0f : static_cast<float>(value); }

void keep(std::vector<ModeWeights>& list, ModeWeights weights) {
  const auto counts = [](float weight) { return weight != 0; };
  if (std::any_of(weights.of_mode.begin(), weights.of_mode.end(), counts)) list.push_back(std::move(weights));
}

Regression regression_of(const Model& model, const ArxModel& arx) {
  const std::vector<double> units = channel_units(model);
  const ModeRows mode[] = {{arx.theta, arx.constant}};
  Regression out = regression_of(arx.orders, mode, units);
  for (int i = 0; i < arx.orders.outputs(); ++i) {
    keep(out.shocks.emplace_back(), {static_cast<std::uint32_t>(i), 0, {kept(arx.noise.sd[i] / units[i])}});
  }
  return out;
}

Regression regression_of(const Model& model, const SwitchedArxModel& switched) {
  const std::vector<double> units = channel_units(model);
  std::vector<ModeRows> modes;
  for (const ArxMode& mode : switched.modes) modes.push_back({mode.theta, mode.constant});
  Regression out = regression_of(switched.orders, modes, units);
  const auto ny = static_cast<std::size_t>(switched.orders.outputs());
  for (std::size_t i = 0; i < ny; ++i) {
    std::vector<ModeWeights>& shocks = out.shocks.emplace_back();
    for (std::size_t j = 0; j <= i; ++j) {
      ModeWeights weights{static_cast<std::uint32_t>(j), 0, {}};
      for (const ArxMode& mode : switched.modes) weights.of_mode.push_back(kept(mode.shock[i * ny + j] / units[i]));
      keep(shocks, std::move(weights));
    }
  }
  return out;
}

ArxProgram make_arx_program(const Model& model, const ArxModel& arx, Arena& arena) {
  return lay_out(regression_of(model, arx), make_resampled_program(model, arx, arena), arena);
}

ArxProgram make_arx_program(const Model& model, const SwitchedArxModel& switched, Arena& arena) {
  return lay_out(regression_of(model, switched), {}, arena);
}

std::uint64_t hash_of(const ArxProgram& program, std::uint64_t before) {
  std::uint64_t hash = hash_number(static_cast<std::uint32_t>(program.depth), before);
  hash = hash_number(static_cast<std::uint32_t>(program.modes), hash);
  for (const TapRun& run : program.runs) {
    for (std::uint32_t number : {run.channel, run.first_lag, run.count}) hash = hash_number(number, hash);
  }
  for (const auto words : {program.row_end, program.shock, program.shock_end}) {
    for (std::uint32_t word : words) hash = hash_number(word, hash);
  }
  for (const auto numbers : {program.coefficients, program.constant, program.shock_size}) {
    hash = hash_floats(numbers, hash);
  }
  return hash_of(program.resampled, hash);
}

Result<void> check_regression(const Regression& regression) {
  double sum = total(regression.constant);
  for (const auto* rows : {&regression.taps, &regression.shocks}) {
    for (const auto& row : *rows) {
      for (const ModeWeights& weights : row) sum += total(weights.of_mode);
    }
  }
  if (sum < kMaxSum) return {};
  return Error{"the ARX coefficients add up to " + std::to_string(sum) +
               " in units of the channels' ranges, expected less than 1e30: learn the model again"};
}

}  // namespace wisp
