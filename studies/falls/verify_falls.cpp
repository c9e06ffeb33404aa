// Learned falls against those that they were learned from: gusts in the model's own play, real paper, the spread over
// seeds, and steering. Prints tables; exit status 1 where a bound is missed.
//
//   wisp_verify_falls [gusts] [paper] [spread] [steering]     default all

#include "studies/falls/verify_falls.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "learn/chain/chain_fidelity.hpp"
#include "wisp/simulate/leaf_drops.hpp"

namespace wisp::verify {
namespace {

constexpr double kWindowSegments = 2.5;

LearnedLeaf learn() {
  const auto drops = simulate_leaf_drops({.drops = 260});
  if (!drops) give_up(drops.error());
  LeafRecipe recipe;
  recipe.holdout = 0.4;
  auto fit = fit_chain(std::span(&*drops, 1), recipe);
  if (!fit) give_up(fit.error());
  return {std::move(*fit), segmentation_of(recipe)};
}

}  // namespace

void give_up(const Error& error) {
  std::fprintf(stderr, "%s\n", error.message.c_str());
  std::exit(1);
}

const LearnedLeaf& learned_leaf() {
  static const LearnedLeaf leaf = learn();
  return leaf;
}

std::vector<Stretch> series_of(std::span<const Recording> falls, const LearnedLeaf& leaf) {
  const auto motion = motion_of(falls);
  if (!motion) give_up(motion.error());
  const auto cut = segment(*motion, falls, leaf.segmentation);
  if (!cut) give_up(cut.error());
  return motion_series(*motion, cut->segments);
}

std::size_t window_rows(const LearnedLeaf& leaf) {
  return static_cast<std::size_t>(
      std::lround(kWindowSegments * leaf.fit.summary.mean_segment_seconds * leaf.fit.model.rate_hz));
}

}  // namespace wisp::verify

int main(int count, char** names) {
  using namespace wisp::verify;
  constexpr std::array kChecks = {Check{"gusts", gusts}, Check{"paper", paper}, Check{"spread", spread},
                                  Check{"steering", steering}};
  return run_checks(kChecks, std::span(names, static_cast<std::size_t>(count)).subspan(1));
}
