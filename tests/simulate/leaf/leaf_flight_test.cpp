// One fall.

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

LeafState after(double seconds, double longest_step, const LeafWind& wind = {}) {
  auto flight = LeafFlight::begin({}, wind, tilted(), longest_step);
  EXPECT_TRUE(flight->advance(seconds));
  return flight->state();
}

double distance(const LeafState& a, const LeafState& b) {
  double square = 0;
  for (std::size_t k = 0; k < 3; ++k) square += std::pow(a.position[k] - b.position[k], 2);
  return std::sqrt(square);
}

TEST(LeafFlight, HasTheOrderOfItsMethod) {
  const LeafState reference = after(0.2, 1e-4);
  const double gain = distance(reference, after(0.2, 4e-3)) / distance(reference, after(0.2, 2e-3));
  EXPECT_NEAR(std::log2(gain), 4, 0.5);
}

TEST(LeafFlight, NeverGainsEnergyInStillAir) {
  const Leaf leaf;
  const LeafWind calm;
  for (const double longest_step : {1e-4, 1e-3}) {
    auto flight = LeafFlight::begin(leaf, calm, tilted(), longest_step);
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
  for (const double longest_step : {1e-3, 1.0 / 60}) {
    auto flight = LeafFlight::begin({}, calm, tilted(), longest_step);
    for (int frame = 0; frame < 600; ++frame) {
      ASSERT_TRUE(flight->advance(1.0 / 60));
      const auto& q = flight->state().attitude;
      ASSERT_NEAR(std::hypot(std::hypot(q[0], q[1]), std::hypot(q[2], q[3])), 1, 1e-9);
    }
  }
}

TEST(LeafFlight, FindsTheSameStallsWithLongAndShortSteps) {
  const LeafWind calm;
  auto by_short = LeafFlight::begin({}, calm, tilted(), 1e-5);
  auto by_long = LeafFlight::begin({}, calm, tilted(), 5e-4);
  ASSERT_TRUE(by_short->advance(0.6));
  ASSERT_TRUE(by_long->advance(0.6));
  ASSERT_GE(by_short->stalls().size(), 2u);
  ASSERT_EQ(by_short->stalls().size(), by_long->stalls().size());
  for (std::size_t k = 0; k < by_short->stalls().size(); ++k)
    EXPECT_NEAR(by_short->stalls()[k], by_long->stalls()[k], 1e-5);
}

LeafWind steady(double speed) { return LeafWind::of_track({.rows = {{speed, 0, 0}}}); }

TEST(LeafFlight, IsAsExactInStrongWindAsInAWeakOne) {
  // Steps of 1/60 s would leave the first at metres from the reference, and the second not finite.
  for (const double speed : {4.0, 15.0, 30.0}) {
    const LeafWind wind = steady(speed);
    EXPECT_LT(distance(after(0.1, 1e-4, wind), after(0.1, 1.0 / 60, wind)), 0.01) << speed;
    EXPECT_GT(distance(after(0.1, 1e-4, wind), after(0.1, 1e-4)), 0.1) << speed;
  }
}

TEST(LeafFlight, ThatCannotBeginIsExplained) {
  const LeafWind calm;
  LeafState state;
  state.spin[0] = std::nan("");
  EXPECT_THAT(LeafFlight::begin({}, calm, state).error().message, HasSubstr("not finite"));
  state = {};
  state.attitude = {};
  EXPECT_THAT(LeafFlight::begin({}, calm, state).error().message, HasSubstr("no length"));
  EXPECT_THAT(LeafFlight::begin({}, calm, {}, 1).error().message, HasSubstr("longest_step"));
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
  auto flight = LeafFlight::begin({}, calm, state, 0.05);
  Result<void> good;
  for (int k = 0; k < 50 && good; ++k) good = flight->advance(0.05);
  ASSERT_FALSE(good);
  EXPECT_THAT(good.error().message, HasSubstr("no longer finite"));
}

TEST(LeafFlight, AStrongWindCarriesTheLeafAlong) {
  for (double speed : {3.0, 10.0, 30.0}) {
    const LeafWind wind = steady(speed);
    auto flight = LeafFlight::begin({}, wind, tilted());
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
