// Steering: how near falls come to where they are sent, and whether they are still like those that nobody steers.
// Targets are where other falls of the same chain are by themselves when the time has come.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "studies/falls/verify_falls.hpp"
#include "wisp/run/bank.hpp"
#include "wisp/run/chain_facet.hpp"

namespace wisp::verify {
namespace {

constexpr int kFalls = 200;
constexpr std::uint64_t kTargetSeed = 1, kSteeredSeed = 2;
constexpr std::size_t kMaxWindows = 500;

/// Falls of one bank, row by row, as recordings.
using Falls = std::vector<Recording>;

Falls played(Bank bank, const Model& model, std::size_t rows) {
  Recording empty;
  empty.source = "played";
  empty.rate_hz = model.rate_hz;
  for (const Output& output : model.outputs) empty.channels.push_back({output.name, output.unit, Role::kOutput, {}});
  Falls falls(kFalls, empty);
  std::vector<float> pose(model.outputs.size());
  for (std::size_t row = 0; row < rows; ++row) {
    if (row > 0) bank.step();
    for (int k = 0; k < kFalls; ++k) {
      bank.outputs(bank.at(k), pose);
      for (std::size_t i = 0; i < pose.size(); ++i) falls[k].channels[i].samples.push_back(pose[i]);
    }
  }
  return falls;
}

Bank spawned(const Model& model, std::uint64_t seed) {
  auto bank = Bank::create(model, {.capacity = kFalls, .seed = seed});
  if (!bank) give_up(bank.error());
  for (int k = 0; k < kFalls; ++k) bank->spawn();
  return std::move(*bank);
}

std::array<float, 3> end_of(const Recording& fall) {
  std::array<float, 3> place{};
  for (std::size_t axis = 0; axis < 3; ++axis) place[axis] = static_cast<float>(fall.channels[axis].samples.back());
  return place;
}

FeatureWindows windows_of(std::span<const Recording> falls, const LearnedLeaf& leaf) {
  return thinned(series_windows(series_of(falls, leaf), window_rows(leaf)), kMaxWindows);
}

double energy_distance(std::span<const Recording> falls, const LearnedLeaf& leaf) {
  FeatureWindows recorded = windows_of(leaf.fit.held_out, leaf), made = windows_of(falls, leaf);
  standardise(recorded, made);
  return energy_distance(recorded, made);
}

/// Distances from the targets, in order.
struct Misses {
  std::vector<double> in_all;
  std::vector<double> over_ground;

  double median() const { return in_all[in_all.size() / 2]; }
};

Misses misses_of(std::span<const Recording> falls, std::span<const std::array<float, 3>> targets) {
  Misses out;
  for (std::size_t k = 0; k < falls.size(); ++k) {
    const auto end = end_of(falls[k]);
    const double aside = std::hypot(end[0] - targets[k][0], end[1] - targets[k][1]);
    out.over_ground.push_back(aside);
    out.in_all.push_back(std::hypot(aside, end[2] - targets[k][2]));
  }
  std::sort(out.in_all.begin(), out.in_all.end());
  std::sort(out.over_ground.begin(), out.over_ground.end());
  return out;
}

void print(const std::string& name, const Misses& misses, double energy) {
  std::printf("  %-12s median miss %.2f m, nine in ten within %.2f m, of it over ground %.2f m; energy distance %.4f\n",
              name.c_str(), misses.median(), misses.in_all[misses.in_all.size() * 9 / 10],
              misses.over_ground[misses.over_ground.size() / 2], energy);
}

void steer_for(int seconds, Bounds& bounds) {
  const LearnedLeaf& leaf = learned_leaf();
  const Model& model = leaf.fit.model;
  const auto rows = static_cast<std::size_t>(std::lround(seconds * model.rate_hz)) + 1;
  std::vector<std::array<float, 3>> targets;
  for (const Recording& fall : played(spawned(model, kTargetSeed), model, rows)) targets.push_back(end_of(fall));
  const Falls free = played(spawned(model, kSteeredSeed), model, rows);
  const Misses by_themselves = misses_of(free, targets);
  std::printf(" in %d s\n", seconds);
  print("not steered", by_themselves, energy_distance(free, leaf));
  for (const float near : {0.2f, 0.1f, 0.02f}) {
    Bank bank = spawned(model, kSteeredSeed);
    for (int k = 0; k < kFalls; ++k) bank.chain()->steer(bank.at(k), {targets[k], std::chrono::seconds(seconds), near});
    const Falls falls = played(std::move(bank), model, rows);
    const Misses misses = misses_of(falls, targets);
    const double energy = energy_distance(falls, leaf);
    char name[32];
    std::snprintf(name, sizeof name, "near %.2f m", near);
    print(name, misses, energy);
    bounds.at_most(std::string(name) + ": median miss, of that of falls left to themselves",
                   misses.median() / by_themselves.median(), 0.5);
    bounds.at_most(std::string(name) + ": energy distance", energy, 0.03);
  }
}

}  // namespace

void steering(Bounds& bounds) {
  std::printf("\nSteering: %d falls, each sent to where another falls by itself\n", kFalls);
  for (const int seconds : {4, 8}) steer_for(seconds, bounds);
}

}  // namespace wisp::verify
