// Gusts in the model's own play: the chain goes on from where each calm fall is at the onset, and is blown at.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <vector>

#include "learn/chain/chain_fidelity.hpp"
#include "learn/chain/gusts/gust_play.hpp"
#include "learn/chain/gusts/gust_response.hpp"
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
  auto play = play_gusts(model, pairs.windy, pairs.calm, {.scenes = 0});
  if (!play) give_up(play.error());
  return std::move(*play);
}

double degrees_between(const Triple& a, const Triple& b) {
  return std::abs(std::atan2(a[0] * b[1] - a[1] * b[0], a[0] * b[0] + a[1] * b[1])) * 180 / std::numbers::pi;
}

// How far what `predicted` says of a gust points from where its recorded clones went.
template <class Predicted>
GustDirection direction_of(const std::vector<GustEnd>& ends, Predicted predicted) {
  GustDirection out;
  std::vector<double> all;
  double clear = 0;
  for (std::size_t k = 0; k < ends.size(); ++k) {
    all.push_back(degrees_between(predicted(k), ends[k].recorded));
    out.mean += all.back() / static_cast<double>(ends.size());
    clear += ends[k].clear ? 1 : 0;
    out.mean_clear += ends[k].clear ? all.back() : 0;
  }
  std::sort(all.begin(), all.end());
  out.median = all[all.size() / 2];
  out.mean_clear /= clear;
  return out;
}

// The calm fall's way over ground times the mean wind.
Triple blown_way(const GustEnd& end) {
  const double speed = std::hypot(end.wind[0], end.wind[1]);
  return {speed * end.recorded_calm[0], speed * end.recorded_calm[1], 0};
}

// The share of that which a gust takes away, by least squares.
double forgotten_share(const std::vector<GustEnd>& ends) {
  double product = 0, square = 0;
  for (const GustEnd& end : ends) {
    const Triple way = blown_way(end);
    for (std::size_t axis = 0; axis < 2; ++axis) {
      product += way[axis] * (end.played[axis] - end.recorded[axis]);
      square += way[axis] * way[axis];
    }
  }
  return product / square;
}

void print(const char* what, const GustDirection& direction) {
  std::printf("  %-34s direction off by %4.1f° (median), %4.1f° (mean), %4.1f° (mean of the clear ones)\n", what,
              direction.median, direction.mean, direction.mean_clear);
}

// The play's own, by gusts within 30° of level: steeper ones have little direction over ground.
GustDirection direction_of_level(const std::vector<GustEnd>& ends) {
  std::vector<GustEnd> level;
  for (const GustEnd& end : ends) {
    if (std::abs(end.wind[2]) <= std::hypot(end.wind[0], end.wind[1]) * std::tan(std::numbers::pi / 6)) {
      level.push_back(end);
    }
  }
  return direction_of(level, [&](std::size_t k) { return level[k].played; });
}

// What a direction could be told by: nothing but the wind; all there is, which is other clones of the same gusts; and
// the calm fall as it was recorded, which no play knows beyond its onset.
void explain(const std::vector<GustEnd>& few, const std::vector<GustEnd>& many, double share) {
  print("the wind's own direction", direction_of(few, [&](std::size_t k) { return few[k].wind; }));
  std::printf("  a gust takes %.2f of the calm fall's way over ground from the fall for each m/s of its mean\n", share);
  print("the play, less that share of it", direction_of(few, [&](std::size_t k) {
          const Triple way = blown_way(few[k]);
          return Triple{few[k].played[0] - share * way[0], few[k].played[1] - share * way[1], 0};
        }));
  if (few.size() != many.size()) return;
  print("128 other clones", direction_of(few, [&](std::size_t k) { return many[k].recorded; }));
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
  const auto learned = learn_gusts(told.windy, told.calm, {.holdout = 0});
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
    const GustDirection level = direction_of_level(play->ends);
    print("of level gusts", level);
    bounds.at_most("direction of displacements by level gusts, mean, degrees", level.mean, 20);
    bounds.at_most("diverges", f.diverges ? 1 : 0, 0);
  }
  updrafts(model, bounds);
  std::printf("  Why, by the 32 clones\n");
  explain(few.ends, many.ends, forgotten_share(played(model, 400, 32, 1).ends));
}

}  // namespace wisp::verify
