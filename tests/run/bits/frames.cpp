// Prints a hash of more than 100 000 frames: the same from every compiler, level of optimisation, width of vectors and
// machine. Frames in which all that is small occurs are made twice, once with denormals flushed to zero.

#include <cstdio>
#include <cstdlib>
#include <limits>
#include <vector>

#ifdef __SSE2__
#include <immintrin.h>
#endif

#include "base/hash.hpp"
#include "model/sample_chain.hpp"
#include "model/sample_model.hpp"
#include "model/sample_switched.hpp"
#include "run/flame_model.hpp"
#include "wisp/run/bank.hpp"
#include "wisp/run/chain_facet.hpp"
#include "wisp/run/extinction_facet.hpp"
#include "wisp/run/random.hpp"

namespace wisp {
namespace {

// Little-endian machines only, as everywhere that this program runs.
void add(std::uint64_t& hash, const std::vector<float>& values) {
  hash = hash_bytes(std::as_bytes(std::span(values)), hash);
}

Bank full_bank(const Model& model, int capacity, std::uint64_t seed) {
  auto bank = Bank::create(model, {.capacity = capacity, .seed = seed, .polyline_points = 9});
  if (!bank) {
    std::printf("%s\n", bank.error().message.c_str());
    std::exit(1);
  }
  for (int k = 0; k < capacity; ++k) bank->spawn();
  return std::move(bank).value();
}

// Wind of one frame: now and then absurd, else between −2 and 2 in steps of 2^-22.
float wind_at(int frame, int instance) {
  const auto words = random_words({.seed = 77, .stream = static_cast<std::uint64_t>(instance), .step = frame / 5U});
  if (words[1] % 200 == 0) return std::numeric_limits<float>::quiet_NaN();
  if (words[1] % 200 == 1) return 1e30f;
  return static_cast<float>(static_cast<std::int32_t>(words[0]) >> 8) / 4194304.0f;
}

// Raw steps.
void step_frames(std::uint64_t& hash, const Model& model, int capacity, int frames) {
  Bank bank = full_bank(model, capacity, 5);
  std::vector<float> wind(capacity), outputs(static_cast<std::size_t>(capacity) * bank.output_count());
  for (int frame = 0; frame < frames; ++frame) {
    for (int k = 0; k < capacity; ++k) wind[k] = wind_at(frame, k);
    bank.set_inputs(wind);
    bank.step();
    bank.outputs(outputs);
    add(hash, outputs);
  }
}

// Time at 60 frames a second, polylines read.
void time_frames(std::uint64_t& hash, const Model& model, int capacity, int frames) {
  Bank bank = full_bank(model, capacity, 6);
  std::vector<float> wind(capacity);
  std::vector<float> points(static_cast<std::size_t>(capacity) * bank.polyline_points() * 2);
  for (int frame = 0; frame < frames; ++frame) {
    for (int k = 0; k < capacity; ++k) wind[k] = wind_at(frame, k);
    bank.set_inputs(wind);
    bank.advance(std::chrono::nanoseconds(16'666'667));
    bank.polylines(points);
    add(hash, points);
  }
}

// Flames that go out now and then, and are lit again.
void mortal_frames(std::uint64_t& hash, Model model, int capacity, int frames) {
  model.extinction =
      Extinction{.level = 1.3, .seconds = 0.15, .haste = 1.7, .recovery = 0.35, .dying = {{200, 90}, {2}}};
  Bank bank = full_bank(model, capacity, 8);
  std::vector<float> wind(capacity);
  std::vector<float> points(static_cast<std::size_t>(capacity) * bank.polyline_points() * 2), sizes(capacity);
  for (int frame = 0; frame < frames; ++frame) {
    for (int k = 0; k < capacity; ++k) wind[k] = wind_at(frame, k);
    bank.set_inputs(wind);
    bank.advance(std::chrono::nanoseconds(16'666'667));
    for (int k = 0; k < capacity; ++k) {
      const LitState state = *bank.extinction()->state_of(bank.at(k));
      sizes[k] = state.size;
      if (!state.lit && state.since_out > std::chrono::milliseconds(200)) bank.extinction()->relight(bank.at(k));
    }
    bank.polylines(points);
    add(hash, points);
    add(hash, sizes);
  }
}

// A flame that dies away to nothing, over and over: states pass through all that is small.
void fading_frames(std::uint64_t& hash, int frames) {
  Model model = flame_model();
  auto& arx = std::get<ArxModel>(model.dynamics);
  arx.input_mean.assign(1, 0.0);
  arx.output_mean.assign(16, 0.0);
  for (Output& output : model.outputs) output.lowest = -(output.highest = 0.5);
  Bank bank = full_bank(model, 3, 7);
  bank.set_noise(0);
  std::vector<float> outputs(48), points(static_cast<std::size_t>(3) * bank.polyline_points() * 2);
  for (int frame = 0; frame < frames; ++frame) {
    const float wind = frame % 700 < 3 ? 1e-3f : 0.0f;
    bank.set_common_inputs(std::span(&wind, 1));
    bank.step();
    bank.outputs(outputs);
    add(hash, outputs);
    bank.polylines(points);
    add(hash, points);
  }
}

// Falls in the wind, which come to the ground and are placed anew.
void falling_frames(std::uint64_t& hash, Model model, int capacity, int frames) {
  auto& gust = std::get<ChainModel>(model.dynamics).gust;
  if (gust) gust->ground.press = gust->vertical.press = 0.2;
  Bank bank = full_bank(model, capacity, 9);
  bank.chain()->set_ground(-3.0f);
  const auto inputs = static_cast<std::size_t>(bank.input_count());
  std::vector<float> wind(capacity * inputs), poses(static_cast<std::size_t>(capacity) * bank.output_count());
  for (int frame = 0; frame < frames; ++frame) {
    for (std::size_t k = 0; k < wind.size(); ++k) wind[k] = wind_at(frame, static_cast<int>(k));
    bank.set_inputs(wind);
    bank.set_noise(frame % 600 < 550 ? 1.0f : 0.0f);
    frame % 3 == 0 ? bank.step() : void(bank.advance(std::chrono::nanoseconds(13'333'333)));
    const int placed = frame % 97;
    if (placed < capacity) {
      const float x = wind_at(frame + 1, 0) > 0 ? 0.3f : -0.6f;
      bank.chain()->place(bank.at(placed), {.position = {x, 2, 1},
                                            .orientation = {0.8f, x, 0.2f, -0.1f},
                                            .velocity = {x, 0.1f, -0.7f},
                                            .spin = {0, 3 * x, 1}});
    }
    if (placed < capacity && frame % 2 == 0) {
      bank.chain()->steer(bank.at(placed), {.position = {1, 2.5f, -2}, .in = std::chrono::seconds(3)});
    }
    bank.outputs(poses);
    add(hash, poses);
  }
}

}  // namespace
}  // namespace wisp

int main() {
  using namespace wisp;
  std::uint64_t hash = 0;
  step_frames(hash, flame_model({.wind = InputShape::kEvenOdd}), 1, 30'000);
  step_frames(hash, sample_model(), 13, 2'000);
  step_frames(hash, flame_model({.wind = InputShape::kEvenOdd, .resampled_rows = 600}), 11, 2'000);
  step_frames(hash, still_flame_model(), 11, 2'000);
  time_frames(hash, flame_model(), 37, 1'000);
  mortal_frames(hash, flame_model({.wind = InputShape::kEvenOdd}), 11, 2'000);
  mortal_frames(hash, default_flame_model(), 5, 2'000);
  mortal_frames(hash, coupled_flame_model(), 5, 2'000);
  for (int capacity : {1, 13}) falling_frames(hash, windy_chain(), capacity, 4'000);
  falling_frames(hash, sample_chain(ChainMotion::kPosition), 5, 2'000);
  falling_frames(hash, steered_chain(), 9, 2'000);
  step_frames(hash, sample_switched(), 3, 4'000);
  std::uint64_t flushed = hash;
  fading_frames(hash, 5'000);
#ifdef __SSE2__
  _mm_setcsr(_mm_getcsr() | 0x8040);
  fading_frames(flushed, 5'000);
  if (flushed != hash) std::printf("where denormals are flushed, not ");
#endif
  std::printf("%016llx\n", static_cast<unsigned long long>(hash));
}
