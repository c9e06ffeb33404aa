// One fall, by both integrators.

#include "simulate/leaf/leaf_flight.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace wisp::leaf_flight_test {
namespace {

using testing::HasSubstr;

LeafState tilted() {
  LeafState state;
  state.attitude = {std::cos(0.3), std::sin(0.3) * 0.8, std::sin(0.3) * 0.6, 0};
  state.spin = {0.5, -0.3, 0.2};
  return state;
}

LeafStepping stiff(double tolerance = 1e-8) { return {.method = LeafMethod::kStiff, .tolerance = tolerance}; }

LeafState after(double seconds, const LeafStepping& stepping, const LeafWind& wind = {}) {
  auto flight = LeafFlight::begin({}, wind, tilted(), stepping);
  EXPECT_TRUE(flight->advance(seconds));
  return flight->state();
}

double distance(const LeafState& a, const LeafState& b) {
  double square = 0;
  for (std::size_t k = 0; k < 3; ++k) square += std::pow(a.position[k] - b.position[k], 2);
  return std::sqrt(square);
}

TEST(LeafFlight, ComesToTheSamePlaceByEveryMethodWhereStepsAreSmall) {
  // Before chaos has grown anything: a third of a second.
  const LeafState reference = after(0.3, stiff(1e-11));
  EXPECT_LT(distance(reference, after(0.3, {LeafMethod::kClassical, 1e-3})), 1e-8);
}

TEST(LeafFlight, HasTheOrderOfItsMethod) {
  const LeafState reference = after(0.2, {LeafMethod::kClassical, 1e-4});
  const auto gain = [&](LeafMethod method) {
    return distance(reference, after(0.2, {method, 4e-3})) / distance(reference, after(0.2, {method, 2e-3}));
  };
  EXPECT_NEAR(std::log2(gain(LeafMethod::kClassical)), 4, 0.5);
}

TEST(LeafFlight, NeverGainsEnergyInStillAir) {
  const Leaf leaf;
  const LeafWind calm;
  for (const LeafStepping& stepping : {stiff(), LeafStepping{LeafMethod::kClassical, 1e-3}}) {
    auto flight = LeafFlight::begin(leaf, calm, tilted(), stepping);
    double energy = leaf_energy(leaf, flight->state());
    for (int frame = 0; frame < 600; ++frame) {
      ASSERT_TRUE(flight->advance(1.0 / 60));
      const double next = leaf_energy(leaf, flight->state());
      // The method's own error in a frame: 1e-8 of an energy of motion of 1e-4 J, a few times over.
      ASSERT_LE(next, energy + 1e-10) << frame;
      energy = next;
    }
    EXPECT_LT(energy, -1e-3);
  }
}

TEST(LeafFlight, HoldsTheAttitudeToLengthOne) {
  const LeafWind calm;
  for (const LeafStepping& stepping : {stiff(), LeafStepping{}}) {
    auto flight = LeafFlight::begin({}, calm, tilted(), stepping);
    for (int frame = 0; frame < 600; ++frame) {
      ASSERT_TRUE(flight->advance(1.0 / 60));
      const auto& q = flight->state().attitude;
      ASSERT_NEAR(std::hypot(std::hypot(q[0], q[1]), std::hypot(q[2], q[3])), 1, 1e-9);
    }
  }
}

TEST(LeafFlight, FindsTheSameStallsByRootsAndBetweenSteps) {
  const LeafWind calm;
  auto by_roots = LeafFlight::begin({}, calm, tilted(), stiff());
  auto by_steps = LeafFlight::begin({}, calm, tilted(), {LeafMethod::kClassical, 5e-4});
  ASSERT_TRUE(by_roots->advance(0.6));
  ASSERT_TRUE(by_steps->advance(0.6));
  ASSERT_GE(by_roots->stalls().size(), 2u);
  ASSERT_EQ(by_roots->stalls().size(), by_steps->stalls().size());
  for (std::size_t k = 0; k < by_roots->stalls().size(); ++k)
    EXPECT_NEAR(by_roots->stalls()[k], by_steps->stalls()[k], 1e-5);
}

TEST(LeafFlight, FollowsAWindAlikeByBothMethods) {
  LeafWindOptions options;
  options.kind = LeafWindKind::kTurbulence;
  const LeafWind wind = *LeafWind::create(options, 1);
  EXPECT_LT(distance(after(0.25, stiff(1e-11), wind), after(0.25, {LeafMethod::kClassical, 5e-4}, wind)), 1e-7);
  EXPECT_GT(distance(after(0.25, {}, wind), after(0.25, {})), 0.01);
}

TEST(LeafFlight, EvaluatesFourTimesAStep) {
  const LeafWind calm;
  auto flight = LeafFlight::begin({}, calm, tilted());
  ASSERT_TRUE(flight->advance(1));
  EXPECT_EQ(flight->evaluations(), 240);
  EXPECT_NEAR(flight->seconds(), 1, 1e-12);
}

TEST(LeafFlight, ThatCannotBeginIsExplained) {
  const LeafWind calm;
  LeafState state;
  state.spin[0] = std::nan("");
  EXPECT_THAT(LeafFlight::begin({}, calm, state).error().message, HasSubstr("not finite"));
  state = {};
  state.attitude = {};
  EXPECT_THAT(LeafFlight::begin({}, calm, state).error().message, HasSubstr("no length"));
  EXPECT_THAT(LeafFlight::begin({}, calm, {}, {.longest_step = 1}).error().message, HasSubstr("longest_step"));
  Leaf leaf;
  leaf.areal_density = -1;
  EXPECT_THAT(LeafFlight::begin(leaf, calm, {}).error().message, HasSubstr("areal density"));
}

TEST(LeafFlight, ThatBlowsUpSaysSo) {
  // Steps far beyond what the decay of a huge spin allows.
  const LeafWind calm;
  LeafState state;
  state.spin = {1e6, 1e6, 0};
  state.velocity = {1e5, 0, 1e5};
  auto flight = LeafFlight::begin({}, calm, state, {.longest_step = 0.05});
  Result<void> good;
  for (int k = 0; k < 50 && good; ++k) good = flight->advance(0.05);
  ASSERT_FALSE(good);
  EXPECT_THAT(good.error().message, HasSubstr("no longer finite"));
}

TEST(LeafFlight, AStrongWindCarriesTheLeafAlong) {
  for (double speed : {3.0, 10.0, 30.0}) {
    const auto wind = LeafWind::create({.kind = LeafWindKind::kConstant, .speed = speed}, 0);
    ASSERT_TRUE(wind);
    auto flight = LeafFlight::begin({}, *wind, tilted(), {});
    ASSERT_TRUE(flight);
    for (int frame = 0; frame < 600; ++frame) {
      const auto moved = flight->advance(1.0 / 60);
      ASSERT_TRUE(moved) << speed << " m/s: " << moved.error().message;
      const auto velocity = leaf_world_velocity(flight->state());
      EXPECT_LT(std::hypot(velocity[0], velocity[1], velocity[2]), 1.2 * speed + 3) << speed << " m/s";
    }
    EXPECT_NEAR(leaf_world_velocity(flight->state())[0], speed, 2.5);
  }
}

}  // namespace
}  // namespace wisp::leaf_flight_test
