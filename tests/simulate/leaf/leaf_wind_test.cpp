// Wind over place and time.

#include "simulate/leaf/leaf_flight.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace wisp::leaf_wind_test {
namespace {

using Triple = std::array<double, 3>;

TEST(LeafWind, ThatIsCalmIsNothingAnywhere) {
  const LeafWind wind;
  EXPECT_TRUE(wind.calm());
  EXPECT_EQ(wind.at({1, 2, 3}, {1, 0, 0}, 5).velocity, (Triple{0, 0, 0}));
}

// What a leaf that moves on a straight line feels, against differences of the wind along that line.
double worst_slope_error(const LeafWind& wind) {
  const Triple moving{0.7, -0.4, -0.8};
  double worst = 0;
  const double h = 1e-6;
  for (int k = 0; k < 2000; ++k) {
    const double t = 0.0131 * k;
    const auto place = [&](double at) { return Triple{moving[0] * at, 0.3 + moving[1] * at, moving[2] * at}; };
    const WindSample here = wind.at(place(t), moving, t);
    const WindSample before = wind.at(place(t - h), moving, t - h), after = wind.at(place(t + h), moving, t + h);
    for (std::size_t i = 0; i < 3; ++i) {
      worst = std::max(worst, std::abs((after.velocity[i] - before.velocity[i]) / (2 * h) - here.change[i]));
    }
  }
  return worst;
}

TEST(LeafWind, ThatWasMeasuredPassesThroughItsRowsAndHoldsBeyondThem) {
  const LeafWind wind = LeafWind::of_track({.rows = {{1, 0, 0}, {2, 0, 0}, {0, -1, 0}}, .rate_hz = 10, .begins = 5});
  EXPECT_FALSE(wind.calm());
  EXPECT_NEAR(wind.at({3, 0, 1}, {}, 5.1).velocity[0], 2, 1e-12);
  EXPECT_NEAR(wind.at({}, {}, 5.2).velocity[1], -1, 1e-12);
  EXPECT_EQ(wind.at({}, {}, 4).velocity, (Triple{1, 0, 0}));
  EXPECT_EQ(wind.at({}, {}, 9).velocity, (Triple{0, -1, 0}));
  EXPECT_EQ(wind.at({}, {}, 9).change, (Triple{0, 0, 0}));
}

TEST(LeafWind, KnowsHowItChangesAlongTheLeafsWay) {
  // Central differences of 1e-6 s leave rounding of 1e-10; a gust's edge has a jump of its slope's slope of about
  // 1e4 m/s³, which shows as 1e-2 only in the step that meets it.
  std::vector<Triple> rows;
  for (int k = 0; k < 1000; ++k) rows.push_back({std::sin(0.3 * k), std::cos(0.2 * k), 0.1 * (k % 7)});
  // The slope of a cubic's slope jumps by about 1e3 m/s³ at a row, which shows as 1e-3 in the step that meets it.
  EXPECT_LT(worst_slope_error(LeafWind::of_track({.rows = rows, .rate_hz = 30, .begins = 0.01})), 1e-2);
  EXPECT_LT(worst_slope_error(LeafWind::gusty(3, 60)), 1e-2);
}

TEST(LeafWind, TravelsInGusts) {
  const LeafWind wind = LeafWind::of_gusts(
      {{.start = 1, .seconds = 0.4, .edge = 0.05, .velocity = {1.5, 0, 0}, .slowness = {0.125, 0, 0}}});
  EXPECT_EQ(wind.at({}, {}, 0.99).velocity[0], 0);
  EXPECT_EQ(wind.at({}, {}, 1.2).velocity[0], 1.5);
  EXPECT_EQ(wind.at({}, {}, 1.41).velocity[0], 0);
  // Four metres on it comes half a second later.
  EXPECT_EQ(wind.at({4, 0, 0}, {}, 1.2).velocity[0], 0);
  EXPECT_EQ(wind.at({4, 0, 0}, {}, 1.7).velocity[0], 1.5);
}

TEST(LeafWind, HasRestsBetweenGusts) {
  const LeafWind wind = LeafWind::gusty(3, 600);
  int still = 0;
  for (int k = 0; k < 60000; ++k) still += wind.at({}, {}, 0.01 * k).velocity == Triple{0, 0, 0};
  // Gusts of 0.36 s and rests of 1.5 s on average.
  EXPECT_NEAR(still / 60000.0, 1.5 / 1.86, 0.05);
}

}  // namespace
}  // namespace wisp::leaf_wind_test
