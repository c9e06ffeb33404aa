// The same flame, told otherwise: the verdict on a recording holds when that is played slowly, has its frames twice, is
// mirrored, coded again or outlined in another channel; where it does not, the reason is named.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "learn/flame/blow_outs.hpp"
#include "learn/flame/learn_outline.hpp"
#include "learn/outline/made_outline.hpp"

namespace wisp::metamorphic_test {
namespace {

using testing::HasSubstr;

Recording filmed() { return made::outline_recording({.points = 8, .rows = 900, .seed = 3}); }

ReportVerdict verdict_on(const Recording& recording, std::vector<std::string>* warnings = nullptr) {
  const auto fit = learn_outline({&recording, 1}, FlameRecipe());
  if (!fit) return {false, fit.error().message};
  if (warnings) *warnings = fit->report.warnings;
  return *fit->report.verdict;
}

// Rows at `count` places along the recording, between samples.
Recording resampled(const Recording& recording, std::size_t count, bool repeats) {
  Recording out = recording;
  for (Channel& channel : out.channels) {
    const std::vector<double> before = channel.samples;
    channel.samples.clear();
    for (std::size_t row = 0; row < count; ++row) {
      const double at =
          static_cast<double>(row) * static_cast<double>(before.size() - 1) / static_cast<double>(count - 1);
      const auto whole = std::min(static_cast<std::size_t>(at), before.size() - 2);
      const double share = repeats ? 0 : at - static_cast<double>(whole);
      channel.samples.push_back((1 - share) * before[whole] + share * before[whole + 1]);
    }
  }
  return out;
}

TEST(Metamorphic, TheFilmItselfIsUsable) {
  const ReportVerdict verdict = verdict_on(filmed());
  EXPECT_TRUE(verdict.usable) << verdict.reason;
}

TEST(Metamorphic, TwiceAsSlowItIsUsable) {
  const ReportVerdict verdict = verdict_on(resampled(filmed(), 1799, false));
  EXPECT_TRUE(verdict.usable) << verdict.reason;
}

TEST(Metamorphic, WithEveryFrameTwiceItIsUsable) {
  const ReportVerdict verdict = verdict_on(resampled(filmed(), 1800, true));
  EXPECT_TRUE(verdict.usable) << verdict.reason;
}

TEST(Metamorphic, MirroredItIsUsable) {
  Recording mirrored = filmed();
  for (std::size_t p = 0; p < 4; ++p) {
    for (std::size_t k = 0; k < 2; ++k) {
      std::swap(mirrored.channels[2 * p + k].samples, mirrored.channels[2 * (7 - p) + k].samples);
    }
  }
  for (std::size_t p = 0; p < 8; ++p) {
    for (double& x : mirrored.channels[2 * p].samples) x = 640 - x;
  }
  const ReportVerdict verdict = verdict_on(mirrored);
  EXPECT_TRUE(verdict.usable) << verdict.reason;
}

TEST(Metamorphic, CodedAgainItIsUsable) {
  Recording coded = filmed();
  std::mt19937_64 random(1);
  std::normal_distribution<double> gauss(0, 0.25);
  for (Channel& channel : coded.channels) {
    for (double& x : channel.samples) x += gauss(random);
  }
  const ReportVerdict verdict = verdict_on(coded);
  EXPECT_TRUE(verdict.usable) << verdict.reason;
}

// A flame is narrower in green than in red.
TEST(Metamorphic, InAnotherChannelItIsUsable) {
  Recording other = filmed();
  for (std::size_t row = 0; row < other.rows(); ++row) {
    const double middle = (other.channels[0].samples[row] + other.channels[14].samples[row]) / 2;
    for (std::size_t p = 0; p < 8; ++p) {
      double& x = other.channels[2 * p].samples[row];
      x = middle + 0.9 * (x - middle);
    }
  }
  const ReportVerdict verdict = verdict_on(other);
  EXPECT_TRUE(verdict.usable) << verdict.reason;
}

TEST(Metamorphic, EightBadRowsBeforeItAreLeftOutAndNamed) {
  Recording spoilt = filmed();
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> anywhere(0, 600);
  for (Channel& channel : spoilt.channels) {
    for (std::size_t row = 0; row < 8; ++row) channel.samples[row] = anywhere(random);
  }
  std::vector<std::string> warnings;
  const ReportVerdict verdict = verdict_on(spoilt, &warnings);
  EXPECT_TRUE(verdict.usable) << verdict.reason;
  ASSERT_FALSE(warnings.empty());
  EXPECT_THAT(warnings.front(), HasSubstr("8 outlines lie far from those around them"));
}

TEST(Metamorphic, AGustIsNoJump) {
  Recording blown = made::outline_recording({.points = 8, .rows = 900, .wind = true, .lean = 0.06, .seed = 4});
  EXPECT_EQ(remove_jumps(blown), 0U);
}

}  // namespace
}  // namespace wisp::metamorphic_test
