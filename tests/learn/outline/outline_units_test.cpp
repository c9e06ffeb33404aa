#include "learn/outline/outline_units.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/statistics.hpp"
#include "model/bspline.hpp"

namespace wisp::outline_units_test {
namespace {

// Four control points of a leaning outline in pixels, base moving to the right.
Recording captured(std::size_t rows = 3) {
  Recording recording;
  recording.source = "clip.csv";
  recording.rate_hz = 25;
  const double x[] = {100, 90, 140, 120};
  const double y[] = {400, 300, 200, 410};
  for (int p = 0; p < 4; ++p) {
    Channel px{"p" + std::to_string(p) + ".x", "px", Role::kOutput, {}};
    Channel py{"p" + std::to_string(p) + ".y", "px", Role::kOutput, {}};
    for (std::size_t t = 0; t < rows; ++t) {
      px.samples.push_back(x[p] + 10 * static_cast<double>(t));
      py.samples.push_back(y[p]);
    }
    recording.channels.push_back(px);
    recording.channels.push_back(py);
  }
  return recording;
}

double sample(const Recording& recording, const char* name, std::size_t row) {
  return recording.channels[*find_channel(recording, name)].samples[row];
}

TEST(OutlineUnits, LayoutHasPointsAndUniformKnots) {
  const auto layout = outline_layout(captured());
  ASSERT_TRUE(layout);
  EXPECT_EQ(layout->points, 4u);
  EXPECT_EQ(layout->knots, uniform_knots(4));
  EXPECT_EQ(outline_outputs(2), (std::vector<std::string>{"p0.x", "p0.y", "p1.x", "p1.y"}));
}

TEST(OutlineUnits, KnotsAreTakenFromTheAttribute) {
  Recording recording = captured();
  recording.channels.push_back({"p4.x", "px", Role::kOutput, {1, 2, 3}});
  recording.channels.push_back({"p4.y", "px", Role::kOutput, {1, 2, 3}});
  recording.attributes.push_back({"knots", "0 0 0 0 0.4 1 1 1 1"});
  const auto layout = outline_layout(recording);
  ASSERT_TRUE(layout);
  EXPECT_DOUBLE_EQ(layout->knots[4], 0.4);
}

TEST(OutlineUnits, ABadKnotVectorIsAClearError) {
  Recording recording = captured();
  recording.attributes.push_back({"knots", "0 0 0 0 1 1 1"});
  EXPECT_EQ(outline_layout(recording).error().message, "clip.csv: has 7 knots, expected 8 for 4 control points");
  recording.attributes.back().value = "0 0 0 x 1 1 1 1";
  EXPECT_EQ(outline_layout(recording).error().message,
            "clip.csv: \"# knots\" holds \"x\", expected numbers separated by blanks");
  recording.attributes.back().value = "0 0 0 0.5 1 1 1 1";
  EXPECT_EQ(outline_layout(recording).error().message,
            "clip.csv: its knots are not ascending from 0 to 1 with multiplicity 4 at both ends");
}

TEST(OutlineUnits, ARecordingOfSomethingElseIsAClearError) {
  Recording recording;
  recording.source = "wind.csv";
  recording.channels.push_back({"wind", "", Role::kInput, {1, 2}});
  EXPECT_EQ(outline_layout(recording).error().message,
            "wind.csv: has 0 control points (p0.x, p0.y, …), expected at least 4: is it a recording of an outline?");
  recording = captured();
  recording.channels.pop_back();
  EXPECT_EQ(outline_layout(recording).error().message, "clip.csv: control point p3 has no y");
}

TEST(OutlineUnits, AnotherNumberOfPointsNamesBothFiles) {
  Recording other = captured();
  other.source = "other.csv";
  other.channels.push_back({"p4.x", "px", Role::kOutput, {1, 2, 3}});
  other.channels.push_back({"p4.y", "px", Role::kOutput, {1, 2, 3}});
  const auto layout = common_layout(std::vector{captured(), other});
  ASSERT_FALSE(layout);
  EXPECT_EQ(layout.error().message,
            "other.csv: has 5 control points, but clip.csv has 4; capture both with the same --points");
}

TEST(OutlineUnits, TheModelsOriginIsTheMiddleOfTheBaseAndYPointsUp) {
  const Recording recording = captured();
  const Recording units = to_model_units(recording, *outline_layout(recording), 200);
  for (std::size_t row = 0; row < 3; ++row) {
    EXPECT_DOUBLE_EQ(sample(units, "p0.x", row), -0.05);
    EXPECT_DOUBLE_EQ(sample(units, "p3.x", row), 0.05);
    EXPECT_DOUBLE_EQ(sample(units, "p0.y", row), 0.025);
    EXPECT_DOUBLE_EQ(sample(units, "p2.y", row), 205.0 / 200);
    EXPECT_DOUBLE_EQ(sample(units, "p0.x", row), -sample(units, "p3.x", row));
    EXPECT_DOUBLE_EQ(sample(units, "p0.y", row), -sample(units, "p3.y", row));
  }
  EXPECT_DOUBLE_EQ(sample(units, "base.x", 2), 130);
  EXPECT_DOUBLE_EQ(sample(units, "base.y", 2), 405);
  EXPECT_EQ(units.channels[*find_channel(units, "base.x")].role, Role::kMotion);
}

TEST(OutlineUnits, ThereAndBackIsTheSameRecording) {
  const Recording recording = captured();
  const auto back = to_pixels(to_model_units(recording, *outline_layout(recording), 213.7));
  ASSERT_TRUE(back);
  for (std::size_t c = 0; c < 8; ++c) {
    for (std::size_t row = 0; row < 3; ++row) {
      EXPECT_NEAR(back->channels[c].samples[row], recording.channels[c].samples[row], 1e-10);
    }
    EXPECT_EQ(back->channels[c].unit, "px");
  }
}

TEST(OutlineUnits, MissingRowsStayMissing) {
  Recording recording = captured();
  for (std::size_t c = 0; c < 8; ++c) recording.channels[c].samples[1] = std::numeric_limits<double>::quiet_NaN();
  const Recording units = to_model_units(recording, *outline_layout(recording), 200);
  EXPECT_TRUE(std::isnan(sample(units, "p1.x", 1)));
  EXPECT_FALSE(std::isnan(sample(units, "p1.x", 2)));
}

TEST(OutlineUnits, PixelsAreRefusedWhereTheBaseIsUnknown) {
  const auto back = to_pixels(captured());
  ASSERT_FALSE(back);
  EXPECT_EQ(back.error().message, "clip.csv: has no base.x, base.y and pixels_per_unit to go back to pixels by");
}

TEST(OutlineUnits, HeightIsThatOfTheChosenRows) {
  Recording recording = captured();
  for (const char* name : {"p1.y", "p2.y"}) recording.channels[*find_channel(recording, name)].samples[2] -= 100;
  const auto layout = *outline_layout(recording);
  const double low = mean(heights_pixels(recording, layout, std::vector<std::uint8_t>{1, 1, 0}));
  const double high = mean(heights_pixels(recording, layout, std::vector<std::uint8_t>{0, 0, 1}));
  EXPECT_GT(high, low + 50);
  EXPECT_NEAR(mean(heights_pixels(recording, layout, {})), (2 * low + high) / 3, 1e-9);
  EXPECT_EQ(mean(heights_pixels(recording, layout, std::vector<std::uint8_t>{0, 0, 0})), 0);
}

}  // namespace
}  // namespace wisp::outline_units_test
