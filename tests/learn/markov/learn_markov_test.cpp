#include "learn/markov/learn_markov.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "learn/markov/made_markov.hpp"
#include "learn/markov/markov_rows.hpp"

namespace wisp::learn_switched_test {
namespace {

using testing::HasSubstr;

SwitchedRecipe recipe_of_made() {
  return {.name = "made", .inputs = {"u"}, .outputs = {"y"}, .na = 1, .nb = 1, .nk = 1, .modes = 3};
}

TEST(LearnSwitched, TheModelIsThatOfTheFitAndTheReportTellsEveryMode) {
  const Recording recording = made_chain(1000, 1).recording;
  const auto fit = learn_switched({&recording, 1}, recipe_of_made());
  ASSERT_TRUE(fit) << fit.error().message;
  const auto alone = markov::fit({&recording, 1}, {{"u"}, {"y"}}, {.orders = first_order(), .modes = 3});
  ASSERT_TRUE(alone);
  const auto& model = std::get<SwitchedArxModel>(fit->model.dynamics);
  ASSERT_EQ(model.modes.size(), 3u);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(model.modes[k].theta, alone->model.modes[k].theta);
  EXPECT_TRUE(fit->report.verdict->usable) << fit->report.verdict->reason;
  EXPECT_THAT(fit->report.sections.front().title, HasSubstr("Mode 0: Coefficients of y"));
  EXPECT_EQ(std::get<ReportList>(fit->report.find("mode_rows")->value).size(), 3u);
  EXPECT_NE(fit->report.find("transitions"), nullptr);
  EXPECT_EQ(fit->model.training.figures.front(), (Figure{"samples_used", 999}));
  EXPECT_THAT(fit->model.training.recipe, testing::Contains(Note{"modes", "3"}));
}

TEST(LearnSwitched, ValidationCountsTheRowsOfEveryMode) {
  const Recording recording = made_chain(1000, 1).recording, other = made_chain(600, 2).recording;
  const auto fit = learn_switched({&recording, 1}, recipe_of_made());
  ASSERT_TRUE(fit) << fit.error().message;
  const auto report = validate_switched(fit->model, other, {.steps = {1, kFreeRun}});
  ASSERT_TRUE(report) << report.error().message;
  std::int64_t rows = 0;
  for (const ReportValue& one : std::get<ReportList>(report->find("mode_rows")->value)) {
    rows += std::get<std::int64_t>(one);
  }
  EXPECT_EQ(rows, 599);
  const ReportTable& channels = report->sections.front().tables.front();
  EXPECT_EQ(channels.columns[1].id, "fit_percent.1");
  EXPECT_GT(std::get<double>(channels.rows[0][1]), 40);
}

TEST(LearnSwitched, ARecordingTooShortToPredictIsRefused) {
  const Recording recording = made_chain(1000, 1).recording;
  const auto fit = learn_switched({&recording, 1}, recipe_of_made());
  ASSERT_TRUE(fit) << fit.error().message;
  const auto report = validate_switched(fit->model, slice(recording, 0, 10), {.steps = {1, 15}});
  ASSERT_FALSE(report);
  EXPECT_THAT(report.error().message, testing::HasSubstr("too short"));
}

TEST(LearnSwitched, ModesForWhichBriefTakesAreTooFewAreRefused) {
  Recording takes = made_chain(51, 1).recording;
  for (std::size_t row = 0; row < takes.rows(); ++row) takes.episode_ids.push_back(static_cast<std::int64_t>(row / 3));
  EXPECT_FALSE(learn_switched({&takes, 1}, recipe_of_made()));
}

TEST(LearnSwitched, ASingleModeThatWasRequestedIsNotComparedWithModesThatWereNotTried) {
  const Recording recording = made_chain(1000, 1).recording;
  SwitchedRecipe recipe = recipe_of_made();
  recipe.modes = 1;
  const auto fit = learn_switched({&recording, 1}, recipe);
  ASSERT_TRUE(fit) << fit.error().message;
  EXPECT_THAT(fit->report.verdict->reason, HasSubstr("no further ones were tried"));
}

TEST(LearnSwitched, StopsBetweenStarts) {
  const Recording recording = made_chain(1000, 1).recording;
  int calls = 0;
  const auto fit = learn_switched({&recording, 1}, recipe_of_made(), [&](std::string_view stage, double) {
    if (++calls == 1) {
      EXPECT_EQ(stage, "trying 1 mode");
    } else {
      EXPECT_EQ(stage, "trying 3 modes");
    }
    return calls < 5;
  });
  ASSERT_FALSE(fit);
  EXPECT_EQ(fit.error().message, kStopped);
  EXPECT_EQ(calls, 5);
}

TEST(LearnSwitched, StopsWhileTheModesOfTheBestStartSettle) {
  const Recording recording = made_chain(1000, 1).recording;
  const auto fit = learn_switched({&recording, 1}, recipe_of_made(),
                                  [](std::string_view stage, double) { return stage != "settling modes"; });
  ASSERT_FALSE(fit);
  EXPECT_EQ(fit.error().message, kStopped);
}

}  // namespace
}  // namespace wisp::learn_switched_test
