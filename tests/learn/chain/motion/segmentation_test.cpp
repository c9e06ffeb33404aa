#include "learn/chain/motion/segmentation.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "learn/chain/made_falls.hpp"

namespace wisp::chain::segmentation_test {
namespace {

using testing::DoubleNear;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr SegmentationOptions kZeros{.event = {EventKind::kZero, {}}, .min_seconds = 0, .debounce = 0.1};

std::vector<double> wave(double period, int rows, double phase) {
  std::vector<double> signal;
  for (int row = 0; row < rows; ++row) signal.push_back(std::sin(2 * std::acos(-1.0) * (row - phase) / period));
  return signal;
}

TEST(Segmentation, ZerosAreFoundBetweenSamples) {
  const auto events = event_rows(wave(20, 30, 2.3), 1, 0.7, kZeros);
  // Between samples the sine is straight to a twentieth of a row.
  EXPECT_THAT(events, ElementsAre(DoubleNear(2.3, 0.02), DoubleNear(12.3, 0.02), DoubleNear(22.3, 0.02)));
}

TEST(Segmentation, ExtremaAreFoundBetweenSamples) {
  SegmentationOptions options = kZeros;
  options.event.kind = EventKind::kMinimum;
  EXPECT_THAT(event_rows(wave(20, 45, 2.3), 1, 0.7, options),
              ElementsAre(DoubleNear(17.3, 0.02), DoubleNear(37.3, 0.02)));
  options.event.kind = EventKind::kMaximum;
  EXPECT_THAT(event_rows(wave(20, 45, 2.3), 1, 0.7, options),
              ElementsAre(DoubleNear(7.3, 0.02), DoubleNear(27.3, 0.02)));
}

TEST(Segmentation, TremblingAroundZeroIsOneEvent) {
  std::vector<double> signal = wave(40, 60, 10);
  for (std::size_t row = 28; row < 33; ++row) signal[row] = row % 2 ? 0.03 : -0.03;
  EXPECT_EQ(event_rows(signal, 1, 0.7, kZeros).size(), 3U);
  SegmentationOptions nervous = kZeros;
  nervous.debounce = 0;
  EXPECT_GT(event_rows(signal, 1, 0.7, nervous).size(), 4U);
}

TEST(Segmentation, EventsTooNearToTheOneBeforeAreLeftOut) {
  SegmentationOptions options = kZeros;
  options.min_seconds = 12;
  EXPECT_THAT(event_rows(wave(20, 35, 2.3), 1, 0.7, options),
              ElementsAre(DoubleNear(2.3, 0.02), DoubleNear(22.3, 0.02)));
}

TEST(Segmentation, StepsOfAPieceAddUpToItsRows) {
  const Recording recording = made_falls();
  const auto motion = motion_of(std::span(&recording, 1));
  ASSERT_TRUE(motion);
  const auto cut = segment(*motion, std::span(&recording, 1), {});
  ASSERT_TRUE(cut) << cut.error().message;
  std::vector<double> begin(10, -1), end(10), steps(10);
  for (const Segment& one : cut->segments) {
    if (begin[one.piece] < 0) begin[one.piece] = one.begin;
    end[one.piece] = one.end;
    steps[one.piece] += one.steps;
  }
  for (std::size_t k = 0; k < 10; ++k) EXPECT_NEAR(steps[k], end[k] - begin[k], 1.0);
  // Swings of 0.6 s are cut where they turn: every 36 rows.
  EXPECT_NEAR(static_cast<double>(cut->segments.size()), 10 * 6 / 0.6, 25);
}

TEST(Segmentation, AFallWithoutASingleStallIsLeftOutWithAWarning) {
  Recording recording = made_falls({.falls = 3});
  for (std::size_t row = 360; row < 720; ++row) {
    recording.channels[0].samples[row] = recording.channels[1].samples[row] = 0.01 * static_cast<double>(row);
  }
  const auto motion = motion_of(std::span(&recording, 1));
  ASSERT_TRUE(motion);
  SegmentationOptions options{.event = {EventKind::kMinimum, "horizontal_speed"}};
  const auto cut = segment(*motion, std::span(&recording, 1), options);
  ASSERT_TRUE(cut);
  EXPECT_EQ(cut->pieces_without, 1U);
  ASSERT_EQ(cut->warnings.size(), 1U);
  EXPECT_THAT(cut->warnings[0], HasSubstr("1 of 3"));
}

TEST(Segmentation, NoEventAnywhereAndUnknownSignalsAreErrors) {
  const Recording still = made_falls({.falls = 1, .seconds = 0.3});
  const auto motion = motion_of(std::span(&still, 1));
  ASSERT_TRUE(motion);
  EXPECT_THAT(segment(*motion, std::span(&still, 1), {}).error().message, HasSubstr("no segment"));
  EXPECT_THAT(segment(*motion, std::span(&still, 1), {.event = {EventKind::kZero, "lift"}}).error().message,
              HasSubstr("lift"));
  const Recording track = made_falls({.falls = 1, .orientation = false});
  const auto positions = motion_of(std::span(&track, 1));
  EXPECT_THAT(segment(*positions, std::span(&track, 1), {}).error().message, HasSubstr("orientation"));
}

TEST(Segmentation, EventsAreWrittenAsKindAndSignal) {
  const auto event = parse_event("min:horizontal_speed");
  ASSERT_TRUE(event);
  EXPECT_EQ(event->kind, EventKind::kMinimum);
  EXPECT_EQ(event->signal, "horizontal_speed");
  for (const char* wrong : {"", "zero", "zero:", "mean:speed", ":speed"}) EXPECT_FALSE(parse_event(wrong)) << wrong;
}

}  // namespace
}  // namespace wisp::chain::segmentation_test
