// Gusts in the model's own play: the chain goes on from where each calm fall is at the onset, and is blown at.

#include <cmath>
#include <cstdio>
#include <vector>

#include "learn/chain/gusts/gust_play.hpp"
#include "studies/falls/verify_falls.hpp"
#include "wisp/run/bank.hpp"
#include "wisp/simulate/leaf_drops.hpp"

namespace wisp::verify {
namespace {

LeafPairs pairs_of(int gusts, int clones, std::uint64_t seed) {
  LeafPairsOptions options{.clones = clones};
  options.drops.drops = gusts;
  options.drops.seconds = 1.5;
  options.drops.seed = seed;
  auto pairs = simulate_leaf_pairs(options);
  if (!pairs) give_up(pairs.error());
  return std::move(*pairs);
}

void print(const char* what, double fit, const GustDirection& direction) {
  std::printf(
      "  %-34s fit %5.1f %%, direction off by %4.1f° (median), %4.1f° (mean), %4.1f° (mean of the clear ones)\n", what,
      fit, direction.median, direction.mean, direction.mean_clear);
}

GustPlay played(const Model& model, int gusts, int clones, std::uint64_t seed) {
  const LeafPairs pairs = pairs_of(gusts, clones, seed);
  auto play = play_gusts(model, *gust_pairs(pairs.windy, pairs.calm), 0, 1);
  if (!play) give_up(play.error());
  return std::move(*play);
}

// Mean vertical speed of the play in a steady wind that blows upwards, once it has begun.
double vertical_speed_in(const Model& model, float updraft) {
  constexpr int kFalls = 200, kBegun = 120, kSteps = 1200;
  auto bank = Bank::create(model, {.capacity = kFalls});
  if (!bank) give_up(bank.error());
  for (int k = 0; k < kFalls; ++k) bank->spawn();
  std::vector<float> wind(3 * kFalls);
  for (std::size_t k = 2; k < wind.size(); k += 3) wind[k] = updraft;
  bank->set_inputs(wind);
  const auto count = static_cast<std::size_t>(bank->output_count());
  std::vector<float> pose(count);
  double height = 0;
  for (int step = 1; step <= kSteps; ++step) {
    bank->step();
    if (step != kBegun && step != kSteps) continue;
    for (int k = 0; k < kFalls; ++k) {
      bank->outputs(bank->at(k), pose);
      height += (step == kSteps ? 1 : -1) * static_cast<double>(pose[2]) / kFalls;
    }
  }
  return height * model.rate_hz / (kSteps - kBegun);
}

void updrafts(const Model& model, Bounds& bounds) {
  const double calm = vertical_speed_in(model, 0);
  for (const float updraft : {0.5f, 1.0f, 1.5f}) {
    const double lift = vertical_speed_in(model, updraft) - calm;
    std::printf("  a steady updraft of %.1f m/s lifts by %.3f m/s\n", static_cast<double>(updraft), lift);
    bounds.at_most("lift of an updraft: off by", std::abs(lift / static_cast<double>(updraft) - 1), 0.05);
  }
}

}  // namespace

void gusts(Bounds& bounds) {
  std::printf("\nGusts, learned from 400 of them, 32 clones each\n");
  const LeafPairs told = pairs_of(400, 32, 1);
  const auto learned = learn_gusts(*gust_pairs(told.windy, told.calm), 400);
  if (!learned) give_up(learned.error());
  Model model = learned_leaf().fit.model;
  std::get<ChainModel>(model.dynamics).gust = learned->response;
  model.inputs = learned->inputs;
  const GustPlay few = played(model, 240, 32, 2), many = played(model, 240, 128, 2);
  for (const GustPlay* play : {&few, &many}) {
    const GustPlayFigures& f = play->figures;
    std::printf("  %zu held-out gusts of %zu clones, %zu of them clear of chance\n", f.gusts, f.clones, f.clear_gusts);
    print("the model's own play", f.fit_percent, f.direction);
    print("half the clones against the others", f.halves_fit_percent, f.halves_direction);
    std::printf("  velocity fits by %.1f %%; carried at most %.2f m (simulated %.2f); left 2 s later: %.1e m/s\n",
                f.velocity_fit_percent, f.largest_displacement, f.largest_recorded_displacement, f.left_after);
    bounds.at_least("fit of the mean displacement, %", f.fit_percent, 66);
    bounds.at_most("direction of clear displacements, degrees", f.direction.mean_clear, 15);
    bounds.at_most("diverges", f.diverges ? 1 : 0, 0);
  }
  updrafts(model, bounds);
}

}  // namespace wisp::verify
