// How instances of a chain move, when they land, and that steering ends where it is asked.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <vector>

#include "base/statistics.hpp"
#include "paths.hpp"
#include "wisp/model/file.hpp"
#include "wisp/run/bank.hpp"
#include "wisp/run/chain_facet.hpp"

namespace wisp::chain_motion_test {
namespace {

using Pose = std::array<float, 7>;

Bank leaves(int count, std::uint64_t seed = 1) {
  auto bank =
      Bank::create(*read_model(WISP_SOURCE_DIR "/apps/web/public/models/leaf.wisp"), {.capacity = count, .seed = seed});
  EXPECT_TRUE(bank) << bank.error().message;
  for (int k = 0; k < count; ++k) bank->spawn();
  return std::move(bank).value();
}

Pose pose_of(const Bank& bank, int slot = 0) {
  Pose pose{};
  EXPECT_TRUE(bank.outputs(bank.at(slot), pose));
  return pose;
}

double seconds_of(const Bank& bank) { return std::chrono::duration<double>(bank.step_time()).count(); }

TEST(ChainMotion, IsTheDifferenceOfTwoSamples) {
  Bank bank = leaves(11);
  double fastest = 0;
  for (int frame = 0; frame < 300; ++frame) {
    const Pose a = pose_of(bank, 10);
    bank.step();
    const Pose b = pose_of(bank, 10);
    const ChainPlace place = *bank.chain()->place_of(bank.at(10));
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(place.velocity[k], (b[k] - a[k]) / seconds_of(bank), 1e-2);
    // The spin, played for the time of a step, turns the one attitude into the other.
    const double angle = std::hypot(place.spin[0], place.spin[1], place.spin[2]) * seconds_of(bank) / 2;
    fastest = std::max(fastest, angle);
    const double w = std::cos(angle), s = angle > 1e-9 ? std::sin(angle) / angle * seconds_of(bank) / 2 : 0;
    const double x = s * place.spin[0], y = s * place.spin[1], z = s * place.spin[2];
    const std::array turned{w * a[3] - x * a[4] - y * a[5] - z * a[6], w * a[4] + x * a[3] + y * a[6] - z * a[5],
                            w * a[5] - x * a[6] + y * a[3] + z * a[4], w * a[6] + x * a[5] - y * a[4] + z * a[3]};
    double along = 0;
    for (std::size_t k = 0; k < 4; ++k) along += turned[k] * b[3 + k];
    EXPECT_GT(std::abs(along), 1 - 2e-4) << frame;
  }
  EXPECT_GT(fastest, 0.01);
}

TEST(ChainMotion, LandsOnceAndThenLies) {
  Bank bank = leaves(8);
  bank.chain()->set_ground(-1.0f);
  std::array<int, 8> landings{};
  std::array<bool, 8> lay{};
  for (int frame = 0; frame < 300; ++frame) {
    bank.advance(0.05);
    for (int slot = 0; slot < 8; ++slot) {
      const ChainPlace place = *bank.chain()->place_of(bank.at(slot));
      landings[static_cast<std::size_t>(slot)] += place.landed ? 1 : 0;
      EXPECT_FALSE(place.landed && place.lies);
      if (lay[static_cast<std::size_t>(slot)]) {
        for (const float v : place.velocity) EXPECT_EQ(v, 0);
      }
      lay[static_cast<std::size_t>(slot)] = place.lies;
    }
  }
  for (int slot = 0; slot < 8; ++slot) {
    EXPECT_EQ(landings[static_cast<std::size_t>(slot)], 1);
    EXPECT_TRUE(bank.chain()->place_of(bank.at(slot))->lies);
  }
  bank.advance(5.0);
  EXPECT_FALSE(bank.chain()->place_of(bank.at(0))->landed);
}

// Targets are where other falls end by themselves.
TEST(ChainSteering, EndsWhereItIsAsked) {
  constexpr int kFalls = 64;
  Bank other = leaves(kFalls, 2), bank = leaves(kFalls, 3);
  const auto steps = static_cast<int>(std::lround(4 / seconds_of(bank)));
  for (int k = 0; k < steps; ++k) other.step();
  for (int k = 0; k < kFalls; ++k) {
    const Pose end = pose_of(other, k);
    ASSERT_TRUE(bank.chain()->steer(bank.at(k), {{end[0], end[1], end[2]}, std::chrono::seconds(4)}));
  }
  double fastest = 0, usual = 0;
  for (int k = 0; k < steps; ++k) {
    bank.step();
    for (int slot = 0; slot < kFalls; ++slot) {
      const auto v = bank.chain()->place_of(bank.at(slot))->velocity;
      double& most = k > steps - 60 ? fastest : usual;
      most = std::max<double>(most, std::hypot(v[0], v[1], v[2]));
    }
  }
  std::vector<double> misses;
  for (int k = 0; k < kFalls; ++k) {
    const Pose a = pose_of(bank, k), b = pose_of(other, k);
    misses.push_back(std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]));
  }
  EXPECT_LT(median(misses), 0.03);
  EXPECT_LT(quantile(misses, 0.9), 0.1);
  EXPECT_LT(fastest, 2 * usual);
  ::testing::Test::RecordProperty("median", std::to_string(median(misses)));
  std::printf("steered: median %.3f m, 90th percentile %.3f m, fastest %.2f, before %.2f m/s\n", median(misses),
              quantile(misses, 0.9), fastest, usual);
}

// Where steering ends, velocities change by more than they do anyway, since a join in the last tenth of a second moves
// the expected end by centimetres.
TEST(ChainSteering, LetsGoWithoutAGreatKick) {
  constexpr int kFalls = 64;
  Bank other = leaves(kFalls, 4), bank = leaves(kFalls, 5);
  const auto steps = static_cast<int>(std::lround(4 / seconds_of(bank)));
  for (int k = 0; k < steps; ++k) other.step();
  for (int k = 0; k < kFalls; ++k) {
    const Pose end = pose_of(other, k);
    ASSERT_TRUE(bank.chain()->steer(bank.at(k), {{end[0], end[1], end[2]}, std::chrono::seconds(4)}));
  }
  std::vector<double> usual, kicks;
  std::array<std::array<float, 3>, kFalls> before{};
  for (int k = 0; k < steps + 2; ++k) {
    bank.step();
    for (std::size_t slot = 0; slot < kFalls; ++slot) {
      const auto v = bank.chain()->place_of(bank.at(static_cast<int>(slot)))->velocity;
      const double change = std::hypot(v[0] - before[slot][0], v[1] - before[slot][1], v[2] - before[slot][2]);
      if (k > 1) (k < steps - 60 ? usual : kicks).push_back(k < steps - 60 || k >= steps ? change : 0);
      std::copy_n(v.begin(), 3, before[slot].begin());
    }
  }
  std::erase(kicks, 0.0);
  std::printf("velocities change by %.3f m/s a step, at the end of steering by %.3f; at most %.2f and %.2f\n",
              quantile(usual, 0.9), quantile(kicks, 0.9), quantile(usual, 0.999), quantile(kicks, 0.999));
  EXPECT_LT(quantile(kicks, 0.9), 2.75 * quantile(usual, 0.9));
}

}  // namespace
}  // namespace wisp::chain_motion_test
