// What a frame of a falling leaf costs: a learned chain's play against integrating the equations it was learned from,
// by the equations at one step a frame, all in one run on one core.

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <span>
#include <vector>

#include "learn/chain/learn_chain.hpp"
#include "simulate/leaf/leaf_flight.hpp"
#include "wisp/run/bank.hpp"
#include "wisp/run/cost.hpp"
#include "wisp/simulate/leaf_drops.hpp"

namespace wisp {
namespace {

constexpr double kFrame = 1.0 / 60;
constexpr double kPaperOperations = 9239;  // a frame of the paper's stiff integration
constexpr double kStepOperations = 1172;   // four right-hand sides of 243, and their sum
constexpr int kRepeats = 7;

template <class Value>
Value must(Result<Value> result) {
  if (result) return std::move(*result);
  std::fprintf(stderr, "%s\n", result.error().message.c_str());
  std::exit(1);
}

// Nanoseconds of processor time a frame: the median of several runs, which the machine's other work disturbs least.
double time_of(double frames, const std::function<void()>& work) {
  std::vector<double> times;
  for (int k = 0; k < kRepeats; ++k) {
    const std::clock_t start = std::clock();
    work();
    times.push_back(static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC / frames * 1e9);
  }
  std::sort(times.begin(), times.end());
  return times[kRepeats / 2];
}

Model learned(double blend) {
  const Recording drops = must(simulate_leaf_drops({.drops = 60}));
  LeafRecipe recipe;
  recipe.blend = blend;
  return must(learn_chain(std::span(&drops, 1), recipe)).model;
}

double time_played(const Model& model, int leaves) {
  Bank bank = must(Bank::create(model, {.capacity = leaves}));
  for (int k = 0; k < leaves; ++k) bank.spawn();
  std::vector<float> outputs(static_cast<std::size_t>(leaves) * 7);
  const int frames = 2'000'000 / leaves;
  return time_of(static_cast<double>(frames) * leaves, [&] {
    for (int frame = 0; frame < frames; ++frame) {
      bank.step();
      bank.outputs(outputs);
    }
  });
}

double time_integrated(int frames) {
  const LeafWind calm;
  LeafState start;
  start.attitude = {0.9, 0.3, 0.2, 0.1};
  start.spin = {1, 2, 3};
  LeafFlight flight = must(LeafFlight::begin({}, calm, start));
  if (!flight.advance(2)) std::exit(1);
  return time_of(frames, [&] {
    for (int frame = 0; frame < frames; ++frame) {
      if (!flight.advance(kFrame)) std::exit(1);
    }
  });
}

void print(const char* name, double nanoseconds, double operations) {
  std::printf("  %-44s %10.1f ns  %8.0f operations, %7.4f of the paper's\n", name, nanoseconds, operations,
              operations / kPaperOperations);
}

void compare() {
  std::printf("A frame of one leaf, 1/60 s; the paper's stiff integration took %.0f operations\n", kPaperOperations);
  const double integrated = time_integrated(50000);
  print("classical Runge-Kutta, 1/60 s a step", integrated, kStepOperations);
  for (const double blend : {0.5, 0.0}) {
    const Model model = learned(blend);
    const auto operations = static_cast<double>(must(count_operations(model)).operations_per_frame);
    for (const int leaves : {1, 100, 10000}) {
      char name[64];
      std::snprintf(name, sizeof name, "learned, joins %s, %d at once", blend > 0 ? "that fade" : "as they are",
                    leaves);
      const double time = time_played(model, leaves);
      print(name, time, operations);
      std::printf("    against classical Runge-Kutta %.1f times as fast\n", integrated / time);
    }
  }
}

}  // namespace
}  // namespace wisp

int main() { wisp::compare(); }
