// What the data page says of made recordings whose one fault is known.

#include "wisp/learn/advice.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

namespace wisp::advice_test {
namespace {

using testing::Contains;
using testing::Field;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

// An input that jumps every `hold` rows, and what follows from it: y(t) = 0.8 y(t−1) + u(t−delay) + e(t).
Recording system(std::size_t rows, std::size_t hold, std::size_t delay, double noise = 0.1) {
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  Recording recording{.rate_hz = 1,
                      .channels = {{"u", "", Role::kInput, std::vector<double>(rows)},
                                   {"y", "", Role::kOutput, std::vector<double>(rows)}}};
  auto &u = recording.channels[0].samples, &y = recording.channels[1].samples;
  for (std::size_t t = 0; t < rows; ++t) {
    u[t] = t % hold == 0 ? normal(random) : u[t - 1];
    y[t] = noise * normal(random) + (t > 0 ? 0.8 * y[t - 1] : 0) + (t >= delay ? u[t - delay] : 0);
  }
  return recording;
}

std::vector<Remark> remarks(const Recording& recording) { return remarks_on({&recording, 1}, {"u"}, {"y"}); }

auto remark(RemarkKind kind) { return Contains(Field(&Remark::kind, kind)); }

TEST(Advice, AGoodRecordingHasNoRemark) {
  EXPECT_THAT(remarks(system(600, 3, 1)), IsEmpty());
  // Without noise the past of the output determines that of the input: only rounding errors are left of its columns.
  EXPECT_THAT(remarks(system(600, 1, 1, 0)), IsEmpty());
}

TEST(Advice, AStraightLineIsADriftAndASumIsAnIntegrator) {
  Recording drifting = system(600, 3, 1);
  for (std::size_t t = 0; t < 600; ++t) drifting.channels[1].samples[t] += 0.1 * static_cast<double>(t);
  EXPECT_THAT(remarks(drifting), remark(RemarkKind::kDrift));
  EXPECT_THAT(remarks(drifting), Not(remark(RemarkKind::kIntegrates)));
  // An input whose mean is not zero drives it away along a line too.
  Recording summing = system(600, 3, 1);
  double sum = 0;
  for (std::size_t t = 0; t < 600; ++t) {
    summing.channels[1].samples[t] = sum;
    sum += summing.channels[0].samples[t] + 0.5;
  }
  EXPECT_THAT(remarks(summing), remark(RemarkKind::kIntegrates));
  EXPECT_THAT(remarks(summing), Not(remark(RemarkKind::kDrift)));
}

TEST(Advice, AControllerIsSeenAndAnInputThatRarelyJumpsIsNotTakenForOne) {
  for (std::size_t hold : {1u, 10u, 25u}) {
    EXPECT_THAT(remarks(system(500, hold, 1, 0.5)), Not(remark(RemarkKind::kFeedback))) << hold;
  }
  Recording closed = system(500, 1, 1);
  auto &u = closed.channels[0].samples, &y = closed.channels[1].samples;
  std::mt19937_64 random(9);
  std::normal_distribution<double> normal;
  for (std::size_t t = 1; t < 500; ++t) {
    u[t] = -0.4 * y[t - 1] + 0.1 * normal(random);
    y[t] = 0.8 * y[t - 1] + u[t - 1] + 0.5 * normal(random);
  }
  EXPECT_THAT(remarks(closed), remark(RemarkKind::kFeedback));
}

TEST(Advice, ALongDelayIsFoundInFewRows) {
  const auto found = remarks(system(280, 1, 33));
  ASSERT_THAT(found, remark(RemarkKind::kDelay));
  for (const Remark& one : found) {
    if (one.kind == RemarkKind::kDelay) {
      EXPECT_EQ(one.size, 33);
    }
  }
}

TEST(Advice, OutliersInFourRowsOfAHundredAreStillOutliers) {
  Recording recording = system(400, 2, 1);
  for (std::size_t t = 10; t < 400; t += 25) recording.channels[1].samples[t] += 80;
  const auto found = remarks(recording);
  ASSERT_THAT(found, remark(RemarkKind::kOutliers));
  EXPECT_THAT(found.front().cause, HasSubstr("16 outliers (rows 11, 36,"));
}

TEST(Advice, RowsOfAPartAreNumberedAsInTheFile) {
  Recording recording = system(400, 2, 1);
  recording.channels[1].samples[110] += 80;
  const auto found = remarks(slice(recording, 100, 400));
  ASSERT_THAT(found, remark(RemarkKind::kOutliers));
  EXPECT_THAT(found.front().cause, HasSubstr("row 111"));
}

TEST(Advice, OutliersAreCountedInTheRowsOfTheirOwnRecording) {
  std::vector<Recording> recordings{system(400, 2, 1), system(400, 2, 1)};
  recordings[0].source = "first.csv";
  recordings[1].source = "second.csv";
  recordings[1].channels[1].samples[10] += 80;
  const auto found = remarks_on(recordings, {"u"}, {"y"});
  ASSERT_THAT(found, remark(RemarkKind::kOutliers));
  EXPECT_THAT(found.front().cause, HasSubstr("'y' has 1 outlier (row 11 of second.csv)"));
}

TEST(Advice, InputsInASmallUnitThatDifferAreNotTakenForOne) {
  Recording recording = system(600, 1, 1);
  recording.channels.push_back(recording.channels[0]);
  recording.channels.back().name = "v";
  std::mt19937_64 random(6);
  std::normal_distribution<double> normal;
  for (double& v : recording.channels.back().samples) v += 0.03 * normal(random);
  for (std::size_t c : {0, 2}) {
    for (double& sample : recording.channels[c].samples) sample *= 1e-6;
  }
  EXPECT_THAT(redundant_channels({&recording, 1}, {"u", "v"}, 0), IsEmpty());
}

}  // namespace
}  // namespace wisp::advice_test
