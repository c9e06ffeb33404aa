// What a frame of a flame costs, alone and in banks, with noise and without, and what reading it costs.

#include <benchmark/benchmark.h>

#include <cstdlib>
#include <vector>

#include "run/flame_model.hpp"
#include "wisp/run/bank.hpp"

namespace wisp {
namespace {

using benchmark::Counter;
using benchmark::State;

void per_instance(State& state, std::int64_t instances) {
  state.counters["CPUns"] =
      Counter(static_cast<double>(state.iterations() * instances) * 1e-9, Counter::kIsRate | Counter::kInvert);
}

Bank full_bank(const Model& model, int capacity) {
  auto bank = Bank::create(model, {.capacity = capacity});
  if (!bank) std::abort();
  for (int k = 0; k < capacity; ++k) bank->spawn();
  return std::move(bank).value();
}

// Wind, step and nothing read.
void flame_step(State& state) {
  const auto instances = static_cast<int>(state.range(0));
  Bank bank = full_bank(flame_model({.wind = InputShape::kSplitSign}), instances);
  bank.set_noise(static_cast<float>(state.range(1)));
  const std::vector<float> wind(instances, 0.3f);
  for (auto _ : state) {
    bank.set_inputs(wind);
    bank.step();
  }
  per_instance(state, instances);
}
BENCHMARK(flame_step)->ArgNames({"flames", "noise"})->ArgsProduct({{1, 8, 100, 10000}, {0, 1}});

// A game's whole frame at 60 Hz: wind in, time passes, polylines out.
void flame_frame(State& state) {
  const auto instances = static_cast<int>(state.range(0));
  Bank bank = full_bank(flame_model({.wind = InputShape::kSplitSign}), instances);
  const std::vector<float> wind(instances, 0.3f);
  std::vector<float> outlines(static_cast<std::size_t>(instances) * bank.polyline_points() * 2);
  for (auto _ : state) {
    bank.set_inputs(wind);
    bank.advance(std::chrono::nanoseconds(16'666'667));
    bank.polylines(outlines);
    benchmark::DoNotOptimize(outlines.data());
  }
  per_instance(state, instances);
}
BENCHMARK(flame_frame)->ArgName("flames")->Arg(1)->Arg(100)->Arg(10000);

}  // namespace
}  // namespace wisp
