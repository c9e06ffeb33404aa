// Identification: the cases of bench/peers/arx.py, on the data that it wrote (WISP_BENCH_DATA names the folder), or on
// data made here where there is none.

#include <benchmark/benchmark.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "learn/choose/order_search.hpp"
#include "learn/judge/judged_fit.hpp"
#include "learn/judge/prediction.hpp"
#include "learn/rows/arx_design.hpp"

namespace wisp {
namespace {

// A file of rows of doubles, one column a channel.
Recording read_raw(const std::string& file, const std::vector<std::string>& names, std::size_t rows) {
  Recording recording;
  recording.rate_hz = 60;
  for (const std::string& name : names) {
    recording.channels.push_back({name, "", name.front() == 'u' ? Role::kInput : Role::kOutput, {}});
  }
  const char* folder = std::getenv("WISP_BENCH_DATA");
  std::mt19937 generator(1);
  std::normal_distribution<double> normal;
  std::ifstream stream;
  if (folder != nullptr) stream.open(std::filesystem::path(folder) / file, std::ios::binary);
  for (std::size_t t = 0; t < rows; ++t) {
    for (Channel& channel : recording.channels) {
      double sample = normal(generator);
      if (folder != nullptr && !stream.read(reinterpret_cast<char*>(&sample), sizeof sample)) {
        throw std::runtime_error("cannot read " + file + " in WISP_BENCH_DATA");
      }
      channel.samples.push_back(sample);
    }
  }
  return recording;
}

const Recording& coupled() {
  static const Recording recording = read_raw("mimo100k.bin", {"u1", "y1", "y2"}, 100000);
  return recording;
}

const Recording& single() {
  static const Recording recording = read_raw("siso100k.bin", {"u1", "y1"}, 100000);
  return recording;
}

ArxFit fit(const Recording& recording, const ChannelChoice& channels, const ArxOptions& options) {
  auto result = fit_arx({&recording, 1}, channels, options);
  if (!result) throw std::runtime_error(result.error().message);
  return std::move(*result);
}

void fit_two_outputs(benchmark::State& state) {
  ArxOptions options;
  options.orders = make_orders({.outputs = 2, .inputs = 1, .na = 4, .nb = 4, .nk = 1});
  options.judge_free_run = state.range(0) != 0;
  for (auto _ : state) benchmark::DoNotOptimize(fit(coupled(), {{"u1"}, {"y1", "y2"}}, options));
}
BENCHMARK(fit_two_outputs)->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);

void fit_one_output(benchmark::State& state) {
  ArxOptions options;
  options.orders = make_orders({.outputs = 1, .inputs = 1, .na = 4, .nb = 4, .nk = 2});
  options.judge_free_run = false;
  for (auto _ : state) benchmark::DoNotOptimize(fit(single(), {{"u1"}, {"y1"}}, options));
}
BENCHMARK(fit_one_output)->Unit(benchmark::kMillisecond);

void fit_bank_of_8(benchmark::State& state) {
  static const Recording all = read_raw("bank8.bin", {"u1", "y1", "y2"}, 8 * 3000);
  std::vector<Recording> bank;
  for (std::size_t k = 0; k < 8; ++k) bank.push_back(slice(all, k * 3000, (k + 1) * 3000));
  ArxOptions options;
  options.orders = make_orders({.outputs = 2, .inputs = 1, .na = 4, .nb = 4, .nk = 1});
  options.judge_free_run = false;
  for (auto _ : state) {
    for (const Recording& one : bank) benchmark::DoNotOptimize(fit(one, {{"u1"}, {"y1", "y2"}}, options));
  }
}
BENCHMARK(fit_bank_of_8)->Unit(benchmark::kMillisecond);

void prediction_errors_of_20_steps(benchmark::State& state) {
  ArxOptions options;
  options.orders = make_orders({.outputs = 1, .inputs = 1, .na = 4, .nb = 4, .nk = 2});
  const ArxFit known = fit(single(), {{"u1"}, {"y1"}}, options);
  FigureOptions figures;
  figures.steps.clear();
  for (int k = 1; k <= 20; ++k) figures.steps.push_back(k);
  for (auto _ : state) {
    benchmark::DoNotOptimize(prediction_figures(known.model, {&single(), 1}, {{"u1"}, {"y1"}}, figures));
  }
}
BENCHMARK(prediction_errors_of_20_steps)->Unit(benchmark::kMillisecond);

void search_400_structures(benchmark::State& state) {
  static const Recording estimation = slice(single(), 0, 50000);
  static const Recording validation = slice(single(), 50000, 100000);
  SearchOptions options;
  options.by = OrderCriterion::kValidation;
  for (auto _ : state) {
    benchmark::DoNotOptimize(search_orders({&estimation, 1}, {&validation, 1}, {{"u1"}, {"y1"}}, options));
  }
}
BENCHMARK(search_400_structures)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace wisp
