#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "learn/outline/outline_units.hpp"
#include "wisp/learn/advice.hpp"

namespace wisp::outline_motion_test {
namespace {

using testing::HasSubstr;

// A flame of a triangle's shape whose height swings by a tenth at `hz` after `phase` degrees, with noise of a
// hundredth; without hz it is noise alone. It leans to the right by 10 degrees.
Recording flickering(double hz, double phase, std::uint64_t seed, std::size_t rows = 1000) {
  constexpr double kRate = 50;
  std::mt19937_64 random(seed);
  std::normal_distribution<double> noise(0, 0.01);
  Recording out{.source = "flame.csv", .rate_hz = kRate};
  const double shape[5][2] = {{-10, 0}, {-12, 30}, {0, 100}, {12, 30}, {10, 0}};
  for (const std::string& name : outline_outputs(5)) out.channels.push_back({name, "px", Role::kOutput, {}});
  for (std::size_t row = 0; row < rows; ++row) {
    const double turn = 2 * std::numbers::pi * hz * static_cast<double>(row) / kRate - phase * std::numbers::pi / 180;
    const double size = 1 + (hz > 0 ? 0.1 * std::sin(turn) : 0) + noise(random);
    for (std::size_t k = 0; k < 5; ++k) {
      const double up = size * shape[k][1];
      out.channels[2 * k].samples.push_back(200 + shape[k][0] + up * std::tan(10 * std::numbers::pi / 180));
      out.channels[2 * k + 1].samples.push_back(300 - up);
    }
  }
  return out;
}

double figure(const Report& report, const char* id) {
  const ReportEntry* entry = report.find(id);
  return entry ? std::get<double>(static_cast<const ReportValue::Base&>(entry->value)) : std::nan("");
}

TEST(OutlineMotion, FindsTheFrequencyOfAFlickerAndTheMeanLean) {
  for (const double hz : {3.0, 11.0, 17.0}) {
    const Recording flame = flickering(hz, 0, 1);
    const auto report = outline_motion({&flame, 1});
    ASSERT_TRUE(report) << report.error().message;
    EXPECT_NEAR(figure(*report, "flicker_hz"), hz, 0.13) << hz;
    EXPECT_NEAR(figure(*report, "flicker_width_hz"), 0.36, 0.1) << hz;  // a sine is as narrow as the window tells
    const auto& rows = report->sections.front().tables.front().rows;
    EXPECT_NEAR(std::get<double>(static_cast<const ReportValue::Base&>(rows[2][1])), 10, 0.3);
  }
}

// One of twenty has one by chance.
TEST(OutlineMotion, NoiseHasNoFrequencyOfItsOwn) {
  int found = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Recording flame = flickering(0, 0, seed);
    const auto report = outline_motion({&flame, 1});
    ASSERT_TRUE(report);
    found += report->find("flicker_hz") != nullptr;
  }
  EXPECT_LE(found, 2);
}

TEST(OutlineMotion, TwoFlamesByTurnsAreHalfATurnApart) {
  const Recording both[] = {flickering(11, 0, 1), flickering(11, 180, 2)};
  const auto report = outline_motion(both);
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_NEAR(std::abs(figure(*report, "phase")), 180, 5);
  EXPECT_GT(figure(*report, "coherence"), 0.9);
  EXPECT_THAT(report->find("coherence")->meaning, HasSubstr("they move together"));
  const Recording later[] = {flickering(11, 0, 1), flickering(11, 60, 2)};
  EXPECT_NEAR(figure(*outline_motion(later), "phase"), 60, 5);
}

TEST(OutlineMotion, TwoThatHaveNothingToDoWithEachOtherAreSaidToBe) {
  const Recording both[] = {flickering(11, 0, 1), flickering(0, 0, 2)};
  const auto report = outline_motion(both);
  ASSERT_TRUE(report);
  EXPECT_THAT(report->find("coherence")->meaning, HasSubstr("the phase says nothing"));
}

TEST(OutlineMotion, OneCommonWindowTellsNothing) {
  Recording both[] = {flickering(11, 0, 1), flickering(0, 0, 2)};
  for (Channel& one : both[1].channels) std::fill(one.samples.begin() + 250, one.samples.end(), std::nan(""));
  const auto report = outline_motion(both);
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_THAT(report->find("coherence")->meaning, HasSubstr("the phase says nothing"));
}

TEST(OutlineMotion, OfFewFramesAMinuteThereIsNoFlicker) {
  Recording slow = flickering(0, 0, 1, 40);
  slow.rate_hz = 0.2;
  const auto report = outline_motion({&slow, 1});
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(report->find("flicker_hz"), nullptr);
}

TEST(OutlineMotion, RefusesWhatIsNoOutlineAndWhatWasNotFilmedAtOnce) {
  const Recording table{.source = "table.csv", .rate_hz = 10, .channels = {{"y", "", Role::kOutput, {1, 2, 3}}}};
  EXPECT_THAT(outline_motion({&table, 1}).error().message, HasSubstr("table.csv"));
  const Recording two[] = {flickering(11, 0, 1), flickering(11, 0, 2, 900)};
  EXPECT_THAT(outline_motion(two).error().message, HasSubstr("900 rows at 50 Hz, expected those of flame.csv"));
}

}  // namespace
}  // namespace wisp::outline_motion_test
