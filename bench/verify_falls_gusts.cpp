// Gusts in the model's own play: the chain goes on from where each calm fall is at the onset, and is blown at.

#include <cstdio>

#include "verify_falls.hpp"
#include "wisp/learn/chain_fidelity.hpp"
#include "wisp/learn/gust_play.hpp"
#include "wisp/learn/gust_response.hpp"
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

}  // namespace

void gusts(Bounds& bounds) {
  std::printf("\nGusts, learned from 400 of them, 32 clones each\n");
  const LeafPairs told = pairs_of(400, 32, 1);
  const auto learned = learn_gusts(told.windy, told.calm, {.holdout = 0});
  if (!learned) give_up(learned.error());
  Model model = learned_leaf().fit.model;
  std::get<ChainModel>(model.dynamics).gust = learned->response;
  model.inputs = learned->inputs;
  for (const int clones : {32, 128}) {
    const LeafPairs unseen = pairs_of(240, clones, 2);
    const auto play = play_gusts(model, unseen.windy, unseen.calm, {.scenes = 0});
    if (!play) give_up(play.error());
    const GustPlayFigures& f = play->figures;
    std::printf("  %zu held-out gusts of %zu clones, %zu of them clear of chance\n", f.gusts, f.clones, f.clear_gusts);
    print("the model's own play", f.fit_percent, f.direction);
    print("half the clones against the others", f.halves_fit_percent, f.halves_direction);
    std::printf("  velocity fits by %.1f %%; carried at most %.2f m (simulated %.2f); left 2 s later: %.1e m/s\n",
                f.velocity_fit_percent, f.largest_displacement, f.largest_recorded_displacement, f.left_after);
    bounds.at_least("fit of the mean displacement, %", f.fit_percent, 50);
    bounds.at_most("direction of clear displacements, degrees", f.direction.mean_clear, 15);
    bounds.at_most("diverges", f.diverges ? 1 : 0, 0);
  }
}

}  // namespace wisp::verify
