// How a leaf falls in the long run, by its areal density and by its integrator.

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "simulate/leaf/leaf_flight.hpp"
#include "simulate/random_numbers.hpp"

namespace wisp::leaf_regime_test {
namespace {

constexpr double kFrame = 1.0 / 60;

// One fall of ten seconds from a random start, the first two not counted.
struct Fall {
  double descent = 0;        // m/s
  double stalls = 0;         // a second
  int flips = 0;             // the upper side passes the edge by 6°
  int rising = 0;            // frames
  int rising_at_stalls = 0;  // of those, within 50 ms of a stall
};

Fall watched(const Leaf& leaf, double longest_step, std::uint64_t stream) {
  flow::RandomNumbers random(31, stream);
  LeafState state;
  for (double& part : state.attitude) part = random.normal();
  for (double& part : state.velocity) part = 0.3 * random.normal();
  for (double& part : state.spin) part = 3 * random.normal();
  const LeafWind calm;
  auto flight = LeafFlight::begin(leaf, calm, state, longest_step);
  EXPECT_TRUE(flight && flight->advance(2));
  const double top = flight->state().position[2];
  const std::size_t stalled = flight->stalls().size();
  double side = leaf_normal(flight->state())[2] > 0 ? 1 : -1;
  Fall fall;
  std::vector<double> rising;
  for (int frame = 0; frame < 600; ++frame) {
    EXPECT_TRUE(flight->advance(kFrame));
    if (leaf_normal(flight->state())[2] * side < -0.1) side = -side, ++fall.flips;
    if (leaf_world_velocity(flight->state())[2] > 0) rising.push_back(flight->seconds());
  }
  fall.descent = (top - flight->state().position[2]) / 10;
  fall.stalls = static_cast<double>(flight->stalls().size() - stalled) / 10;
  fall.rising = static_cast<int>(rising.size());
  for (const double at : rising) {
    bool near = false;
    for (const double stall : flight->stalls()) near = near || std::abs(stall - at) < 0.05;
    fall.rising_at_stalls += near;
  }
  return fall;
}

std::vector<Fall> many(const Leaf& leaf, int count, double longest_step = 1.0 / 60) {
  std::vector<Fall> falls;
  for (int k = 0; k < count; ++k) falls.push_back(watched(leaf, longest_step, static_cast<std::uint64_t>(k)));
  return falls;
}

template <class Value>
double mean(const std::vector<Fall>& falls, Value Fall::*figure) {
  double sum = 0;
  for (const Fall& fall : falls) sum += static_cast<double>(fall.*figure);
  return sum / static_cast<double>(falls.size());
}

Leaf leaf_of(double grams, double length = 0.073, double width = 0.049) {
  Leaf leaf;
  leaf.areal_density = grams / 1000, leaf.length = length, leaf.width = width;
  return leaf;
}

TEST(LeafRegime, IsFlutterWhereTheLeafIsLight) {
  EXPECT_EQ(mean(many(leaf_of(5), 10), &Fall::flips), 0);
  EXPECT_EQ(mean(many(leaf_of(10), 10), &Fall::flips), 0);
  const std::vector<Fall> discs = many(leaf_of(20, 0.06, 0.06), 10);
  EXPECT_EQ(mean(discs, &Fall::flips), 0);
  EXPECT_NEAR(mean(discs, &Fall::stalls), 3, 0.6);
}

TEST(LeafRegime, IsChaosWithFlipsWhereItIsHeavier) {
  EXPECT_GT(mean(many(leaf_of(30), 10), &Fall::flips), 10);
  EXPECT_GT(mean(many(leaf_of(70), 10), &Fall::flips), 30);
  EXPECT_GT(mean(many(leaf_of(150, 0.06, 0.06), 10), &Fall::flips), 30);
}

TEST(LeafRegime, OfTheDefaultLeafIsThatOfTheTrainingSet) {
  // 40 falls give the descent to 0.7 % and the stalls to 0.5 %; the bounds are the reference's rounding and more.
  const std::vector<Fall> falls = many({}, 40);
  EXPECT_NEAR(mean(falls, &Fall::descent), 0.75, 0.15 * 0.75);
  EXPECT_NEAR(mean(falls, &Fall::stalls), 7, 0.7);
  EXPECT_NEAR(mean(falls, &Fall::flips) / 10, 4.5, 0.7);
}

TEST(LeafRegime, HasMomentsOfRisingAtStalls) {
  const std::vector<Fall> falls = many({}, 40);
  EXPECT_GT(mean(falls, &Fall::rising), 6);  // of 600 frames
  EXPECT_GT(mean(falls, &Fall::rising_at_stalls), 0.8 * mean(falls, &Fall::rising));
}

TEST(LeafRegime, IsTheSameWithShortSteps) {
  const std::vector<Fall> usual = many({}, 60);
  const std::vector<Fall> fine = many({}, 30, 0.001);
  // Single falls of ten seconds spread by 0.035 m/s and 0.35 stalls a second: four standard errors of the difference.
  EXPECT_NEAR(mean(usual, &Fall::descent), mean(fine, &Fall::descent), 4 * 0.035 * std::sqrt(1 / 60.0 + 1 / 30.0));
  EXPECT_NEAR(mean(usual, &Fall::stalls), mean(fine, &Fall::stalls), 4 * 0.35 * std::sqrt(1 / 60.0 + 1 / 30.0));
}

}  // namespace
}  // namespace wisp::leaf_regime_test
