#include "learn/arx/learn_arx.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "learn/arx/made_system.hpp"
#include "learn/judge/judged_fit.hpp"

namespace wisp::learn_arx_test {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

// The recipe that describes made_system().
ArxRecipe recipe_of_made() {
  const ArxOrders orders = made_system().orders;
  return {.name = "made",
          .inputs = {"u1", "u2"},
          .outputs = {"y1", "y2"},
          .na = orders.na,
          .nb = orders.nb,
          .nk = orders.nk};
}

Fit learned(const Recording& recording, const ArxRecipe& recipe) {
  auto fit = learn_arx({&recording, 1}, recipe);
  EXPECT_TRUE(fit) << fit.error().message;
  return std::move(*fit);
}

double number_of(const Report& report, const std::string& id) {
  const ReportEntry* entry = report.find(id);
  EXPECT_NE(entry, nullptr) << id;
  return entry ? std::get<double>(entry->value) : 0;
}

const ReportSeries* series_of(const Report& report, const std::string& id) {
  for (const ReportSection& section : report.sections) {
    for (const ReportSeries& series : section.series) {
      if (series.id == id) return &series;
    }
  }
  return nullptr;
}

TEST(LearnArx, AModelWhoseResidualsHaveASingularCovarianceCanBeWritten) {
  Recording recording = record_system(made_system(), 1000, 1, 0);
  ArxRecipe recipe = recipe_of_made();
  recipe.na = recipe.nb = 2, recipe.nk = 1;
  const Channel of = recording.channels[*find_channel(recording, "y1")];
  for (int k = 3; k < 12; ++k) {
    Channel& copy = recording.channels.emplace_back(of);
    copy.name = "y" + std::to_string(k);
    recipe.outputs.push_back(copy.name);
    for (double& value : copy.samples) value *= 0.3 * k;
  }
  const Fit fit = learned(recording, recipe);
  for (const auto& figure : fit.model.training.figures) EXPECT_TRUE(std::isfinite(figure.value)) << figure.name;
  EXPECT_EQ(fit.model.training.figures.back().name, "samples_used");
}

TEST(LearnArx, TheModelIsThatOfTheFitWithItsChannelsAndAnAccount) {
  const Recording recording = record_system(made_system(), 2000, 1);
  const Fit fit = learned(recording, recipe_of_made());
  const auto alone = fit_arx({&recording, 1}, {{"u1", "u2"}, {"y1", "y2"}}, {.orders = made_system().orders});
  ASSERT_TRUE(alone);
  EXPECT_EQ(std::get<ArxModel>(fit.model.dynamics).theta, alone->model.theta);
  EXPECT_EQ(fit.model.name, "made");
  EXPECT_EQ(fit.model.rate_hz, 10);
  EXPECT_EQ(fit.model.outputs[1].name, "y2");
  EXPECT_EQ(fit.model.inputs[0].highest,
            *std::max_element(recording.channels[0].samples.begin(), recording.channels[0].samples.end()));
  EXPECT_THAT(fit.model.training.sources, ElementsAre("made"));
  EXPECT_THAT(fit.model.training.recipe,
              ElementsAre(Note{"na", "2,1;0,3"}, Note{"nb", "2,1;0,2"}, Note{"nk", "1,3;0,0"}, Note{"coupling", "full"},
                          Note{"offset", "mean"}));
  EXPECT_TRUE(fit.model.training.usable.verdict);
  EXPECT_EQ(number_of(fit.report, "fpe"), alone->summary.fpe);
  EXPECT_GT(std::get<double>(std::get<ReportList>(fit.report.find("whiteness_p")->value)[0]), 0.001);
}

TEST(LearnArx, PeopleSeeCoefficientsWithStandardErrorsFirst) {
  const Fit fit = learned(record_system(made_system(), 2000, 1), recipe_of_made());
  const ReportSection& first = fit.report.sections.front();
  EXPECT_THAT(first.title, HasSubstr("Coefficients of y1"));
  ASSERT_EQ(first.entries.size(), 6u);
  EXPECT_EQ(first.entries[0].label, "A  y1(t-1)");
  EXPECT_EQ(first.entries[5].label, "B  u2(t-3)");
  EXPECT_NEAR(std::get<double>(first.entries[0].value), -1.4, 0.02);
  EXPECT_THAT(first.entries[0].meaning, HasSubstr("± 0.00"));
}

TEST(LearnArx, OpenDelaysAreFoundAndNoted) {
  ArxRecipe recipe = recipe_of_made();
  recipe.outputs = {"y1"};
  recipe.inputs = {"u1"};
  recipe.na = recipe.nb = 2;
  recipe.nk = std::nullopt;
  const Fit fit = learned(record_system(made_system(), 2000, 1), recipe);
  EXPECT_EQ(std::get<ArxModel>(fit.model.dynamics).orders.nk(0, 0), 1);
  EXPECT_THAT(fit.model.training.recipe, testing::Contains(Note{"nk", "1"}));
}

TEST(LearnArx, AnOpenDelayOfOneLagIsExact) {
  for (unsigned seed = 1; seed <= 40; ++seed) {
    std::mt19937_64 generator(seed);
    std::normal_distribution<double> normal;
    Recording recording{.rate_hz = 1, .channels = {{"u", "", Role::kInput, {}}, {"y", "", Role::kOutput, {}}}};
    auto &u = recording.channels[0].samples, &y = recording.channels[1].samples;
    for (std::size_t t = 0; t < 600; ++t) {
      u.push_back(normal(generator));
      y.push_back((t > 0 ? 0.8 * y.back() : 0) + (t >= 12 ? u[t - 12] : 0) + normal(generator));
    }
    const ArxRecipe recipe{.inputs = {"u"}, .outputs = {"y"}, .na = 1, .nb = 1, .nk = std::nullopt};
    EXPECT_EQ(std::get<ArxModel>(learned(recording, recipe).model.dynamics).orders.nk(0, 0), 12) << seed;
  }
}

TEST(LearnArx, ASearchTakesTheBestOrdersAndListsAllCandidates) {
  ArxRecipe recipe = recipe_of_made();
  recipe.outputs = {"y2"};
  recipe.inputs = {"u2"};
  recipe.search = ArxSearch{.na = {1, 5}, .nb = {1, 3}, .nk = {0, 1}, .by = OrderCriterion::kBic};
  const Fit fit = learned(record_system(made_system(), 4000, 1), recipe);
  const ArxOrders& orders = std::get<ArxModel>(fit.model.dynamics).orders;
  EXPECT_EQ(orders.na(0, 0), 3);
  EXPECT_EQ(orders.nb(0, 0), 2);
  EXPECT_EQ(orders.nk(0, 0), 0);
  std::size_t candidates = 0;
  for (const ReportSection& section : fit.report.sections) {
    for (const ReportTable& table : section.tables) {
      if (table.id == "candidates") candidates = table.rows.size();
    }
  }
  EXPECT_EQ(candidates, 30u);
}

TEST(LearnArx, AnUnstableModelThatIsKeptIsReturnedAndItsVerdictSaysThatItCannotBePlayed) {
  Recording recording{.source = "growing", .rate_hz = 1, .channels = {{"y", "", Role::kOutput, {1}}}};
  std::mt19937_64 generator(2);
  std::normal_distribution<double> normal;
  for (int t = 1; t < 200; ++t) {
    recording.channels[0].samples.push_back(1.02 * recording.channels[0].samples.back() + 0.01 * normal(generator));
  }
  ArxRecipe recipe{.outputs = {"y"}, .na = 1, .nb = 0, .offset = ArxOffset::kNone, .keep_unstable = true};
  const Fit kept = learned(recording, recipe);
  EXPECT_GT(number_of(kept.report, "stable.radius"), 1);
  ASSERT_TRUE(kept.report.verdict);
  EXPECT_FALSE(kept.report.verdict->usable);
  EXPECT_THAT(kept.report.verdict->reason, HasSubstr("unstable"));
  recipe.keep_unstable = false;
  EXPECT_LT(number_of(learned(recording, recipe).report, "stable.radius"), 1);
}

TEST(LearnArx, PolesOfOtherOutputsThatZerosCancelAreNotDrawn) {
  ArxRecipe recipe{.inputs = {"u1"}, .outputs = {"y1", "y2"}, .na = 2, .nb = 1, .coupling = Coupling::kDiagonal};
  recipe.responses = true;
  const Fit fit = learned(record_system(made_system(), 2000, 1), recipe);
  EXPECT_EQ(series_of(fit.report, "poles")->x.size(), 4u);
  for (const char* output : {"0", "1"}) {
    EXPECT_EQ(series_of(fit.report, std::string("poles.") + output + ".0")->x.size(), 2u);
    EXPECT_TRUE(series_of(fit.report, std::string("zeros.") + output + ".0")->x.empty());
  }
}

TEST(LearnArx, WhetherResidualsAreWhiteIsSaidByTheirProbability) {
  ArxRecipe recipe = recipe_of_made();
  const auto said = [&](unsigned seed) {
    return learned(record_system(made_system(), 2000, seed), recipe).report.find("whiteness_p")->meaning;
  };
  int white = 0;
  for (unsigned seed = 1; seed <= 5; ++seed) white += said(seed) == "as white noise would be";
  EXPECT_GE(white, 3);  // each of two outputs' p is below 0.05 in one recording of twenty
  recipe.na = 0;
  EXPECT_EQ(said(1), "below 0.05: the model leaves something to learn");
}

TEST(LearnArx, ResponsesAreSeriesWithBandsAroundThem) {
  ArxRecipe recipe = recipe_of_made();
  recipe.responses = true;
  const Fit fit = learned(record_system(made_system(), 2000, 1), recipe);
  for (const char* id : {"step.0.1", "amplitude.1.0", "phase.1.1"}) {
    const ReportSeries* value = series_of(fit.report, id);
    const ReportSeries* low = series_of(fit.report, std::string(id) + ".low");
    const ReportSeries* high = series_of(fit.report, std::string(id) + ".high");
    ASSERT_TRUE(value && low && high) << id;
    ASSERT_EQ(value->x.size(), value->y.size());
    for (std::size_t k = 0; k < value->y.size(); ++k) {
      EXPECT_LE(low->y[k], value->y[k]) << id;
      EXPECT_GE(high->y[k], value->y[k]) << id;
    }
  }
  EXPECT_EQ(series_of(fit.report, "step.0.0")->x_label, "time, s");
  EXPECT_EQ(series_of(fit.report, "amplitude.0.0")->x_label, "frequency, Hz");
  EXPECT_EQ(series_of(fit.report, "poles")->x.size(), 5u);  // degrees 2 and 3
  EXPECT_NE(fit.report.find("responses.step[1][0].sd"), nullptr);
}

TEST(LearnArx, SettingsOutOfRangeAreNamed) {
  const Recording recording = record_system(made_system(), 200, 1);
  const auto complaint = [&](ArxRecipe recipe) {
    const auto fit = learn_arx({&recording, 1}, recipe);
    return fit ? std::string("none") : fit.error().message;
  };
  ArxRecipe recipe = recipe_of_made();
  recipe.radius = 1;
  EXPECT_THAT(complaint(recipe), HasSubstr("radius is 1, expected 0.001 to"));
  recipe = recipe_of_made();
  recipe.na = OrderMatrix(1, 1, 2);
  EXPECT_THAT(complaint(recipe), HasSubstr("na is 1 × 1, expected 2 × 2"));
  recipe = recipe_of_made();
  recipe.outputs = {};
  EXPECT_THAT(complaint(recipe), HasSubstr("no output channel was named"));
  recipe.outputs = {"y3"};
  EXPECT_THAT(complaint(recipe), HasSubstr("made has no channel 'y3'"));
}

TEST(LearnArx, StopsWhereItIsTold) {
  const Recording recording = record_system(made_system(), 500, 1);
  ArxRecipe recipe = recipe_of_made();
  recipe.search = ArxSearch{.na = {1, 3}, .nb = {1, 3}, .nk = {0, 0}};
  int calls = 0;
  const auto fit = learn_arx({&recording, 1}, recipe, [&](std::string_view stage, double share) {
    EXPECT_EQ(stage, "searching orders");
    EXPECT_NEAR(share, calls / 9.0, 1e-12);
    return ++calls < 4;
  });
  ASSERT_FALSE(fit);
  EXPECT_EQ(fit.error().message, kStopped);
  EXPECT_EQ(calls, 4);
}

TEST(LearnArx, ValidationHasEveryStepOfEveryOutputAndSaysHowOftenIntervalsHold) {
  const Fit fit = learned(record_system(made_system(), 2000, 1), recipe_of_made());
  const auto report = validate_arx(fit.model, record_system(made_system(), 2000, 2), {.steps = {1, 7, kFreeRun}});
  ASSERT_TRUE(report) << report.error().message;
  const ReportTable& channels = report->sections.front().tables.front();
  ASSERT_EQ(channels.rows.size(), 2u);
  const auto column = [&](const std::string& id) {
    return static_cast<std::size_t>(
        std::find_if(channels.columns.begin(), channels.columns.end(), [&](const auto& one) { return one.id == id; }) -
        channels.columns.begin());
  };
  for (const char* k : {"1", "7", "inf"}) {
    ASSERT_LT(column(std::string("fit_percent.") + k), channels.columns.size());
    // 2000 rows, correlated over some ten: a share of 0.95 is known to about ±0.015 (3 sd).
    const auto& inside = channels.rows[0][column(std::string("inside_95_percent_interval.") + k)];
    EXPECT_NEAR(std::get<double>(inside), 0.95, 0.03) << k;
  }
  EXPECT_LT(column("independence_p.u2"), channels.columns.size());
  EXPECT_NE(report->find("J.inf"), nullptr);
  EXPECT_EQ(series_of(*report, "predicted.1")->label, "7 samples ahead");
  EXPECT_EQ(series_of(*report, "poles"), nullptr);
}

TEST(LearnArx, OrdersThatTheFocusChoseAreJudgedNotThoseThatWereGiven) {
  std::mt19937 random(5);
  const auto noise = [&] { return static_cast<double>(random() % 2001) / 1000 - 1; };
  Recording recording{.rate_hz = 1, .channels = {{"u", "", Role::kInput, {}}, {"y", "", Role::kOutput, {}}}};
  auto &u = recording.channels[0].samples, &y = recording.channels[1].samples;
  for (std::size_t t = 0; t < 1200; ++t) {
    u.push_back(noise());
    y.push_back(t < 2 ? 0 : 1.5 * y[t - 1] - 0.7 * y[t - 2] + u[t] + 0.05 * noise());
  }
  const ArxRecipe given{.inputs = {"u"}, .outputs = {"y"}, .na = 4, .nb = 4, .nk = 1};
  const auto least_squares = learn({&recording, 1}, given);
  ASSERT_TRUE(least_squares) << least_squares.error().message;
  EXPECT_NE(least_squares->report.verdict->reason.find("--nk 0"), std::string::npos);

  ArxRecipe free = given;
  free.focus = ArxFocus::kAuto;
  const auto chosen = learn({&recording, 1}, free);
  ASSERT_TRUE(chosen) << chosen.error().message;
  EXPECT_EQ(std::get<ArxModel>(chosen->model.dynamics).orders.nk(0, 0), 0);
  EXPECT_TRUE(chosen->report.verdict->usable) << chosen->report.verdict->reason;
}

TEST(LearnArx, PlotsOfAPartOfARecordingHaveTheTimeOfTheWhole) {
  const Recording whole = record_system(made_system(), 2000, 1);
  const Fit fit = learned(whole, recipe_of_made());
  const auto report = validate_arx(fit.model, slice(slice(whole, 500, 2000), 1000, 1400), {.steps = {1}});
  ASSERT_TRUE(report) << report.error().message;
  const ReportSeries& measured = *series_of(*report, "measured.0");
  EXPECT_EQ(measured.x.size(), 400U);
  EXPECT_DOUBLE_EQ(measured.x.front(), 1500 / whole.rate_hz);
}

TEST(LearnArx, PlotsOfARecordingAtAnotherLevelAreAtItsOwnLevel) {
  std::vector<Recording> recordings{record_system(made_system(), 600, 1), record_system(made_system(), 600, 2)};
  std::vector<double>& high = recordings[1].channels[*find_channel(recordings[1], "y1")].samples;
  for (double& y : high) y += 100;
  const auto fit = learn_arx(recordings, recipe_of_made());
  ASSERT_TRUE(fit) << fit.error().message;
  const auto report = validate_arx(fit->model, recordings[1], {.steps = {1, kFreeRun}});
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_NEAR(series_of(*report, "measured.0")->y.back(), high.back(), 1e-9);
  for (const char* id : {"predicted.0", "predicted.0.low", "simulated.0"})
    EXPECT_NEAR(series_of(*report, id)->y.back(), high.back(), 5) << id;
}

TEST(LearnArx, AModelInUnitsBeyondThoseOfPlayIsNotUsable) {
  Recording recording = record_system(made_system(), 1000, 1);
  EXPECT_TRUE(learn(recording, recipe_of_made())->report.verdict->usable);
  for (Channel& channel : recording.channels) {
    for (double& sample : channel.samples) sample *= 1e13;
  }
  const auto fit = learn(recording, recipe_of_made());
  ASSERT_TRUE(fit) << fit.error().message;
  EXPECT_FALSE(fit->report.verdict->usable);
  EXPECT_THAT(fit->report.verdict->reason, HasSubstr("the model cannot be played"));
  EXPECT_EQ(fit->model.training.usable, (Usable{false, fit->report.verdict->reason}));
}

TEST(LearnArx, AnOutputThatMovesTooFarFromZeroForSinglePrecisionIsNamed) {
  Recording recording = record_system(made_system(), 1000, 1);
  const auto coarse = Contains(HasSubstr("output 'y2' moves by"));
  EXPECT_THAT(learn(recording, recipe_of_made())->report.warnings, Not(coarse));
  for (double& y : recording.channels[3].samples) y += 1e8;
  const auto fit = learn(recording, recipe_of_made());
  ASSERT_TRUE(fit) << fit.error().message;
  EXPECT_THAT(fit->report.warnings, coarse);
}

TEST(LearnArx, RecordingsWhoseUnitsDifferAreNamed) {
  std::vector<Recording> recordings(3, record_system(made_system(), 600, 1));
  Channel &first = recordings[0].channels[2], &second = recordings[1].channels[2];
  recordings[1].source = "second";
  first.unit = second.unit = "m";
  auto fit = learn(recordings, recipe_of_made());
  ASSERT_TRUE(fit) << fit.error().message;
  EXPECT_EQ(fit->model.outputs[0].unit, "m");
  EXPECT_THAT(fit->report.warnings, Not(Contains(HasSubstr(" is in "))));
  second.unit = "cm";
  fit = learn(recordings, recipe_of_made());
  ASSERT_TRUE(fit) << fit.error().message;
  EXPECT_THAT(fit->report.warnings, Contains(HasSubstr("second: 'y1' is in cm, in the first recording in m")));
}

TEST(LearnArx, ValidationRefusesAStrangerAndStepsOutOfRange) {
  const Fit fit = learned(record_system(made_system(), 500, 1), recipe_of_made());
  Recording other = record_system(made_system(), 500, 2);
  EXPECT_THAT(validate_arx(fit.model, other, {.steps = {-1}}).error().message, HasSubstr("-1 steps ahead"));
  EXPECT_THAT(validate_arx(fit.model, slice(other, 0, 3)).error().message, HasSubstr("made: no row can be predicted"));
  other.channels.pop_back();
  EXPECT_THAT(validate_arx(fit.model, other).error().message, HasSubstr("has no channel 'y2'"));
}

}  // namespace
}  // namespace wisp::learn_arx_test
