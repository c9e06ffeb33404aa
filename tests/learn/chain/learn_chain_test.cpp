#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "learn/chain/learn_chain.hpp"
#include "learn/chain/made_balls.hpp"
#include "learn/chain/made_falls.hpp"
#include "wisp/model/file.hpp"
#include "wisp/run/bank.hpp"

namespace wisp::chain::learn_chain_test {
namespace {

using testing::HasSubstr;

LeafRecipe quick(int modes = 3) {
  LeafRecipe recipe;
  recipe.modes = modes;
  return recipe;
}

Result<Fit> learned(const Recording& recording, const ChainRecipe& recipe = quick(), const Progress& progress = {}) {
  return learn_chain(std::span(&recording, 1), recipe, progress);
}

// Swings that are all alike, each of a whole number of rows.
Recording periodic(int falls) {
  Recording recording = made_falls({.falls = 0, .orientation = false});
  for (int fall = 0; fall < falls; ++fall) {
    for (int row = 0; row < 200; ++row) {
      const double phase = 2 * std::acos(-1.0) * (row % 20) / 20;
      const double at[] = {0.1 * std::sin(phase), 0, -0.5 * row / 60};
      for (std::size_t k = 0; k < 3; ++k) recording.channels[k].samples.push_back(at[k]);
      recording.episode_ids.push_back(fall);
    }
  }
  return recording;
}

double number(const Report& report, std::string_view id) {
  const ReportEntry* entry = report.find(id);
  if (!entry) ADD_FAILURE() << "no " << id;
  const double* value = entry ? std::get_if<double>(&entry->value) : nullptr;
  return value ? *value : std::nan("");
}

bool for_people(const Report& report, std::string_view word) {
  for (const ReportSection& section : report.sections) {
    for (const ReportEntry& entry : section.entries) {
      if (entry.label.find(word) != std::string::npos) return true;
    }
  }
  return false;
}

// 12,000 frames, ten times. Heights of the recording are 300 to 301.2 m. A successor begins a few centimetres higher or
// lower than the segment before it ends, which is made up for while it is played: a fifth of the range is far beyond
// that, and far from the metres by which heights would wander.
TEST(LearnChain, ABallStaysBetweenFloorAndCeiling) {
  ChainRecipe recipe;
  recipe.event = {EventKind::kMaximum, "pos.z"};
  recipe.modes = 3;
  const auto fit = learned(made_ball({.floor = 300}), recipe);
  ASSERT_TRUE(fit) << fit.error().message;
  auto bank = Bank::create(fit->model, {.capacity = 10, .seed = 3});
  ASSERT_TRUE(bank) << bank.error().message;
  for (int k = 0; k < 10; ++k) bank->spawn();
  float lowest = 1e9f, highest = -1e9f;
  std::array<float, 3> at{};
  for (int step = 0; step < 12000; ++step) {
    bank->step();
    for (int slot = 0; slot < 10; ++slot) {
      bank->outputs(bank->at(slot), at);
      lowest = std::min(lowest, at[2]);
      highest = std::max(highest, at[2]);
    }
  }
  EXPECT_GT(lowest, 300 - 0.24);
  EXPECT_LT(highest, 301.2 + 0.24);
  EXPECT_NEAR(fit->model.outputs[2].lowest, 300, 0.01);
}

TEST(LearnChain, WhatFallsBeginsAtTheOriginAndSinksWithoutEnd) {
  const auto fit = learned(made_falls({.falls = 40}));
  ASSERT_TRUE(fit) << fit.error().message;
  EXPECT_TRUE(std::get<ChainModel>(fit->model.dynamics).segments.height.empty());
}

TEST(LearnChain, TheReportSaysHowWellItWasLearned) {
  const auto fit = learned(made_falls({.falls = 40}));
  ASSERT_TRUE(fit) << fit.error().message;
  ASSERT_TRUE(fit->report.verdict);
  EXPECT_TRUE(fit->report.verdict->usable) << fit->report.verdict->reason;
  EXPECT_LT(number(fit->report, "fidelity.energy_distance.value"), 0.05);
  EXPECT_GT(number(fit->report, "fidelity.energy_distance.ceiling"), 0.05);
  EXPECT_GT(number(fit->report, "fidelity.verbatim_seconds"), 0);
  EXPECT_NEAR(number(fit->report, "fidelity.real.descent_speed"),
              number(fit->report, "fidelity.synthesized.descent_speed"), 0.1);
  for (const char* id : {"segments", "stored", "modes", "mode_sizes", "history", "initial", "transitions",
                         "mean_segment_seconds", "join_defect.rotation.share_above", "seed"}) {
    EXPECT_TRUE(fit->report.find(id)) << id;
  }
  EXPECT_EQ(fit->model.name, "leaf");
  EXPECT_EQ(fit->model.training.sources, std::vector<std::string>{"made.csv"});
  EXPECT_EQ(fit->model.training.usable.verdict, fit->report.verdict->usable);
}

TEST(LearnChain, WithoutOrientationNobodyIsToldOfFlips) {
  ChainRecipe recipe = quick();
  recipe.event = ChainRecipe{}.event;
  const auto fit = learned(made_falls({.falls = 20, .orientation = false}), recipe);
  ASSERT_TRUE(fit) << fit.error().message;
  EXPECT_FALSE(for_people(fit->report, "flips"));
  EXPECT_FALSE(for_people(fit->report, "orientation"));
  EXPECT_TRUE(fit->report.find("fidelity.real.flips_per_second"));
  const auto posed = learned(made_falls({.falls = 20}));
  ASSERT_TRUE(posed);
  EXPECT_TRUE(for_people(posed->report, "flips"));
}

TEST(LearnChain, APeriodicRecordingIsLearned) {
  ChainRecipe recipe = quick(1);
  recipe.event = ChainRecipe{}.event;
  for (int modes : {1, 2}) {
    recipe.modes = modes;
    const auto fit = learned(periodic(6), recipe);
    ASSERT_TRUE(fit) << fit.error().message;
    EXPECT_TRUE(model_bytes(fit->model));
    EXPECT_FALSE(fit->report.verdict->usable);
    EXPECT_THAT(fit->report.verdict->reason, HasSubstr("episodes are the same"));
  }
}

TEST(LearnChain, OneHeldOutFallIsItsOwnFloor) {
  LeafRecipe recipe = quick();
  recipe.holdout = 0.05;
  const auto fit = learned(made_falls({.falls = 20, .seconds = 20}), recipe);
  ASSERT_TRUE(fit);
  EXPECT_GT(number(fit->report, "fidelity.energy_distance.floor"), 0);
}

TEST(LearnChain, MillimetresReadAsMetresAreNotUsable) {
  Recording recording = made_falls({.falls = 40});
  for (Channel& channel : recording.channels) {
    if (!channel.name.starts_with("pos.")) continue;
    for (double& x : channel.samples) x *= 1000;
  }
  const auto fit = learned(recording);
  ASSERT_TRUE(fit) << fit.error().message;
  EXPECT_FALSE(fit->report.verdict->usable);
  EXPECT_THAT(fit->report.verdict->reason, HasSubstr("in metres, not in millimetres"));
  recording.channels[0].unit = "mm";
  EXPECT_THAT(learned(recording).error().message, HasSubstr("made.csv: pos.x is in mm, expected metres"));
}

TEST(LearnChain, FallsUnlikeTheHeldOutOnesAreNotUsable) {
  // Slow falls are learned from, quick ones held out.
  Recording both = made_falls({.falls = 20, .swing_seconds = 1.2});
  const Recording quick_ones = made_falls({.falls = 20, .swing_seconds = 0.3});
  for (std::size_t k = 0; k < both.channels.size(); ++k) {
    auto& samples = both.channels[k].samples;
    samples.insert(samples.end(), quick_ones.channels[k].samples.begin(), quick_ones.channels[k].samples.end());
  }
  for (std::int64_t id : quick_ones.episode_ids) both.episode_ids.push_back(id + 20);
  LeafRecipe recipe = quick();
  recipe.holdout = 0.5;
  const auto fit = learned(both, recipe);
  ASSERT_TRUE(fit) << fit.error().message;
  EXPECT_FALSE(fit->report.verdict->usable);
  EXPECT_THAT(fit->report.verdict->reason, HasSubstr("are not like the recorded ones"));
}

TEST(LearnChain, WhatTooFewFallsCannotJudgeIsSaid) {
  // Falls of less than two seconds, of which few are held out.
  const auto fit = learned(made_falls({.falls = 60, .seconds = 1.7}));
  ASSERT_TRUE(fit) << fit.error().message;
  EXPECT_THAT(fit->report.verdict->reason, HasSubstr("was not judged"));
  EXPECT_THAT(fit->report.verdict->reason, HasSubstr("over two seconds, by spectra"));
}

TEST(LearnChain, ItCanBeStopped) {
  const Recording recording = made_falls({.falls = 4});
  int calls = 0;
  ASSERT_TRUE(learned(recording, quick(), [&](std::string_view, double) { return ++calls > 0; }));
  ASSERT_GE(calls, 4);
  for (int last = 1; last <= calls; ++last) {
    int seen = 0;
    const auto fit = learned(recording, quick(), [&](std::string_view, double) { return ++seen < last; });
    ASSERT_FALSE(fit);
    EXPECT_EQ(fit.error().message, kStopped);
    EXPECT_EQ(seen, last);
  }
}

TEST(ValidateChain, FallsThatJudgeNothingSaySo) {
  const auto fit = learned(made_falls({.falls = 20}));
  ASSERT_TRUE(fit);
  const Recording brief = made_falls({.falls = 4, .seconds = 1.7});
  const auto report = validate_chain(fit->model, std::span(&brief, 1), 1);
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_FALSE(report->verdict->usable);
  EXPECT_THAT(report->verdict->reason, HasSubstr("too few or too short to judge by"));
}

TEST(ValidateChain, SeriesAreTracksOfBothSides) {
  const Recording recording = made_falls({.falls = 20});
  const auto fit = learned(recording);
  ASSERT_TRUE(fit);
  const auto report = validate_chain(fit->model, std::span(&recording, 1), 1);
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_TRUE(report->find("join_defect.position.floor.share_above"));
  for (const char* id :
       {"falls-side.recorded", "falls-side.synthesized", "falls-above.recorded", "segments.recorded.track",
        "segments.recorded.events", "segments.synthesized.mode_2", "segments.synthesized.events"}) {
    std::size_t points = 0;
    for (const ReportSection& section : report->sections) {
      for (const ReportSeries& series : section.series) {
        if (series.id == id) points += series.x.size();
        EXPECT_EQ(series.x.size(), series.y.size());
      }
    }
    EXPECT_GT(points, 3u) << id;
  }
}

TEST(ValidateChain, FallsOfOneRowASecondAreCompared) {
  const Recording slow = made_falls({.falls = 20, .seconds = 120, .rate_hz = 1, .swing_seconds = 12});
  const auto fit = learned(slow);
  ASSERT_TRUE(fit) << fit.error().message;
  const auto report = validate_chain(fit->model, std::span(&slow, 1), 1);
  EXPECT_TRUE(report) << report.error().message;
}

TEST(ValidateChain, ARecordingWithOrientationIsRefusedByAModelWithout) {
  ChainRecipe recipe = quick();
  recipe.event = {EventKind::kMinimum, "horizontal_speed"};
  const auto fit = learned(made_falls({.falls = 20, .orientation = false}), recipe);
  ASSERT_TRUE(fit) << fit.error().message;
  const Recording posed = made_falls({.falls = 4});
  const auto report = validate_chain(fit->model, std::span(&posed, 1), 1);
  ASSERT_FALSE(report);
  EXPECT_THAT(report.error().message, HasSubstr("orientation"));
}

TEST(LearnChain, EventsOfAChannelThatIsNotPlayedAreNotCalledMissing) {
  Recording falls = made_falls({.falls = 40});
  Channel flashes{"light", "", Role::kOutput, {}};
  for (std::size_t row = 0; row < falls.rows(); ++row) {
    flashes.samples.push_back(std::sin(0.2 * static_cast<double>(row)));
  }
  falls.channels.push_back(flashes);
  ChainRecipe recipe = quick();
  recipe.event = {EventKind::kMaximum, "light"};
  const auto fit = learned(falls, recipe);
  ASSERT_TRUE(fit) << fit.error().message;
  EXPECT_THAT(fit->report.verdict->reason, testing::Not(HasSubstr("have no events")));
}

TEST(ValidateChain, WhatIsNoChainOrSaysNotHowItWasCutIsAnError) {
  const Recording recording = made_falls({.falls = 4});
  auto fit = learned(recording);
  ASSERT_TRUE(fit);
  fit->model.training.motion.reset();
  EXPECT_THAT(validate_chain(fit->model, std::span(&recording, 1), 1).error().message, HasSubstr("learn it again"));
  EXPECT_THAT(validate_chain(Model{}, std::span(&recording, 1), 1).error().message,
              HasSubstr("is not a segment chain"));
}

}  // namespace
}  // namespace wisp::chain::learn_chain_test
