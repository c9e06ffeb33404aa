// What a step of a flame costs, alone and in banks of up to 2^20, beside what the machine can do at most: multiply and
// add, and move memory; and an order-4 filter for 10^6 steps beside the plain loop in double that a peer's library runs
// (bench/peers/run.py times SciPy's). bench/run_table.py makes one table of all, at every width of vectors.

#include <benchmark/benchmark.h>

#include <cstdint>
#include <random>
#include <stdexcept>
#include <vector>

#include "run/flame_model.hpp"
#include "wisp/model/file.hpp"
#include "wisp/run/bank.hpp"

namespace wisp {
namespace {

using benchmark::Counter;

constexpr int kFilterSteps = 1'000'000;

// Processor time of one instance in one iteration.
void per_instance(benchmark::State& state, std::int64_t instances) {
  const double work = static_cast<double>(state.iterations() * instances) * 1e-9;
  state.counters["ns_each"] = Counter(work, Counter::kIsRate | Counter::kInvert);
}

Bank full_bank(const Model& model, int capacity) {
  auto bank = Bank::create(model, {.capacity = capacity});
  if (!bank) throw std::runtime_error(bank.error().message);
  for (int k = 0; k < capacity; ++k) bank->spawn();
  return std::move(bank).value();
}

// Wind in, one step; nothing is read.
void step_flames(benchmark::State& state, const Model& model, int instances, float noise) {
  Bank bank = full_bank(model, instances);
  bank.set_noise(noise);
  const std::vector<float> wind(instances, 0.3f);
  for (auto _ : state) {
    bank.set_inputs(wind);
    bank.step();
  }
  per_instance(state, instances);
}

void flame_step(benchmark::State& state) {
  step_flames(state, flame_model({.wind = InputShape::kEvenOdd}), static_cast<int>(state.range(0)),
              static_cast<float>(state.range(1)));
}
BENCHMARK(flame_step)->ArgNames({"flames", "noise"})->ArgsProduct({{1, 8, 64, 1024, 16384, 131072, 1048576}, {0, 1}});

// So many steps in one call, with noise, in a wind that stays.
void flame_steps(benchmark::State& state) {
  const auto instances = static_cast<int>(state.range(0)), count = static_cast<int>(state.range(1));
  Bank bank = full_bank(flame_model({.wind = InputShape::kEvenOdd}), instances);
  bank.set_inputs(std::vector<float>(instances, 0.3f));
  for (auto _ : state) bank.step(count);
  per_instance(state, std::int64_t{instances} * count);
}
BENCHMARK(flame_steps)->ArgNames({"flames", "steps"})->ArgsProduct({{1024, 1048576}, {1, 4, 16}});

// A frame at 60 Hz of flames far away, whose model makes fewer steps a second: between them they are interpolated.
void flame_far(benchmark::State& state) {
  const auto instances = static_cast<int>(state.range(0));
  Model model = flame_model({.wind = InputShape::kEvenOdd});
  model.rate_hz = static_cast<double>(state.range(1));
  Bank bank = full_bank(model, instances);
  const std::vector<float> wind(instances, 0.3f);
  for (auto _ : state) {
    bank.set_inputs(wind);
    bank.advance(std::chrono::nanoseconds(16'666'667));
  }
  per_instance(state, instances);
}
BENCHMARK(flame_far)->ArgNames({"flames", "rate"})->ArgsProduct({{1024, 1048576}, {60, 15}});

// As wisp learn flame makes them.
void default_flame_step(benchmark::State& state) {
  step_flames(state, default_flame_model(), static_cast<int>(state.range(0)), 1.0f);
}
BENCHMARK(default_flame_step)->ArgName("flames")->Arg(1)->Arg(1024);

// The machine's limits. Products and sums apart, as the library has them: twelve sums that wait for nothing but
// themselves, in vectors of so many bytes.
template <int bytes>
inline __attribute__((always_inline)) void multiply_add(benchmark::State& state) {
  using Vector = float __attribute__((vector_size(bytes)));
  constexpr int kSums = 12, kRounds = 1000;
  Vector sum[kSums] = {}, factor = Vector{} + 0.999f, more = Vector{} + 0.5f;
  for (auto _ : state) {
    for (int round = 0; round < kRounds; ++round) {
#pragma GCC unroll 12
      for (int k = 0; k < kSums; ++k) sum[k] = sum[k] * factor + more;
    }
    benchmark::DoNotOptimize(sum);
  }
  const double operations = 2.0 * kSums * kRounds * bytes / 4 * static_cast<double>(state.iterations());
  state.counters["operations"] = Counter(operations, Counter::kIsRate);
}
void limit_baseline(benchmark::State& state) { multiply_add<16>(state); }
BENCHMARK(limit_baseline);
#ifdef __x86_64__
__attribute__((target("avx2"))) void limit_avx2(benchmark::State& state) { multiply_add<32>(state); }
const int limits = [] {
  if (__builtin_cpu_supports("avx2")) benchmark::RegisterBenchmark("limit_avx2", limit_avx2);
  return 0;
}();
#endif

// a = b + s·c over arrays that no cache holds.
void limit_triad(benchmark::State& state) {
  constexpr std::size_t kSize = std::size_t{1} << 24;
  std::vector<float> a(kSize), b(kSize, 1.0f), c(kSize, 2.0f);
  for (auto _ : state) {
    for (std::size_t k = 0; k < kSize; ++k) a[k] = b[k] + 3.0f * c[k];
    benchmark::DoNotOptimize(a.data());
  }
  state.SetBytesProcessed(static_cast<std::int64_t>(3 * sizeof(float) * kSize) * state.iterations());
}
BENCHMARK(limit_triad)->Unit(benchmark::kMillisecond);

// A game's whole frame at 60 Hz: wind in, time passes, polylines of 32 points out.
void flame_frame(benchmark::State& state) {
  const auto instances = static_cast<int>(state.range(0));
  Bank bank = full_bank(flame_model({.wind = InputShape::kEvenOdd}), instances);
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

// A frame of the page's flame, in the plane and in the round: wind in, a step, polylines of 32 points out.
void shipped_frame(benchmark::State& state) {
  const auto instances = static_cast<int>(state.range(0));
  Model model = read_model(WISP_SOURCE_DIR "/apps/web/public/models/flame.wisp").value();
  if (state.range(1) != 0) model = in_the_round(model).value();
  Bank bank = full_bank(model, instances);
  std::vector<float> wind(static_cast<std::size_t>(instances) * model.inputs.size());
  std::vector<float> outlines(static_cast<std::size_t>(instances) * bank.polyline_points() * 2);
  int frame = 0;
  for (auto _ : state) {
    // A breath that comes and goes.
    std::fill(wind.begin(), wind.end(), ++frame % 120 < 40 ? 0.3f : 0.0f);
    bank.set_inputs(wind);
    bank.step();
    bank.polylines(outlines);
    benchmark::DoNotOptimize(outlines.data());
  }
  per_instance(state, instances);
}
BENCHMARK(shipped_frame)->ArgNames({"flames", "round"})->ArgsProduct({{1, 1000}, {0, 1}});

// The flame of flame_step as one writes it at first: rings with a modulo, loops over all outputs, double precision.
void flame_step_plain(benchmark::State& state) {
  const Model model = flame_model({.wind = InputShape::kEvenOdd});
  const auto& arx = std::get<ArxModel>(model.dynamics);
  const int ny = arx.orders.outputs(), nu = arx.orders.inputs();
  constexpr int kDepth = 5;
  std::vector<double> y(kDepth * ny), u(kDepth * nu);
  std::mt19937 generator(1);
  std::normal_distribution<double> normal;
  int now = 0;
  for (auto _ : state) {
    now = (now + 1) % kDepth;
    u[now * nu] = 0.3 - arx.input_mean[0];
    u[now * nu + 1] = -arx.input_mean[1];
    for (int i = 0; i < ny; ++i) {
      double sum = arx.constant[i] + (state.range(0) ? arx.noise.sd[i] * normal(generator) : 0.0);
      for (int j = 0; j < ny; ++j) {
        int lag = 1;
        for (double a : arx.a(i, j)) sum -= a * y[(now + kDepth - lag++) % kDepth * ny + j];
      }
      for (int k = 0; k < nu; ++k) {
        int lag = 0;
        for (double b : arx.b(i, k)) sum += b * u[(now + kDepth - lag++) % kDepth * nu + k];
      }
      y[now * ny + i] = sum;
    }
    benchmark::DoNotOptimize(y.data());
  }
  per_instance(state, 1);
}
BENCHMARK(flame_step_plain)->ArgName("noise")->Arg(0)->Arg(1);

constexpr double kFilterA[] = {-1.7, 0.85, 0.085, -0.105};
constexpr double kFilterB[] = {0.02, 0.015, -0.004, 0.002};

Model filter_model() {
  Model model;
  model.rate_hz = 60;
  model.inputs = {{"u", "", 0, 1, InputShape::kLinear}};
  model.outputs = {{"y", "", -1, 1}};
  ArxModel arx;
  arx.orders = {OrderMatrix(1, 1, 4), OrderMatrix(1, 1, 4), OrderMatrix(1, 1, 0)};
  arx.theta = {{std::begin(kFilterA), std::end(kFilterA)}};
  arx.theta[0].insert(arx.theta[0].end(), std::begin(kFilterB), std::end(kFilterB));
  arx.constant = arx.output_mean = arx.input_mean = {0};
  arx.noise.sd = {0.006};
  model.dynamics = arx;
  return model;
}

// 10^6 steps in all, every input set and every output read.
void filter(benchmark::State& state) {
  const auto instances = static_cast<int>(state.range(0));
  Bank bank = full_bank(filter_model(), instances);
  bank.set_noise(static_cast<float>(state.range(1)));
  std::vector<float> input(instances), output(instances);
  for (auto _ : state) {
    for (int step = 0; step < kFilterSteps / instances; ++step) {
      input[0] = static_cast<float>(step & 1);
      bank.set_inputs(input);
      bank.step();
      bank.outputs(output);
      benchmark::DoNotOptimize(output.data());
    }
  }
}
BENCHMARK(filter)->ArgNames({"instances", "noise"})->ArgsProduct({{1, 1000}, {0, 1}})->Unit(benchmark::kMillisecond);

// The same in one call.
void filter_at_once(benchmark::State& state) {
  Bank bank = full_bank(filter_model(), 1);
  bank.set_noise(static_cast<float>(state.range(0)));
  std::vector<float> input(kFilterSteps), output(kFilterSteps);
  for (int step = 0; step < kFilterSteps; ++step) input[step] = static_cast<float>(step & 1);
  for (auto _ : state) {
    bank.step(kFilterSteps, input, output);
    benchmark::DoNotOptimize(output.data());
  }
}
BENCHMARK(filter_at_once)->ArgName("noise")->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);

// The same by direct form II transposed in double, as SciPy's lfilter and Octave's filter do it.
void filter_plain(benchmark::State& state) {
  std::mt19937 generator(1);
  std::normal_distribution<double> normal;
  const bool noisy = state.range(0) != 0;
  for (auto _ : state) {
    double z[4] = {};
    for (int step = 0; step < kFilterSteps; ++step) {
      const double u = step & 1;
      const double e = noisy ? 0.006 * normal(generator) : 0.0;
      double y = z[0] + kFilterB[0] * u + e;
      for (int k = 0; k < 3; ++k) z[k] = z[k + 1] + kFilterB[k + 1] * u - kFilterA[k] * y;
      z[3] = -kFilterA[3] * y;
      benchmark::DoNotOptimize(y);
    }
  }
}
BENCHMARK(filter_plain)->ArgName("noise")->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace wisp
