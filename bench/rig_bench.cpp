// What a simulated second costs: the rig's grids, and the camera and microphone that look on.
//
// Items are simulated seconds, so items per second above 1 is faster than life on one core.

#include <benchmark/benchmark.h>

#include <vector>

#include "wisp/simulate/candle_clip.hpp"

#include "simulate/candle/candle_rig.hpp"
#include "simulate/candle/flame_outline.hpp"
#include "simulate/candle/virtual_camera.hpp"
#include "simulate/candle/wind_signal.hpp"

namespace {

using namespace wisp;

// A second of wind that swings between calm and 1 m/s, so that nothing is left to rest.
double swinging(int frame) { return 0.5 + 0.5 * ((frame / 15) % 2 == 0 ? 1 : -1) * ((frame % 15) / 15.0); }

void BM_rig(benchmark::State& state) {
  CandleRig rig = *CandleRig::create({});
  for (int frame = 0; frame < 60; ++frame) rig.step_frame(0);
  for (auto _ : state)
    for (int frame = 0; frame < 60; ++frame) rig.step_frame(swinging(frame));
  state.SetItemsProcessed(state.iterations());
}

void BM_camera(benchmark::State& state) {
  CandleRig rig = *CandleRig::create({});
  for (int frame = 0; frame < 60; ++frame) rig.step_frame(0.5);
  VirtualCamera camera = *VirtualCamera::create({});
  std::uint64_t count = 0;
  for (auto _ : state)
    for (int frame = 0; frame < 60; ++frame) benchmark::DoNotOptimize(camera.picture(rig.light_of_frame(), count++));
  state.SetItemsProcessed(state.iterations());
}

void BM_outline(benchmark::State& state) {
  CandleRig rig = *CandleRig::create({});
  for (int frame = 0; frame < 60; ++frame) rig.step_frame(0.5);
  for (auto _ : state)
    for (int frame = 0; frame < 60; ++frame) benchmark::DoNotOptimize(flame_outline(rig.light_of_frame()));
  state.SetItemsProcessed(state.iterations());
}

void BM_microphone(benchmark::State& state) {
  VirtualMicrophone microphone = *VirtualMicrophone::create({});
  const std::vector<float> wind(44100, 0.5F);
  std::vector<float> sound(wind.size());
  for (auto _ : state) microphone.hear(wind, sound);
  state.SetItemsProcessed(state.iterations());
}

void BM_clip(benchmark::State& state) {
  CandleClipOptions options;
  options.seconds = 4;
  options.settle_seconds = 0;
  CandleClipOutputs outputs;
  outputs.on_frame = [](const CandleFrame&) -> Result<void> { return {}; };
  outputs.on_sound = [](std::span<const float>) -> Result<void> { return {}; };
  for (auto _ : state) benchmark::DoNotOptimize(simulate_candle(options, outputs));
  state.SetItemsProcessed(state.iterations() * 4);
}

BENCHMARK(BM_rig)->Unit(benchmark::kMillisecond);
BENCHMARK(BM_camera)->Unit(benchmark::kMillisecond);
BENCHMARK(BM_outline)->Unit(benchmark::kMillisecond);
BENCHMARK(BM_microphone)->Unit(benchmark::kMillisecond);
BENCHMARK(BM_clip)->Unit(benchmark::kMillisecond);

}  // namespace
