#include "run/arx/switched_program.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "run/bank/model_hash.hpp"

namespace wisp {
namespace {

constexpr double kMostSum = 1e30;  // far below the largest float, so that no sum overflows

float kept(double value) { return std::abs(value) < kLeastCoefficient ? 0.0f : static_cast<float>(value); }

// What the numbers of each channel are multiples of: outputs, then regressors.
std::vector<double> channel_units(const Model& model) {
  std::vector<double> units;
  for (const Output& output : model.outputs) units.push_back(channel_scale(output.lowest, output.highest));
  for (const Input& input : model.inputs) {
    units.insert(units.end(), regressor_count(input.shape), channel_scale(input.lowest, input.highest));
  }
  return units;
}

// A number of every mode, and what it belongs to.
struct Weights {
  SwitchedTap tap;
  std::vector<float> of_mode;

  bool any() const {
    return std::any_of(of_mode.begin(), of_mode.end(), [](float weight) { return weight != 0; });
  }
};

// Everything in channel units, with what is zero in every mode left out.
struct Unrolled {
  std::vector<std::vector<Weights>> taps;    // per output
  std::vector<std::vector<Weights>> shocks;  // per output; tap.channel is which of the standard shocks
  std::vector<float> constant;               // outputs × modes
  std::vector<Weights> regions;
  std::vector<float> region_constant;

  static std::size_t count(const std::vector<std::vector<Weights>>& rows) {
    std::size_t all = 0;
    for (const auto& row : rows) all += row.size();
    return all;
  }
};

void keep(std::vector<Weights>& list, const SwitchedTap& tap, std::vector<float> of_mode) {
  Weights weights{tap, std::move(of_mode)};
  if (weights.any()) list.push_back(std::move(weights));
}

std::vector<Weights> unroll_taps(const SwitchedArxModel& model, const std::vector<double>& units, int i) {
  const ArxOrders& orders = model.orders;
  std::vector<Weights> taps;
  std::size_t at = 0;  // in the row of theta
  const auto add = [&](int channel, int lag, double sign) {
    std::vector<float> of_mode;
    for (const ArxMode& mode : model.modes) {
      of_mode.push_back(kept(sign * mode.theta[i][at] * units[channel] / units[i]));
    }
    ++at;
    keep(taps, {static_cast<std::uint32_t>(channel), static_cast<std::uint32_t>(lag)}, std::move(of_mode));
  };
  for (int j = 0; j < orders.outputs(); ++j) {
    for (int lag = 1; lag <= orders.na(i, j); ++lag) add(j, lag, -1);
  }
  for (int k = 0; k < orders.inputs(); ++k) {
    for (int l = 0; l < orders.nb(i, k); ++l) add(orders.outputs() + k, orders.nk(i, k) + l, 1);
  }
  return taps;
}

std::vector<Weights> unroll_shocks(const SwitchedArxModel& model, const std::vector<double>& units, int i) {
  const auto ny = static_cast<std::size_t>(model.orders.outputs());
  std::vector<Weights> shocks;
  for (int j = 0; j <= i; ++j) {
    std::vector<float> of_mode;
    for (const ArxMode& mode : model.modes) of_mode.push_back(kept(mode.shock[i * ny + j] / units[i]));
    keep(shocks, {static_cast<std::uint32_t>(j), 0}, std::move(of_mode));
  }
  return shocks;
}

// Only which function is largest matters, so all are divided by their largest weight.
void unroll_regions(const SwitchedArxModel& model, const std::vector<double>& units, Unrolled& out) {
  const auto samples = region_samples(model.orders);
  const std::size_t row = 1 + samples.size();
  std::vector<double> scaled(model.regions);
  double largest = 0;
  for (std::size_t k = 0; k < scaled.size(); ++k) {
    if (k % row != 0) {
      const RegionSample& sample = samples[k % row - 1];
      scaled[k] *= units[(sample.input ? model.orders.outputs() : 0) + sample.channel];
    }
    largest = std::max(largest, std::abs(scaled[k]));
  }
  const double factor = largest > 0 ? 1 / largest : 1;
  for (std::size_t k = 0; k < model.modes.size(); ++k) out.region_constant.push_back(kept(scaled[k * row] * factor));
  for (std::size_t s = 0; s < samples.size(); ++s) {
    std::vector<float> of_mode;
    for (std::size_t k = 0; k < model.modes.size(); ++k) of_mode.push_back(kept(scaled[k * row + 1 + s] * factor));
    const int channel = (samples[s].input ? model.orders.outputs() : 0) + samples[s].channel;
    keep(out.regions, {static_cast<std::uint32_t>(channel), static_cast<std::uint32_t>(samples[s].lag)},
         std::move(of_mode));
  }
}

Unrolled unroll(const Model& model, const SwitchedArxModel& switched) {
  const std::vector<double> units = channel_units(model);
  Unrolled out;
  for (int i = 0; i < switched.orders.outputs(); ++i) {
    out.taps.push_back(unroll_taps(switched, units, i));
    out.shocks.push_back(unroll_shocks(switched, units, i));
    for (const ArxMode& mode : switched.modes) out.constant.push_back(kept(mode.constant[i] / units[i]));
  }
  if (switched.switching == Switching::kRegions) unroll_regions(switched, units, out);
  return out;
}

void fill_rows(const Unrolled& unrolled, SwitchedProgram& program) {
  const auto modes = static_cast<std::size_t>(program.modes);
  std::uint32_t tap = 0, shock = 0;
  for (std::size_t i = 0; i < unrolled.taps.size(); ++i) {
    for (const Weights& weights : unrolled.taps[i]) {
      program.taps[tap] = weights.tap;
      std::copy_n(weights.of_mode.data(), modes, program.coefficients.data() + tap++ * modes);
    }
    program.row_end[i] = tap;
    for (const Weights& weights : unrolled.shocks[i]) {
      program.shock[shock] = weights.tap.channel;
      std::copy_n(weights.of_mode.data(), modes, program.shock_size.data() + shock++ * modes);
    }
    program.shock_end[i] = shock;
  }
}

void fill_regions(const Unrolled& unrolled, SwitchedProgram& program) {
  const std::size_t taps = unrolled.regions.size();
  for (std::size_t t = 0; t < taps; ++t) {
    program.region_taps[t] = unrolled.regions[t].tap;
    for (int k = 0; k < program.modes; ++k) program.region_weights[k * taps + t] = unrolled.regions[t].of_mode[k];
  }
}

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

double total(std::span<const float> numbers) {
  double sum = 0;
  for (float number : numbers) sum += std::abs(number);
  return sum;
}

}  // namespace

SwitchedProgram make_switched_program(const Model& model, const SwitchedArxModel& switched, Arena& arena) {
  const Unrolled unrolled = unroll(model, switched);
  SwitchedProgram program;
  program.outputs = switched.orders.outputs();
  program.regressors = switched.orders.inputs();
  program.depth = std::max(switched.orders.history() + 1, 2);
  program.modes = static_cast<int>(switched.modes.size());
  program.markov = switched.switching == Switching::kMarkov;
  const auto ny = static_cast<std::size_t>(program.outputs), modes = switched.modes.size();
  const std::size_t taps = Unrolled::count(unrolled.taps), shocks = Unrolled::count(unrolled.shocks);
  program.shocks = shocks;
  program.taps = arena.take<SwitchedTap>(taps);
  program.row_end = arena.take<std::uint32_t>(ny);
  program.coefficients = arena.take<float>(taps * modes);
  program.constant = arena.take<float>(ny * modes);
  program.shock = arena.take<std::uint32_t>(shocks);
  program.shock_end = arena.take<std::uint32_t>(ny);
  program.shock_size = arena.take<float>(shocks * modes);
  program.region_taps = arena.take<SwitchedTap>(unrolled.regions.size());
  program.region_weights = arena.take<float>(unrolled.regions.size() * modes);
  program.region_constant = arena.take<float>(unrolled.region_constant.size());
  program.thresholds = arena.take<std::uint32_t>(program.markov ? (modes + 1) * modes : 0);
  if (arena.measures()) return program;
  fill_rows(unrolled, program);
  fill_regions(unrolled, program);
  std::copy(unrolled.constant.begin(), unrolled.constant.end(), program.constant.begin());
  std::copy(unrolled.region_constant.begin(), unrolled.region_constant.end(), program.region_constant.begin());
  if (!program.markov) return program;
  for (std::size_t k = 0; k < modes; ++k) {
    fill_thresholds(std::span(switched.transitions).subspan(k * modes, modes), &program.thresholds[k * modes]);
  }
  fill_thresholds(switched.initial, &program.thresholds[modes * modes]);
  return program;
}

std::uint64_t hash_of(const SwitchedProgram& program, std::uint64_t before) {
  std::uint64_t hash = hash_number(static_cast<std::uint32_t>(program.depth), before);
  hash = hash_number(static_cast<std::uint32_t>(program.modes), hash);
  for (const auto taps : {program.taps, program.region_taps}) {
    for (const SwitchedTap& tap : taps) hash = hash_number(tap.lag, hash_number(tap.channel, hash));
  }
  for (const auto words : {program.row_end, program.shock, program.shock_end, program.thresholds}) {
    for (std::uint32_t word : words) hash = hash_number(word, hash);
  }
  for (const auto numbers :
       {program.coefficients, program.constant, program.shock_size, program.region_weights, program.region_constant}) {
    hash = hash_floats(numbers, hash);
  }
  return hash;
}

Result<void> check_switched_program(const Model& model, const SwitchedArxModel& switched) {
  const Unrolled unrolled = unroll(model, switched);
  double sum = total(unrolled.constant);
  for (const auto* rows : {&unrolled.taps, &unrolled.shocks}) {
    for (const auto& row : *rows) {
      for (const Weights& weights : row) sum += total(weights.of_mode);
    }
  }
  if (sum < kMostSum) return {};
  return Error{"the coefficients of all modes add up to " + std::to_string(sum) +
               " in units of the channels' ranges, expected less than 1e30: learn the model again"};
}

}  // namespace wisp
