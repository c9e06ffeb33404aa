// Physics against the model that was learned from it, in one run: what a frame costs either way.
//
// Both on one thread, by this thread's processor time. The rig simulates, the model steps with noise and gives its
// outline as 33 points, which is what a game would draw.

#include <cstdio>
#include <cstdlib>
#include <ctime>

#include "learn/outline/outline_fit.hpp"
#include "simulate/candle/candle_rig.hpp"
#include "studies/flame/verify_flame.hpp"
#include "wisp/run/bank.hpp"
#include "wisp/run/cost.hpp"
#include "wisp/simulate/candle_clip.hpp"

namespace {

using namespace wisp;

double processor_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

// A wind that swings between calm and 1 m/s, so that nothing is left to rest.
double swinging(int frame) { return 0.5 + 0.5 * ((frame / 15) % 2 == 0 ? 1 : -1) * ((frame % 15) / 15.0); }

double rig_seconds_a_frame() {
  constexpr int kFrames = 180;
  CandleRig rig = *CandleRig::create({});
  for (int frame = 0; frame < 60; ++frame) rig.step_frame(0);
  const double start = processor_seconds();
  for (int frame = 0; frame < kFrames; ++frame) rig.step_frame(swinging(frame));
  return (processor_seconds() - start) / kFrames;
}

double model_seconds_a_frame(const Model& model, int instances) {
  constexpr int kPoints = 33;
  const int frames = 2000000 / (instances + 20);
  auto bank = Bank::create(model, {.capacity = instances, .polyline_points = kPoints});
  if (!bank) std::abort();
  for (int k = 0; k < instances; ++k) bank->spawn();
  std::vector<float> points(static_cast<std::size_t>(instances) * 2 * kPoints);
  const double start = processor_seconds();
  for (int frame = 0; frame < frames; ++frame) {
    const float wind = static_cast<float>(swinging(frame));
    bank->set_common_inputs({&wind, 1});
    bank->step();
    bank->polylines(points);
  }
  return (processor_seconds() - start) / (static_cast<double>(frames) * instances);
}

}  // namespace

int main() {
  const auto clip = verify::make_flame_clip(20, 1);
  const auto fit = fit_outline(std::vector{verify::driven_by_sound(clip, WindMeasure::kSpeed)});
  if (!fit) {
    std::fprintf(stderr, "%s\n", fit.error().message.c_str());
    return 1;
  }
  const auto cost = count_operations(fit->model).value();
  std::printf("model: %lld multiply-adds a frame, %lld operations with noise\n",
              static_cast<long long>(cost.multiply_adds_per_frame), static_cast<long long>(cost.operations_per_frame));
  const double rig = rig_seconds_a_frame();
  std::printf("a frame of the rig:   %8.2f ms\n", 1e3 * rig);
  for (int instances : {1, 64, 4096}) {
    const double model = model_seconds_a_frame(fit->model, instances);
    std::printf("a frame of the model: %8.3f µs each in a bank of %4d: %.3g times faster\n", 1e6 * model, instances,
                rig / model);
  }
  return 0;
}
