#include "simulate/candle/wind_signal.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace wisp::wind_signal_test {
namespace {

using testing::HasSubstr;

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

TEST(WindSignal, GustsStayBetweenCalmAndTheirMostAndRest) {
  const WindSignal wind = *WindSignal::generate({}, 120);
  EXPECT_EQ(*std::min_element(wind.samples().begin(), wind.samples().end()), 0);
  const double most = *std::max_element(wind.samples().begin(), wind.samples().end());
  EXPECT_LE(most, 1);
  EXPECT_GT(most, 0.9);
  const auto calm = std::count(wind.samples().begin(), wind.samples().end(), 0.0);
  const double share = static_cast<double>(calm) / static_cast<double>(wind.samples().size());
  EXPECT_GT(share, 0.15);
  EXPECT_LT(share, 0.5);
}

// Wideband: what changes between two samples 1/12 s apart is about as large as the wind itself.
TEST(WindSignal, GustsAreWideband) {
  const WindSignal wind = *WindSignal::generate({.rest_share = 0}, 60);
  double change = 0;
  double variance = 0;
  double mean = 0;
  int count = 0;
  for (double t = 0; t < 59; t += 0.05, ++count) mean += wind.at(t);
  mean /= count;
  for (double t = 0; t < 59; t += 0.05) {
    change += std::pow(wind.at(t + 1.0 / 12) - wind.at(t), 2);
    variance += std::pow(wind.at(t) - mean, 2);
  }
  EXPECT_GT(change, variance);
}

TEST(WindSignal, BlowsFromBothSidesOnlyWhenAsked) {
  const WindSignal both = *WindSignal::generate({.both_sides = true}, 60);
  EXPECT_LT(*std::min_element(both.samples().begin(), both.samples().end()), -0.5);
  EXPECT_GT(*std::max_element(both.samples().begin(), both.samples().end()), 0.5);
}

TEST(WindSignal, IsTheSameForASeedAndAnotherForAnother) {
  EXPECT_EQ(WindSignal::generate({.seed = 4}, 10)->samples(), WindSignal::generate({.seed = 4}, 10)->samples());
  EXPECT_NE(WindSignal::generate({.seed = 4}, 10)->samples(), WindSignal::generate({.seed = 5}, 10)->samples());
}

TEST(WindSignal, DraughtsAreWeakAndSlowAndFromBothSidesWhateverTheGusts) {
  const WindSignal wind = *WindSignal::generate({.kind = WindKind::kDraughts, .most = 5, .gust = 2, .seed = 3}, 60);
  EXPECT_LT(*std::min_element(wind.samples().begin(), wind.samples().end()), -0.02);
  EXPECT_GE(*std::min_element(wind.samples().begin(), wind.samples().end()), -0.05);
  EXPECT_GT(*std::max_element(wind.samples().begin(), wind.samples().end()), 0.02);
  EXPECT_LE(*std::max_element(wind.samples().begin(), wind.samples().end()), 0.05);
  double change = 0, square = 0;
  for (double t = 0; t < 59; t += 0.05) {
    change += std::pow(wind.at(t + 1.0 / 12) - wind.at(t), 2);
    square += std::pow(wind.at(t), 2);
  }
  EXPECT_LT(change, 0.3 * square);
  EXPECT_NE(wind.samples(), WindSignal::generate({.kind = WindKind::kDraughts, .seed = 4}, 60)->samples());
}

TEST(WindSignal, CalmIsCalm) {
  const WindSignal wind = *WindSignal::generate({.kind = WindKind::kCalm}, 5);
  EXPECT_EQ(std::count(wind.samples().begin(), wind.samples().end(), 0.0),
            static_cast<std::ptrdiff_t>(wind.samples().size()));
}

TEST(WindSignal, BlowsOutWhenAskedAndSaysWhenToLightAgain) {
  const WindSignal wind = *WindSignal::generate({.blow_out_at = 4, .relight_after = 1.5}, 10);
  EXPECT_EQ(wind.at(3.8), 0);
  EXPECT_NEAR(wind.at(4.15), 3, 1e-9);
  EXPECT_EQ(wind.at(5), 0);
  EXPECT_EQ(wind.relights(), std::vector<double>{5.5});
  EXPECT_TRUE(WindSignal::generate({.blow_out_at = 4, .relight_after = -1}, 10)->relights().empty());
}

TEST(WindSignal, APuffAfterTheEndIsAnError) {
  const auto late = WindSignal::generate({.blow_out_at = 10}, 10);
  ASSERT_FALSE(late);
  EXPECT_EQ(late.error().message, "wind: a puff at 10 s is not before its end at 10 s");
  EXPECT_FALSE(WindSignal::generate({.puff_every = 60}, 10));
}

TEST(WindSignal, PuffsVaryAndTheCandleIsLitAgainAfterEach) {
  const WindSignal wind = *WindSignal::generate({.puff_every = 5, .relight_after = 1.5}, 22);
  EXPECT_EQ(wind.relights(), (std::vector<double>{6.5, 11.5, 16.5, 21.5}));
  std::vector<double> peaks;
  for (double at : {5.0, 10.0, 15.0, 20.0}) {
    EXPECT_EQ(wind.at(at - 0.2), 0);
    EXPECT_EQ(wind.at(at + 1.6), 0);
    double peak = 0;
    for (double t = at; t < at + 0.7; t += 0.005) peak = std::max(peak, wind.at(t));
    EXPECT_GE(peak, 1.1);
    EXPECT_LE(peak, 4.0);
    peaks.push_back(peak);
  }
  EXPECT_GT(*std::max_element(peaks.begin(), peaks.end()) - *std::min_element(peaks.begin(), peaks.end()), 0.5);
}

TEST(WindSignal, PuffsThatFollowTooCloselyAreRefused) {
  EXPECT_FALSE(WindSignal::generate({.puff_every = 1}, 10));
  EXPECT_FALSE(WindSignal::generate({.puff_every = -1}, 10));
}

TEST(WindSignal, TakesARecordingsChannelAndBridgesItsGaps) {
  Recording recording;
  recording.source = "wind.csv";
  recording.rate_hz = 2;
  recording.channels = {{"wind", "m/s", Role::kInput, {kMissing, 1, kMissing, 3, kMissing}}};
  const WindSignal wind = *WindSignal::from_recording(recording);
  EXPECT_DOUBLE_EQ(wind.at(0), 1);
  EXPECT_DOUBLE_EQ(wind.at(0.75), 1.5);
  EXPECT_DOUBLE_EQ(wind.at(1), 2);
  EXPECT_DOUBLE_EQ(wind.at(99), 3);
}

TEST(WindSignal, SaysWhatARecordingLacks) {
  Recording recording;
  recording.source = "wind.csv";
  recording.rate_hz = 2;
  recording.channels = {{"a", "", Role::kInput, {1}}, {"b", "", Role::kInput, {kMissing}}};
  EXPECT_THAT(WindSignal::from_recording(recording).error().message, HasSubstr("2 input channels"));
  recording.channels.erase(recording.channels.begin());
  EXPECT_THAT(WindSignal::from_recording(recording).error().message, HasSubstr("no samples"));
}

TEST(WindSignal, ARecordedWindBeyondTheStrongestIsRefused) {
  Recording recording;
  recording.source = "wind.csv";
  recording.rate_hz = 2;
  recording.channels = {{"wind", "cm/s", Role::kInput, {10, kMissing, -40}}};
  EXPECT_EQ(WindSignal::from_recording(recording).error().message,
            "wind.csv: wind in row 2 is -15.000000, expected a wind within 10 m/s");
  recording.channels[0].samples[2] = -10;
  EXPECT_TRUE(WindSignal::from_recording(recording));
}

TEST(WindSignal, SaysWhichOptionIsWrong) {
  EXPECT_THAT(WindSignal::generate({.rest_share = 1}, 5).error().message, HasSubstr("rest_share"));
}

}  // namespace
}  // namespace wisp::wind_signal_test
