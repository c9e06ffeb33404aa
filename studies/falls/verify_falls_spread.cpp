// The figures of learned falls over many seeds of the play: what is the chain's, and what is one play's chance.

#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "learn/chain/chain_fidelity.hpp"
#include "studies/falls/verify_falls.hpp"

namespace wisp::verify {
namespace {

constexpr int kSeeds = 8;

struct Row {
  const char* name;
  double FallFigures::*figure;
};

void report(const Row& row, const std::vector<ChainFidelity>& plays, Bounds& bounds) {
  const double real = plays.front().real.*row.figure;
  double sum = 0, squares = 0, worst = 0;
  for (const ChainFidelity& play : plays) {
    const double off = 100 * ((play.synthesized.*row.figure) / real - 1);
    sum += off;
    squares += off * off;
    worst = std::max(worst, std::abs(off));
  }
  const double mean = sum / kSeeds, sd = std::sqrt(std::max(0.0, squares / kSeeds - mean * mean));
  std::printf("  %-24s recorded %.3f, synthesized off by %+.1f ± %.1f %% over %d seeds, %.1f %% at most\n", row.name,
              real, mean, sd, kSeeds, worst);
  bounds.at_most(std::string(row.name) + ": off by %, mean over the seeds", std::abs(mean), 10);
}

}  // namespace

void spread(Bounds& bounds) {
  std::printf("\nThe learned leaf against its held-out falls, %d plays of different seeds\n", kSeeds);
  const LearnedLeaf& leaf = learned_leaf();
  std::vector<ChainFidelity> plays;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const auto play =
        chain_fidelity(leaf.fit.model, leaf.fit.held_out, {.segmentation = leaf.segmentation, .seed = seed});
    if (!play) give_up(play.error());
    plays.push_back(*play);
    const Bounded& energy = play->energy_distance;
    std::printf(
        "  seed %d: energy distance %.4f (floor %.4f, ceiling %.3f), jumps above the 99th percentile %.1f %% "
        "and %.1f %% (at recorded stalls %.1f %% and %.1f %%)\n",
        static_cast<int>(seed), energy.value, energy.floor, energy.ceiling, 100 * play->join_defect.position,
        100 * play->join_defect.rotation, 100 * play->join_defect.position_floor,
        100 * play->join_defect.rotation_floor);
    bounds.at_most("energy distance", energy.value, 0.03);
  }
  for (const Row& row :
       {Row{"descent speed", &FallFigures::descent_speed}, Row{"lateral spread", &FallFigures::lateral_spread},
        Row{"time between stalls", &FallFigures::event_seconds},
        Row{"flips a second", &FallFigures::flips_per_second}}) {
    report(row, plays, bounds);
  }
}

}  // namespace wisp::verify
