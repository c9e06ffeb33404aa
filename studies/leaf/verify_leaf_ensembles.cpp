// Ensembles of falls: methods against each other, what they cost, energy, regimes.

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <numbers>

#include "studies/leaf/verify_leaf.hpp"

namespace wisp::verify {
namespace {

constexpr double kFrame = 1.0 / 60;
// What the paper's stiff integrator took for a frame of its leaf.
constexpr double kPaperOperations = 9239;
constexpr double kStepOperations = 1172;  // four right-hand sides of 243, and their sum

LeafFlight begun(const Leaf& leaf, const LeafWind& wind, const LeafState& state, double longest_step) {
  auto flight = LeafFlight::begin(leaf, wind, state, longest_step);
  if (!flight) {
    std::fprintf(stderr, "%s\n", flight.error().message.c_str());
    std::exit(1);
  }
  return std::move(*flight);
}

void must(const Result<void>& good) {
  if (good) return;
  std::fprintf(stderr, "%s\n", good.error().message.c_str());
  std::exit(1);
}

// One fall, watched frame by frame.
void watch(LeafFlight& flight, double seconds, FallFigures& figures) {
  const int frames = static_cast<int>(std::lround(seconds / kFrame));
  const LeafState start = flight.state();
  const std::size_t stalls_before = flight.stalls().size();
  double side = leaf_normal(start)[2] > 0 ? 1 : -1;
  double squares = 0, spins = 0;
  int flips = 0;
  std::vector<double> rising;
  for (int k = 0; k < frames; ++k) {
    must(flight.advance(kFrame));
    const LeafState& s = flight.state();
    // A tenth of its sine over the edge is over; less is a wobble on edge.
    if (leaf_normal(s)[2] * side < -0.1) side = -side, ++flips;
    const double vertical = leaf_world_velocity(s)[2];
    squares += vertical * vertical;
    for (const double part : s.spin) spins += part * part;
    if (vertical > 0) rising.push_back(flight.seconds());
  }
  int near = 0;
  for (const double at : rising)
    for (const double stall : flight.stalls())
      if (std::abs(stall - at) < 0.05) {
        ++near;
        break;
      }
  const LeafState& end = flight.state();
  const double total = frames;
  figures.descent.add((start.position[2] - end.position[2]) / seconds);
  figures.flips.add(flips / seconds);
  figures.stalls.add(static_cast<double>(flight.stalls().size() - stalls_before) / seconds);
  figures.drift.add(std::hypot(end.position[0] - start.position[0], end.position[1] - start.position[1]) / seconds);
  figures.rising.add(100 * static_cast<double>(rising.size()) / total);
  if (!rising.empty()) figures.rising_at_stalls.add(100.0 * near / static_cast<double>(rising.size()));
  figures.swing.add(std::sqrt(squares / total));
  figures.spin.add(std::sqrt(spins / total));
  figures.frames += total;
}

void print(const char* name, const FallFigures& f) {
  std::printf("  %-24s %.4f±%.4f  %.3f±%.3f  %.3f±%.3f  %.3f±%.3f  %5.2f±%.2f  %.4f±%.4f  %.2f±%.2f\n", name,
              f.descent.mean(), f.descent.error(), f.flips.mean(), f.flips.error(), f.stalls.mean(), f.stalls.error(),
              f.drift.mean(), f.drift.error(), f.rising.mean(), f.rising.error(), f.swing.mean(), f.swing.error(),
              f.spin.mean(), f.spin.error());
}

constexpr const char* kHeading =
    "  %-24s descent m/s    flips/s      stalls/s     drift m/s    rising %%     swing m/s      spin rad/s\n";

// The largest difference of two ensembles' means, in its standard errors.
double apart(const FallFigures& a, const FallFigures& b) {
  double most = 0;
  for (const auto figure : {&FallFigures::descent, &FallFigures::flips, &FallFigures::stalls, &FallFigures::drift,
                            &FallFigures::rising, &FallFigures::swing, &FallFigures::spin}) {
    const Estimate& x = a.*figure;
    const Estimate& y = b.*figure;
    most = std::max(most, std::abs(x.mean() - y.mean()) / std::hypot(x.error(), y.error()));
  }
  return most;
}

struct Method {
  const char* name;
  double longest_step;
};

}  // namespace

FallFigures figures_of(const Ensemble& e) {
  FallFigures figures;
  const LeafWind calm;
  const std::clock_t start = std::clock();
  for (int k = 0; k < e.falls; ++k) {
    LeafFlight flight = begun(e.leaf, calm, random_start(11, static_cast<std::uint64_t>(k)), e.longest_step);
    must(flight.advance(e.settle));
    watch(flight, e.seconds, figures);
  }
  figures.seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC * e.seconds / (e.seconds + e.settle);
  return figures;
}

void integrators(Bounds& bounds) {
  std::printf("\nThe default leaf, 400 falls of 20 s by each length of the step\n");
  std::printf(kHeading, "");
  const Method methods[] = {
      {"0.5 ms", 0.0005},
      {"1/240 s", kFrame / 4},
      {"1/60 s", kFrame},
  };
  std::vector<FallFigures> all;
  for (const Method& method : methods) {
    all.push_back(figures_of({.longest_step = method.longest_step, .falls = 400}));
    print(method.name, all.back());
    std::fflush(stdout);
  }
  // Seven figures of ensembles that chaos makes independent: all within 3.3 standard errors but once in 150
  // comparisons; the seed is fixed.
  for (std::size_t k = 1; k < all.size(); ++k) {
    bounds.at_most(std::string(methods[k].name) + " from 0.5 ms, standard errors", apart(all[0], all[k]), 3.3);
  }
  std::printf("  the paper's integrator: %.0f operations a frame\n", kPaperOperations);
  std::printf("  %-24s operations a frame  of the paper's  microseconds a frame\n", "");
  for (std::size_t k = 0; k < all.size(); ++k) {
    const double operations = kStepOperations * kFrame / methods[k].longest_step;
    std::printf("  %-24s %18.0f  %14.2f  %20.2f\n", methods[k].name, operations, operations / kPaperOperations,
                1e6 * all[k].seconds / all[k].frames);
  }
}

void energy(Bounds& bounds) {
  std::printf(
      "\nEnergy in still air, 40 falls of 10 s: the most that it grows in a frame, over the energy of motion\n");
  const Leaf leaf;
  const LeafWind calm;
  const Method methods[] = {{"0.5 ms", 0.0005}, {"1/60 s", kFrame}};
  for (const Method& method : methods) {
    double worst = 0, longest = 0;
    for (std::uint64_t k = 0; k < 40; ++k) {
      LeafFlight flight = begun(leaf, calm, random_start(12, k), method.longest_step);
      double before = leaf_energy(leaf, flight.state());
      for (int frame = 0; frame < 600; ++frame) {
        must(flight.advance(kFrame));
        LeafState s = flight.state();
        const double after = leaf_energy(leaf, s);
        double length = 0;
        for (const double part : s.attitude) length += part * part;
        longest = std::max(longest, std::abs(std::sqrt(length) - 1));
        s.position[2] = 0;
        worst = std::max(worst, (after - before) / leaf_energy(leaf, s));
        before = after;
      }
    }
    std::printf("  %-24s %.2e, | |q| − 1 | at most %.1e\n", method.name, worst, longest);
    bounds.at_most(std::string(method.name) + ": grows by, millionths", 1e6 * worst, 0.5);
    bounds.at_most(std::string(method.name) + ": | |q| − 1 |, 1e-9", 1e9 * longest, 1);
  }
}

void regimes(Bounds& bounds) {
  std::printf("\nRegimes by areal density, set C, 40 falls of 20 s\n");
  const auto fall = [](double grams, double length, double width) {
    Leaf leaf;
    leaf.areal_density = grams / 1000, leaf.length = length, leaf.width = width;
    FallFigures f = figures_of({.leaf = leaf, .falls = 40});
    char name[64];
    std::snprintf(name, sizeof name, "%.1f × %.1f cm, %3.0f g/m²", 100 * length, 100 * width, grams);
    print(name, f);
    return f;
  };
  std::printf(kHeading, "");
  // A leaf that flutters keeps its upper side up; flips come with chaos.
  for (const double grams : {5.0, 10.0, 20.0, 30.0, 40.0, 50.0}) {
    const FallFigures f = fall(grams, 0.073, 0.049);
    const std::string name = "leaf of " + std::to_string(static_cast<int>(grams)) + " g/m²: flips a second";
    if (grams <= 10) bounds.at_most(name, f.flips.mean(), 0);
    if (grams >= 30) bounds.at_least(name, f.flips.mean(), 0.5);
  }
  const FallFigures whole = fall(70, 0.073, 0.049);
  bounds.at_most("leaf of 70 g/m²: descent off 0.75 m/s, %", 100 * std::abs(whole.descent.mean() / 0.75 - 1), 15);
  bounds.at_most("flips off 4.5 a second, %", 100 * std::abs(whole.flips.mean() / 4.5 - 1), 15);
  bounds.at_most("stalls off 7 a second, %", 100 * std::abs(whole.stalls.mean() / 7 - 1), 15);
  bounds.at_least("rising, % of the time", whole.rising.mean(), 1);
  bounds.at_least("of that within 50 ms of a stall, %", whole.rising_at_stalls.mean(), 80);
  for (const double grams : {10.0, 20.0}) {
    const FallFigures f = fall(grams, 0.06, 0.06);
    const std::string name = "disc of " + std::to_string(static_cast<int>(grams)) + " g/m²: ";
    bounds.at_most(name + "flips a second", f.flips.mean(), 0);
    bounds.at_most(name + "stalls off 3 a second, %", 100 * std::abs(f.stalls.mean() / 3 - 1), 20);
    bounds.at_least(name + "descent, m/s", f.descent.mean(), 0.1);
    bounds.at_most(name + "descent, m/s", f.descent.mean(), 0.5);
  }
  for (const double grams : {30.0, 70.0, 150.0}) {
    const FallFigures f = fall(grams, 0.06, 0.06);
    bounds.at_least("disc of " + std::to_string(static_cast<int>(grams)) + " g/m²: flips a second", f.flips.mean(), 1);
  }
}

}  // namespace wisp::verify
