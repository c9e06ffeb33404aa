#include "run/arx/mode_program.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "run/arx/arx_program.hpp"
#include "run/state/model_hash.hpp"

namespace wisp {
namespace {

// The affine functions of all modes in channel units.
struct Regions {
  std::vector<ModeWeights> taps;
  std::vector<float> constant;
};

// Only which function is largest matters, so all are divided by their largest weight.
Regions regions_of(const Model& model, const SwitchedArxModel& switched) {
  const std::vector<double> units = channel_units(model);
  const auto samples = region_samples(switched.orders);
  const std::size_t row = 1 + samples.size(), modes = switched.modes.size();
  const auto channel = [&](const RegionSample& sample) {
    return (sample.input ? switched.orders.outputs() : 0) + sample.channel;
  };
  std::vector<double> scaled(switched.regions);
  double largest = 0;
  for (std::size_t k = 0; k < scaled.size(); ++k) {
    if (k % row != 0) scaled[k] *= units[channel(samples[k % row - 1])];
    largest = std::max(largest, std::abs(scaled[k]));
  }
  const double factor = largest > 0 ? 1 / largest : 1;
  Regions out;
  for (std::size_t k = 0; k < modes; ++k) out.constant.push_back(kept(scaled[k * row] * factor));
  for (std::size_t s = 0; s < samples.size(); ++s) {
    ModeWeights weights{
        static_cast<std::uint32_t>(channel(samples[s])), static_cast<std::uint32_t>(samples[s].lag), {}};
    for (std::size_t k = 0; k < modes; ++k) weights.of_mode.push_back(kept(scaled[k * row + 1 + s] * factor));
    keep(out.taps, std::move(weights));
  }
  return out;
}

void fill_regions(const Regions& regions, ModeProgram& program) {
  const std::size_t taps = regions.taps.size();
  std::copy(regions.constant.begin(), regions.constant.end(), program.region_constant.begin());
  for (std::size_t t = 0; t < taps; ++t) {
    program.region_taps[t] = {regions.taps[t].channel, regions.taps[t].lag};
    for (int k = 0; k < program.modes; ++k) program.region_weights[k * taps + t] = regions.taps[t].of_mode[k];
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

void fill_thresholds(const SwitchedArxModel& switched, ModeProgram& program) {
  const std::size_t modes = switched.modes.size();
  for (std::size_t k = 0; k < modes; ++k) {
    fill_thresholds(std::span(switched.transitions).subspan(k * modes, modes), &program.thresholds[k * modes]);
  }
  fill_thresholds(switched.initial, &program.thresholds[modes * modes]);
}

}  // namespace

ModeProgram make_mode_program(const Model& model, const SwitchedArxModel& switched, Arena& arena) {
  ModeProgram program;
  const std::size_t modes = switched.modes.size();
  program.modes = static_cast<int>(modes);
  program.outputs = switched.orders.outputs();
  program.markov = switched.switching == Switching::kMarkov;
  const Regions regions = program.markov ? Regions() : regions_of(model, switched);
  program.region_taps = arena.take<RegionTap>(regions.taps.size());
  program.region_weights = arena.take<float>(regions.taps.size() * modes);
  program.region_constant = arena.take<float>(regions.constant.size());
  program.thresholds = arena.take<std::uint32_t>(program.markov ? (modes + 1) * modes : 0);
  if (arena.measures()) return program;
  fill_regions(regions, program);
  if (program.markov) fill_thresholds(switched, program);
  return program;
}

std::uint64_t hash_of(const ModeProgram& program, std::uint64_t before) {
  std::uint64_t hash = hash_number(static_cast<std::uint32_t>(program.modes), before);
  for (const RegionTap& tap : program.region_taps) hash = hash_number(tap.lag, hash_number(tap.channel, hash));
  for (std::uint32_t word : program.thresholds) hash = hash_number(word, hash);
  for (const auto numbers : {program.region_weights, program.region_constant}) hash = hash_floats(numbers, hash);
  return hash;
}

}  // namespace wisp
