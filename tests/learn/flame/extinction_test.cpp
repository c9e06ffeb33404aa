#include "learn/flame/extinction.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "learn/flame/made_blow_outs.hpp"

namespace wisp::extinction_test {
namespace {

using made::blow_out_recording;
using made::BlowOutRecipe;
using testing::HasSubstr;

ExtinctionEvidence evidence_of(const Recording& recording) {
  return {&recording, "wind", made::kWindUnit, *find_blow_outs(recording, "wind")};
}

// Seconds until a steady wind puts a flame out that burns by the rule.
double seconds_to_death(const Extinction& rule, double wind) {
  double harm = 0;
  int steps = 0;
  while (harm < 1 && steps < 6000) {
    harm = made::next_harm(rule, harm, wind, 0.001);
    ++steps;
  }
  return 0.001 * steps;
}

TEST(LearnedExtinction, IsTheRuleThatTheRecordingWasMadeBy) {
  for (const Extinction& rule : {Extinction{.level = 1.8, .seconds = 0.3, .haste = 2, .recovery = 0.4},
                                 Extinction{.level = 1.5, .seconds = 0.4, .haste = 3, .recovery = 0.4},
                                 Extinction{.level = 2.2, .seconds = 0.15, .haste = 0, .recovery = 0.3}}) {
    const auto first = blow_out_recording({.rule = rule, .rows = 7200, .seed = 1});
    const auto other = blow_out_recording({.rule = rule, .rows = 7200, .seed = 2});
    const ExtinctionEvidence seen[] = {evidence_of(first.recording), evidence_of(other.recording)};
    const auto fit = learn_extinction(seen);
    ASSERT_TRUE(fit) << fit.error().message;
    EXPECT_EQ(fit->agreement.deaths, first.deaths.size() + other.deaths.size());
    EXPECT_GE(fit->agreement.died + 1, fit->agreement.deaths) << rule.level;
    EXPECT_GE(fit->agreement.spared + 1, fit->agreement.gusts) << rule.level;
    EXPECT_LE(fit->agreement.median_off(), 0.034);
    // Near the level only a long puff kills, and there are few of those.
    EXPECT_NEAR(fit->rule.level, rule.level, 0.2 * rule.level);
    EXPECT_LE(fit->level_range[0], rule.level * 1.03);  // steps of the grid
    EXPECT_GE(fit->level_range[1], rule.level / 1.03);
    for (double wind : {2.5, 3.5}) {
      EXPECT_NEAR(seconds_to_death(fit->rule, wind), seconds_to_death(rule, wind), 0.05) << rule.level << " " << wind;
    }
  }
}

TEST(LearnedExtinction, HoldsForGustsThatItWasNotLearnedFrom) {
  const auto seen = blow_out_recording({.rows = 7200, .seed = 3}),
             unseen = blow_out_recording({.rows = 7200, .seed = 9});
  const ExtinctionEvidence learned[] = {evidence_of(seen.recording)}, judged[] = {evidence_of(unseen.recording)};
  const auto fit = learn_extinction(learned);
  ASSERT_TRUE(fit);
  const ExtinctionAgreement found = agreement(fit->rule, judged);
  ASSERT_GT(found.deaths, 8U);
  ASSERT_GT(found.gusts, 8U);
  EXPECT_GE(static_cast<double>(found.died), 0.85 * static_cast<double>(found.deaths));
  EXPECT_GE(static_cast<double>(found.spared), 0.85 * static_cast<double>(found.gusts));
}

TEST(LearnedExtinction, IsLessSureTheLessItHasSeen) {
  const auto little = blow_out_recording({.rows = 700, .every = 8, .weakest = 3.5, .shortest = 0.4, .seed = 4});
  ASSERT_EQ(little.deaths.size(), 1U);
  const auto much = blow_out_recording({.rows = 7200, .seed = 4});
  const ExtinctionEvidence few[] = {evidence_of(little.recording)}, many[] = {evidence_of(much.recording)};
  const auto unsure = learn_extinction(few), sure = learn_extinction(many);
  ASSERT_TRUE(unsure && sure);
  const auto width = [](const std::array<double, 2>& range) { return range[1] / range[0]; };
  EXPECT_GT(width(unsure->level_range), 1.5 * width(sure->level_range));
  EXPECT_LE(unsure->level_range[0], 1.8);
  EXPECT_GE(unsure->level_range[1], 1.8);
}

TEST(LearnedExtinction, SurvivalsBoundItFromBelow) {
  // The same deaths; once the flame has lived through a long strong gust as well.
  auto made = blow_out_recording(
      {.rows = 2000, .every = 8, .weakest = 3.9, .strongest = 4, .shortest = 0.3, .hiss = 0, .seed = 6});
  const auto before = learn_extinction(std::vector{evidence_of(made.recording)});
  auto& wind = made.recording.channels[*find_channel(made.recording, "wind")].samples;
  std::fill(wind.begin() + 100, wind.begin() + 400, 2.5 * made::kWindUnit);
  const auto after = learn_extinction(std::vector{evidence_of(made.recording)});
  ASSERT_TRUE(before && after);
  EXPECT_LT(before->level_range[0], 2);
  EXPECT_GE(after->level_range[0], 2.5);
  EXPECT_GT(after->rule.level, 2.5);
}

// Rows that go missing at once, 0.2 s after the rule killed: so long its flame takes to vanish.
TEST(LearnedExtinction, AFlameThatVanishesSlowlyWentOutThatMuchBefore) {
  const BlowOutRecipe recipe{.rows = 7200, .hiss = 0, .seed = 12};
  auto made = blow_out_recording(recipe);
  for (Channel& channel : made.recording.channels) {
    if (channel.role != Role::kInput) continue;
    std::rotate(channel.samples.begin(), channel.samples.begin() + 11, channel.samples.end());
  }
  ExtinctionEvidence seen = evidence_of(made.recording);
  for (double late : agreement(recipe.rule, std::span(&seen, 1)).late_seconds) EXPECT_NEAR(late, -11.0 / 60, 1e-9);
  seen.vanishing = 11.0 / 60;
  const ExtinctionAgreement found = agreement(recipe.rule, std::span(&seen, 1));
  EXPECT_EQ(found.died, found.deaths);
  for (double late : found.late_seconds) EXPECT_NEAR(late, 0, 1e-9);
}

TEST(LearnedExtinction, WithoutADeathThereIsNothingToLearn) {
  const auto made = blow_out_recording({.every = 0});
  const auto fit = learn_extinction(std::vector{evidence_of(made.recording)});
  ASSERT_FALSE(fit);
  EXPECT_THAT(fit.error().message, HasSubstr("no flame was blown out"));
}

TEST(LearnedExtinction, WithoutADeathTheDefaultIsRaisedAboveWhatWasSurvived) {
  auto made = blow_out_recording({.every = 0});
  EXPECT_EQ(extinction_beyond(std::vector{evidence_of(made.recording)}), Extinction{});
  auto& wind = made.recording.channels[*find_channel(made.recording, "wind")].samples;
  std::fill(wind.begin() + 1000, wind.begin() + 1300, 3 * made::kWindUnit);
  const std::vector seen{evidence_of(made.recording)};
  const Extinction beyond = extinction_beyond(seen);
  EXPECT_GT(beyond.level, 3);
  EXPECT_LT(beyond.level, 4.5);
  const ExtinctionAgreement found = agreement(beyond, seen);
  EXPECT_EQ(found.spared, found.gusts);
}

TEST(LearnedExtinction, DeathsThatWindDoesNotExplainAreRefused) {
  // Every other death comes after a gust that is weaker than those that are survived.
  auto made = blow_out_recording({.rows = 7200, .every = 0, .seed = 8});
  auto& wind = made.recording.channels[*find_channel(made.recording, "wind")].samples;
  std::fill(wind.begin(), wind.end(), 0.0);
  for (std::size_t k = 0; k < 14; ++k) {
    const std::size_t at = 300 + 480 * k;
    std::fill(wind.begin() + at, wind.begin() + at + 60, 4 * made::kWindUnit);
    std::fill(wind.begin() + at + 200, wind.begin() + at + 212, 1 * made::kWindUnit);
    for (Channel& channel : made.recording.channels) {
      if (channel.role == Role::kInput) continue;
      std::fill(channel.samples.begin() + at + 211, channel.samples.begin() + at + 300,
                std::numeric_limits<double>::quiet_NaN());
    }
  }
  ExtinctionEvidence seen = evidence_of(made.recording);
  for (BlowOut& blow_out : seen.blow_outs) blow_out.blown = true;
  const auto fit = learn_extinction(std::span(&seen, 1));
  ASSERT_FALSE(fit);
  EXPECT_THAT(fit.error().message, HasSubstr("wind does not explain when the flame was extinguished"));
}

TEST(ExtinctionAgreement, CountsDeathsAndGustsAndHowLateTheRuleIs) {
  const BlowOutRecipe recipe{.rows = 7200, .hiss = 0, .seed = 12};
  const auto made = blow_out_recording(recipe);
  const std::vector seen{evidence_of(made.recording)};
  const ExtinctionAgreement same = agreement(recipe.rule, seen);
  EXPECT_EQ(same.deaths, made.deaths.size());
  EXPECT_EQ(same.died, same.deaths);
  EXPECT_EQ(same.spared, same.gusts);
  for (double late : same.late_seconds) EXPECT_NEAR(late, 0, 1e-9);
  Extinction never = recipe.rule;
  never.level = 10;
  EXPECT_EQ(agreement(never, seen).died, 0U);
  EXPECT_EQ(agreement(never, seen).spared, same.gusts);
  Extinction always = recipe.rule;
  always.level = 0.3;
  always.seconds = 0.02;
  // One of the gusts is a single row, before which the rule has put the flame out already.
  EXPECT_EQ(agreement(always, seen).spared, 0U);
}

}  // namespace
}  // namespace wisp::extinction_test
