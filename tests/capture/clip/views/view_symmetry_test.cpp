#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "capture/clip/views/view_join.hpp"

namespace wisp::view_symmetry_test {
namespace {

// A body that leans less for each 1 of wind where it blows harder, and by chance; `once` and `twice` a turn it leans
// further by that share.
std::vector<BlowAnswer> drawn_blows(std::size_t count, double once, double twice, unsigned seed) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> any(0, 1);
  std::normal_distribution<double> chance(0, 0.08);
  std::vector<BlowAnswer> out;
  for (std::size_t k = 0; k < count; ++k) {
    const double azimuth =
                     2 * std::numbers::pi * (static_cast<double>(k) + any(generator)) / static_cast<double>(count),
                 strength = 0.3 + 0.6 * any(generator);
    const double all_round = 80 * (1 - 0.4 * strength);
    const double side = 1 + once * std::cos(azimuth - 1) + twice * std::cos(2 * azimuth + 0.3);
    out.push_back({azimuth, strength, all_round * (side + chance(generator))});
  }
  return out;
}

TEST(Asymmetry, ABodyThatIsTheSameFromAllSidesIsFoundToDifferInAtMostOneOfTwentyCases) {
  int differs = 0;
  for (unsigned seed = 0; seed < 400; ++seed) {
    const auto found = asymmetry_of(drawn_blows(seed % 2 == 0 ? 12 : 30, 0, 0, seed));
    ASSERT_TRUE(found);
    differs += (*found)[1] > 0 ? 1 : 0;
  }
  EXPECT_LE(differs, 32);  // of 20; more in one of 200 runs
}

TEST(Asymmetry, ABodyThatLeansFurtherOneWayIsFoundToDifferByThatMuch) {
  const double truth = 20 / std::numbers::sqrt2;
  int differs = 0, held = 0;
  double sum = 0;
  for (unsigned seed = 0; seed < 200; ++seed) {
    const auto found = asymmetry_of(drawn_blows(30, seed % 2 == 0 ? 0.2 : 0, seed % 2 == 0 ? 0 : 0.2, seed));
    ASSERT_TRUE(found);
    const auto [share, low, high] = *found;
    differs += low > 0 ? 1 : 0;
    held += low <= truth && truth <= high ? 1 : 0;
    sum += share;
  }
  EXPECT_GE(differs, 190);
  EXPECT_GE(held, 185);
  EXPECT_NEAR(sum / 200, truth, 1);
}

TEST(Asymmetry, NothingIsSaidOfFewBlowsOrOfTwoDirections) {
  EXPECT_FALSE(asymmetry_of(drawn_blows(kMinSymmetryBlows - 1, 0, 0, 1)));
  auto blows = drawn_blows(20, 0, 0, 1);
  for (std::size_t k = 0; k < blows.size(); ++k) blows[k].azimuth = k % 2 == 0 ? 0 : 1.5;
  EXPECT_FALSE(asymmetry_of(blows));
}

}  // namespace
}  // namespace wisp::view_symmetry_test
