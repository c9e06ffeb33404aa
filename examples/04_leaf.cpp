// Learns how a leaf falls from simulated falls, calm and in gusts, and plays two leaves that fall alike until a gust
// hits the first. Prints a line per frame: seconds, x and height of the first, then of the second, in metres.
#include <chrono>
#include <cstdio>
#include <iostream>
#include <vector>
#include <wisp/learn.hpp>
#include <wisp/play.hpp>
#include <wisp/simulate/leaf_drops.hpp>

static int fail(const wisp::Error& error) {
  std::cerr << error.message << '\n';
  return 1;
}

int main() {
  const auto falls = wisp::simulate_leaf_drops({.drops = 60, .seconds = 10});
  if (!falls) return fail(falls.error());
  // Each fall with and without a gust, in many clones: their difference is the effect of the wind without chance.
  const auto gusts = wisp::simulate_leaf_pairs({.drops = {.drops = 40, .seconds = 1.5}, .clones = 8});
  if (!gusts) return fail(gusts.error());
  const std::vector<wisp::Recording> recordings{*falls, gusts->windy, gusts->calm};
  const auto fit = wisp::learn(recordings, wisp::LeafRecipe{});
  if (!fit) return fail(fit.error());
  std::cout << fit->report;

  auto bank = wisp::Bank::create(fit->model, {.capacity = 2});
  if (!bank) return fail(bank.error());
  const wisp::InstanceId blown = bank->spawn(1);
  bank->spawn(1);                            // the same random stream: both fall alike
  std::vector<float> wind(3), poses(2 * 7);  // x, y, z; of each leaf pos.x, pos.y, pos.z, q.w, q.x, q.y, q.z
  for (int frame = 0; frame < 180; ++frame) {
    wind[0] = frame > 60 && frame < 90 ? 2.0F : 0.0F;  // m/s, half a second of it
    bank->set_inputs(blown, wind);
    bank->advance(std::chrono::nanoseconds(16'666'667));
    bank->outputs(poses);
    std::printf("%.3f %.3f %.3f %.3f %.3f\n", frame / 60.0, poses[0], poses[2], poses[7], poses[9]);
  }
}
