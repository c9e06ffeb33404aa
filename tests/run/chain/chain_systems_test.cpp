// Chains whose modes are systems: what they must keep of what chains promise.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "model/sample_chain.hpp"
#include "wisp/run/bank.hpp"
#include "wisp/run/chain_facet.hpp"
#include "wisp/run/cost.hpp"

namespace wisp::chain_systems_test {
namespace {

using Pose = std::array<float, 7>;

Bank bank_of(const Model& model, int capacity = 1) {
  auto bank = Bank::create(model, {.capacity = capacity, .seed = 3});
  EXPECT_TRUE(bank) << bank.error().message;
  for (int k = 0; k < capacity; ++k) bank->spawn();
  return std::move(bank).value();
}

Pose pose_of(const Bank& bank, int slot = 0) {
  Pose pose{};
  EXPECT_TRUE(bank.outputs(bank.at(slot), pose));
  return pose;
}

double distance(const Pose& a, const Pose& b) { return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]); }

TEST(ChainSystems, NeverMoveFasterThanTheirRange) {
  for (int degree : {1, 2}) {
    Bank bank = bank_of(system_chain(degree));
    Pose before = pose_of(bank);
    for (int step = 0; step < 20'000; ++step) {
      bank.step();
      const Pose now = pose_of(bank);
      // 1.5 m/s along each axis of the body.
      ASSERT_LE(distance(before, now), 1.5 * std::sqrt(3.0) / 60 + 1e-4) << step;
      double square = 0;
      for (std::size_t k = 3; k < 7; ++k) square += now[k] * now[k];
      ASSERT_NEAR(square, 1, 1e-5) << step;
      before = now;
    }
  }
}

TEST(ChainSystems, FallTheWayThatIsDown) {
  Bank bank = bank_of(system_chain());
  for (int step = 0; step < 600; ++step) bank.step();
  // Velocities settle at 0.08 / (1 - 0.9) downwards.
  EXPECT_NEAR(pose_of(bank)[2], -8, 1);
}

TEST(ChainSystems, WithoutNoiseOneOfThemLivesAsAnotherDoes) {
  Bank bank = bank_of(system_chain(), 2);
  bank.set_noise(0);
  bank.reset();
  for (int step = 0; step < 300; ++step) bank.step();
  EXPECT_EQ(pose_of(bank, 0)[2], pose_of(bank, 1)[2]);
  EXPECT_FALSE(chain_loop(system_chain()));
}

TEST(ChainSystems, LiveTheSameLifeInABankOfAnySizeAndAfterRestoring) {
  const Model model = system_chain(2);
  Bank many = bank_of(model, 11), other = bank_of(model, 11);
  auto one = Bank::create(model, {.seed = 3});
  one->spawn(10);
  for (int step = 0; step < 50; ++step) {
    many.step();
    one->step();
  }
  std::vector<std::byte> saved(many.save_bytes());
  many.save(saved);
  ASSERT_TRUE(other.restore(saved));
  for (int step = 0; step < 100; ++step) {
    many.step();
    one->step();
    other.step();
    ASSERT_EQ(pose_of(many, 10), pose_of(*one));
    ASSERT_EQ(pose_of(many, 4), pose_of(other, 4));
  }
}

TEST(ChainSystems, GoOnFromWhereTheyArePlacedAndComeToRest) {
  Bank bank = bank_of(system_chain());
  ASSERT_TRUE(bank.chain()->place(bank.at(0), {.position = {1, 2, 3}, .velocity = {0.5f, 0, -0.5f}}));
  const Pose placed = pose_of(bank);
  bank.step();
  EXPECT_NEAR((pose_of(bank)[0] - placed[0]) * 60, 0.5, 0.15);
  bank.chain()->set_ground(0.0f);
  for (int step = 0; step < 900; ++step) bank.step();
  EXPECT_EQ(pose_of(bank)[2], 0.0f);
}

TEST(ChainSystems, CostWhatTheirTermsDo) {
  const auto linear = count_operations(system_chain(1)), ode = count_operations(system_chain(2));
  ASSERT_TRUE(linear && ode);
  // A product and a sum for each of six states and of the 45 products, and those products.
  EXPECT_EQ(ode->operations_per_frame - linear->operations_per_frame, 45 * 13);
}

}  // namespace
}  // namespace wisp::chain_systems_test
