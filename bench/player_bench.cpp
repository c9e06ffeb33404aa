// What a frame costs through the C ABI: the native side of bindings/npm/bench.mjs, the same models and work.

#include <benchmark/benchmark.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "wisp/base/file.hpp"
#include "wisp/wisp.h"

namespace {

void need(wisp_status status) {
  if (status != WISP_OK) throw std::runtime_error(wisp_last_error());
}

// A full bank of one of the models of the C ABI's tests.
struct Lives {
  Lives(const std::string& name, uint32_t count) {
    const auto bytes = wisp::read_file(WISP_SOURCE_DIR "/tests/c/models/" + name + ".wisp");
    if (!bytes) throw std::runtime_error(bytes.error().message);
    wisp_model* model = nullptr;
    need(wisp_model_load(bytes->data(), bytes->size(), &model));
    wisp_bank_options options = wisp_bank_default_options();
    options.capacity = count;
    need(wisp_bank_create(model, &options, &bank));
    wisp_model_free(model);
    wisp_instance instance;
    for (uint32_t k = 0; k < count; ++k) need(wisp_bank_spawn(bank, &instance));
    wisp_bank_facts facts{};
    facts.size = sizeof facts;
    need(wisp_bank_get_facts(bank, &facts));
    wind.assign(facts.inputs, 0.3f);
    outputs.resize(std::size_t{count} * facts.outputs);
  }
  ~Lives() { wisp_bank_free(bank); }

  wisp_bank* bank = nullptr;
  std::vector<float> wind, outputs;
};

// Steps of 64 flames, wind in and nothing read.
void flame_steps(benchmark::State& state) {
  Lives flames("flame", 64);
  for (auto _ : state) {
    need(wisp_bank_set_common_inputs(flames.bank, flames.wind.data(), flames.wind.size()));
    need(wisp_bank_step(flames.bank));
  }
  state.counters["flame_steps"] =
      benchmark::Counter(static_cast<double>(64 * state.iterations()), benchmark::Counter::kIsRate);
}
BENCHMARK(flame_steps);

// A frame of 10 000 leaves at 60 frames a second, poses read.
void leaf_frames(benchmark::State& state) {
  Lives leaves("leaf", 10000);
  for (auto _ : state) {
    need(wisp_bank_set_common_inputs(leaves.bank, leaves.wind.data(), leaves.wind.size()));
    need(wisp_bank_advance(leaves.bank, 16666667, nullptr));
    need(wisp_bank_outputs(leaves.bank, leaves.outputs.data(), leaves.outputs.size()));
  }
}
BENCHMARK(leaf_frames)->Unit(benchmark::kMillisecond);

}  // namespace
