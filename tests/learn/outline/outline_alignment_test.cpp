#include "learn/outline/outline_alignment.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "learn/outline/made_outline.hpp"
#include "learn/outline/outline_fit.hpp"
#include "learn/outline/outline_judgement.hpp"

namespace wisp::outline_alignment_test {
namespace {

using testing::HasSubstr;

constexpr made::OutlineRecipe kWindy{.rows = 1200, .shock = 0.003, .wind = true};

const std::vector<double>& wind_of(const Recording& recording) {
  return recording.channels[*find_channel(recording, "wind")].samples;
}

// The recording with its wind told so many frames later than it blew; before that it was calm.
Recording heard_late(Recording recording, std::size_t frames) {
  auto& wind = recording.channels[*find_channel(recording, "wind")].samples;
  wind.insert(wind.begin(), frames, 0.0);
  wind.resize(recording.channels.front().samples.size());
  return recording;
}

InputAlignment alignment_of(const Recording& recording) {
  const auto found = align_outline(recording, {"wind"});
  EXPECT_TRUE(found);
  EXPECT_EQ(found->inputs.size(), 1u);
  return found->inputs.front();
}

TEST(OutlineAlignment, AMotionThatFollowsItsWindIsReportedAndLeftAlone) {
  const Recording recording = made::outline_recording(kWindy);
  const auto found = align_outline(recording, {"wind"});
  ASSERT_TRUE(found);
  const InputAlignment& wind = found->inputs.front();
  EXPECT_TRUE(wind.found.usable) << wind.found.reason;
  EXPECT_GE(wind.found.offset_seconds, 0);
  EXPECT_LT(wind.found.offset_seconds, 0.2);
  EXPECT_EQ(wind.frames_moved, 0);
  EXPECT_EQ(wind_of(found->recording), wind_of(recording));
}

TEST(OutlineAlignment, WindThatComesLaterThanItsMotionIsMovedBack) {
  const Recording in_step = made::outline_recording(kWindy);
  const Recording late = heard_late(in_step, 9);
  const auto found = align_outline(late, {"wind"});
  ASSERT_TRUE(found);
  const InputAlignment& wind = found->inputs.front();
  // What is moved is the lateness less the time that the thing itself takes.
  const double own = alignment_of(in_step).found.offset_seconds * 30;
  EXPECT_NEAR(wind.frames_moved, 9 - own, 1);
  EXPECT_THAT(wind.note(), HasSubstr("frames earlier"));
  const auto moved = static_cast<std::size_t>(wind.frames_moved);
  EXPECT_EQ(wind_of(found->recording)[100], wind_of(late)[100 + moved]);
  EXPECT_TRUE(std::isnan(wind_of(found->recording).back()));
  EXPECT_FALSE(std::isnan(wind_of(found->recording)[1199 - moved]));
}

TEST(OutlineAlignment, NothingCrossesFromOneEpisodeToTheNext) {
  Recording late = heard_late(made::outline_recording(kWindy), 9);
  late.episode_ids.assign(1200, 0);
  std::fill(late.episode_ids.begin() + 700, late.episode_ids.end(), 1);
  const auto found = align_outline(late, {"wind"});
  ASSERT_GT(found->inputs.front().frames_moved, 3);
  EXPECT_TRUE(std::isnan(wind_of(found->recording)[699]));
  EXPECT_FALSE(std::isnan(wind_of(found->recording)[700]));
}

TEST(OutlineAlignment, WindThatTheOutlineDoesNotAnswerIsLeftAloneWithTheReason) {
  Recording other = made::outline_recording({.rows = 900});
  const Recording windy = made::outline_recording(kWindy);
  other.channels.push_back(windy.channels[*find_channel(windy, "wind")]);
  other.channels.back().samples.resize(900);
  const InputAlignment wind = alignment_of(other);
  EXPECT_FALSE(wind.found.usable);
  EXPECT_EQ(wind.frames_moved, 0);
  EXPECT_THAT(wind.found.reason, HasSubstr("nothing in common"));
}

TEST(OutlineAlignment, AShortRecordingSaysWhyNothingWasFound) {
  const InputAlignment wind = alignment_of(slice(made::outline_recording(kWindy), 0, 5));
  EXPECT_FALSE(wind.found.usable);
  EXPECT_NE(wind.found.reason, "");
}

// A model that was learned from late sound follows as well as one whose sound was in step, and so does a validation.
TEST(OutlineAlignment, LearningAndValidatingBringSoundIntoStep) {
  const Recording in_step = made::outline_recording(kWindy);
  const Recording late = heard_late(in_step, 9);
  const auto tip = [](const OutlineFit& fit) { return fit.summary.held_out->tip_fit_percent.back(); };
  const auto good = fit_outline(std::vector{in_step});
  const auto mended = fit_outline(std::vector{late});
  const auto lost = fit_outline(std::vector{late}, {.align = false});
  EXPECT_GT(tip(*mended), tip(*good) - 5);
  EXPECT_LT(tip(*lost), tip(*good) - 15);
  EXPECT_EQ(mended->summary.alignment.size(), 1u);
  const auto said_to_be_moved = [](const OutlineFit& fit) {
    const auto& warnings = fit.summary.warnings;
    return std::count_if(warnings.begin(), warnings.end(),
                         [](const std::string& one) { return one.find("it was moved") != std::string::npos; });
  };
  EXPECT_EQ(said_to_be_moved(*mended), 1);
  EXPECT_EQ(said_to_be_moved(*good), 0);

  made::OutlineRecipe unseen = kWindy;
  unseen.seed = 7;
  unseen.rows = 600;
  const Recording other = heard_late(made::outline_recording(unseen), 7);
  const auto validated = judge_outline(good->model, other, {.fidelity = false});
  const auto as_recorded = judge_outline(good->model, other, {.align = false, .fidelity = false});
  EXPECT_GT(validated->figures.tip_fit_percent.back(), as_recorded->figures.tip_fit_percent.back() + 15);
  EXPECT_GT(validated->alignment.front().frames_moved, 0);
}

}  // namespace
}  // namespace wisp::outline_alignment_test
