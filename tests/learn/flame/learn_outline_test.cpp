#include "learn/flame/learn_outline.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <set>
#include <utility>

#include "learn/flame/made_blow_outs.hpp"
#include "learn/numeric/constants.hpp"
#include "learn/outline/made_outline.hpp"
#include "record/loudness.hpp"
#include "wisp/learn/validate.hpp"
#include "wisp/model/file.hpp"

namespace wisp::learn_outline_test {
namespace {

using testing::HasSubstr;
using testing::IsSupersetOf;

Fit learned(const std::vector<Recording>& recordings, const OutlineRecipe& recipe) {
  auto fit = learn_outline(recordings, recipe);
  EXPECT_TRUE(fit) << (fit ? "" : fit.error().message);
  return *std::move(fit);
}

Recording windy(std::uint64_t seed = 1) {
  return made::outline_recording({.rows = 900, .shock = 0.003, .wind = true, .seed = seed});
}

// The top of an id, up to its first dot: a field of the JSON document.
std::set<std::string> fields(const Report& report) {
  std::set<std::string> out;
  for (const ReportSection& section : report.sections) {
    for (const ReportEntry& entry : section.entries) out.insert(entry.id.substr(0, entry.id.find('.')));
    for (const ReportTable& table : section.tables) out.insert(table.id.substr(0, table.id.find('.')));
  }
  return out;
}

template <class T>
T figure(const Report& report, const std::string& id) {
  const ReportEntry* entry = report.find(id);
  EXPECT_NE(entry, nullptr) << id;
  return std::get<T>(static_cast<const ReportValue::Base&>(entry->value));
}

TEST(LearnOutline, TheReportHasEveryPromisedField) {
  const Fit fit = learned({windy()}, {});
  EXPECT_THAT(fields(fit.report),
              IsSupersetOf({"rate_hz", "inputs", "points", "na", "nb", "nk", "samples", "J", "tip", "overlap", "stable",
                            "gain", "extinction", "alignment", "components", "outside_share", "crossed_share"}));
  EXPECT_EQ(figure<std::int64_t>(fit.report, "points"), 6);
  EXPECT_GT(figure<double>(fit.report, "tip.held_out_fit_percent.inf"), 50);
  ASSERT_TRUE(fit.report.verdict);
  EXPECT_EQ(fit.report.verdict->usable, fit.model.training.usable.verdict);
}

// A flame of 900 rows that flickers, and from row 690 on grows to twice its size: no model keeps the spread of both.
Recording growing_flame() {
  const std::size_t rows = 900, steady = 690;
  Recording film = made::outline_recording({.rows = rows, .shock = 0.003});
  for (Channel& channel : film.channels) {
    const double middle = channel.name.ends_with(".x") ? 320 : 400;
    for (std::size_t row = steady; row < rows; ++row) {
      const double grown = 1 + static_cast<double>(row - steady) / static_cast<double>(rows - steady);
      channel.samples[row] = middle + grown * (channel.samples[row] - middle);
    }
  }
  return film;
}

TEST(LearnOutline, FilmsOfTwoRatesAreRefused) {
  Recording slow = windy();
  slow.rate_hz /= 2;
  const auto fit = learn(std::vector<Recording>{windy(), slow}, OutlineRecipe());
  ASSERT_FALSE(fit);
  EXPECT_THAT(fit.error().message, HasSubstr("learn from films of one rate"));
}

TEST(LearnOutline, RatesThatDifferByLessThanAThousandthCountAsOneRate) {
  Recording other = windy(2);
  other.rate_hz *= 1.0005;
  OutlineRecipe recipe;
  recipe.paper = 4;
  const auto fit = learn_outline(std::vector{windy(), other}, recipe);
  EXPECT_TRUE(fit) << fit.error().message;
}

TEST(LearnOutline, OfAFilmThatChangesTheLongestSteadyPartIsLearned) {
  const Fit fit = learned({growing_flame()}, {});
  EXPECT_TRUE(fit.report.verdict->usable) << fit.report.verdict->reason;
  EXPECT_THAT(fit.report.verdict->reason, HasSubstr("learned from frames 1 to 675 of 900 alone"));
  EXPECT_EQ(fit.model.training.usable.reason, fit.report.verdict->reason);
  const auto rows_used =
      figure<std::int64_t>(fit.report, "samples.learned") + figure<std::int64_t>(fit.report, "samples.held_out");
  EXPECT_EQ(rows_used, 675);
}

TEST(LearnOutline, WhoStopsItWhilePartsAreTriedHasStoppedIt) {
  const std::vector film{growing_flame()};
  double before = 0;
  const auto fit = learn_outline(film, {}, [&](std::string_view, double share) {
    const bool again = share < before;  // the whole was learned, and a part begins
    before = share;
    return !again;
  });
  ASSERT_FALSE(fit);
  EXPECT_EQ(fit.error().message, kStopped);
}

TEST(LearnOutline, KeepsTheCandleThatTheFirstFilmWithOneShows) {
  std::vector<Recording> recordings{windy(), windy(2)};
  set_numbers_attribute(recordings[1], "candle", std::array{0.8, 200.0, 60.0, 40.0});
  const auto& figures = learned(recordings, {}).model.training.figures;
  const auto found =
      std::find_if(figures.begin(), figures.end(), [](const Figure& one) { return one.name == "candle.width"; });
  ASSERT_GE(figures.end() - found, 4);
  EXPECT_EQ(found[0].value, 0.8);
  EXPECT_EQ(found[3].name, "candle.blue");
  EXPECT_EQ(found[3].value, 40);
}

TEST(LearnOutline, AnOutlineIsNotExtinguishedAndAFlameIs) {
  const Recording recording = windy();
  EXPECT_FALSE(learned({recording}, {}).model.extinction);
  const Fit flame = learned({recording}, FlameRecipe{});
  ASSERT_TRUE(flame.model.extinction);
  EXPECT_EQ(figure<std::string>(flame.report, "extinction.source"), "default");
}

TEST(LearnOutline, AGivenRuleIsTaken) {
  OutlineRecipe recipe;
  recipe.extinction = {ExtinctionSource::kGiven, 1.5, 0.25};
  const Fit fit = learned({windy()}, recipe);
  ASSERT_TRUE(fit.model.extinction);
  EXPECT_EQ(fit.model.extinction->level, 1.5);
  EXPECT_EQ(fit.model.extinction->haste, 0);
  EXPECT_EQ(fit.model.training.extinction->origin, Origin::kGiven);
  recipe.extinction.seconds = 0;
  EXPECT_THAT(learn_outline(std::vector{windy()}, recipe).error().message, HasSubstr("rule of extinction"));
  recipe.extinction.seconds = 0.25;
  const std::vector calm{made::outline_recording({.rows = 900})};
  EXPECT_THAT(learn_outline(calm, recipe).error().message, HasSubstr("no input that could put it out"));
}

TEST(LearnOutline, ExtinctionIsLearnedFromRecordingsAndJudgedOnOthers) {
  const Recording seen = made::blow_out_recording({.shortest = 0.2, .seed = 2}).recording;
  const Recording unseen = made::blow_out_recording({.shortest = 0.2, .seed = 3}).recording;
  const Fit fit = learned({seen}, FlameRecipe{});
  EXPECT_EQ(fit.model.training.extinction->origin, Origin::kLearned);
  EXPECT_GT(figure<std::int64_t>(fit.report, "extinction.agreement.deaths"), 4);
  const auto judged = validate_outline(fit.model, unseen, {.fidelity = false});
  ASSERT_TRUE(judged) << judged.error().message;
  const auto deaths = figure<std::int64_t>(judged->report, "extinction.deaths");
  EXPECT_GT(deaths, 4);
  EXPECT_GE(figure<std::int64_t>(judged->report, "extinction.died") + 1, deaths);
}

TEST(LearnOutline, ExtinctionIsLearnedFromTheInputThatIsNamed) {
  Recording seen = made::blow_out_recording({.shortest = 0.2, .seed = 2}).recording;
  Channel other = seen.channels[*find_channel(seen, "wind")];
  other.name = "other";
  std::reverse(other.samples.begin(), other.samples.end());
  seen.channels.push_back(std::move(other));
  std::swap(seen.channels[*find_channel(seen, "wind")], seen.channels.back());
  FlameRecipe recipe;
  recipe.inputs = {"wind"};
  const Fit fit = learned({seen}, recipe);
  ASSERT_TRUE(fit.model.extinction);
  EXPECT_EQ(fit.model.training.extinction->origin, Origin::kLearned);
  EXPECT_GT(figure<std::int64_t>(fit.report, "extinction.agreement.deaths"), 4);
}

TEST(LearnOutline, OneMicrophonesRecordingsAreLearnedWithACommonGain) {
  std::vector recordings{windy(1), windy(2)};
  for (double& value : recordings[1].channels[*find_channel(recordings[1], "wind")].samples) value /= 2.5;
  set_one_rms(recordings[0], "wind", 0.04);
  set_one_rms(recordings[1], "wind", 0.04 * 2.5 * 2.5);
  const Fit fit = learned(recordings, {});
  EXPECT_DOUBLE_EQ(fit.model.training.inputs[0].one_rms, 0.04 * 2.5 * 2.5);
}

// A microphone that hears gusts which never reach the thing.
Recording with_wind_elsewhere() { return made::outline_recording({.rows = 900, .wind = true, .lean = 0, .seed = 4}); }

TEST(LearnOutline, AnInputThatMovesNothingIsLeftOutWithAWarning) {
  const Fit fit = learned({with_wind_elsewhere()}, {});
  EXPECT_TRUE(fit.model.inputs.empty());
  EXPECT_TRUE(fit.report.verdict->usable) << fit.report.verdict->reason;
  EXPECT_THAT(fit.report.warnings, testing::Contains(HasSubstr("nothing in common with the motion")));
}

TEST(LearnOutline, CanBeStoppedWhileItIsLearnedWithoutItsInput) {
  double last = 0;
  const auto until_it_begins_again = [&](std::string_view, double share) {
    return share >= std::exchange(last, share);
  };
  const auto stopped = learn_outline(std::vector{with_wind_elsewhere()}, {}, until_it_begins_again);
  ASSERT_FALSE(stopped);
  EXPECT_EQ(stopped.error().message, kStopped);
}

// Wind moves it in the first part of the recording only: in the held-out last part it leans without wind, as in a
// draught that no microphone hears.
TEST(LearnOutline, AnInputThatDoesNotPredictHeldOutMotionIsLeftOutWithAWarning) {
  Recording recording = windy();
  auto& wind = recording.channels[*find_channel(recording, "wind")].samples;
  std::reverse(wind.begin() + static_cast<std::ptrdiff_t>(wind.size() * 6 / 10), wind.end());
  const Fit fit = learned({recording}, {});
  EXPECT_TRUE(fit.model.inputs.empty());
  EXPECT_TRUE(fit.report.verdict->usable) << fit.report.verdict->reason;
  EXPECT_THAT(fit.report.warnings, testing::Contains(HasSubstr("does not predict the motion: learned without it")));
}

TEST(LearnOutline, SoundInWhichNobodyBlowsIsLeftOutWithAWarning) {
  Recording recording = with_wind_elsewhere();
  for (double& u : recording.channels[*find_channel(recording, "wind")].samples) u = 0;
  const Fit fit = learned({recording}, FlameRecipe{});
  EXPECT_TRUE(fit.model.inputs.empty());
  EXPECT_TRUE(fit.report.verdict->usable) << fit.report.verdict->reason;
  EXPECT_THAT(fit.report.warnings, testing::Contains(HasSubstr("nothing was heard as wind: learned without it")));
}

TEST(LearnOutline, AnInputThatIsNamedStays) {
  OutlineRecipe recipe;
  recipe.inputs = {"wind"};
  const Fit fit = learned({with_wind_elsewhere()}, recipe);
  EXPECT_FALSE(fit.model.inputs.empty());
  EXPECT_FALSE(fit.report.verdict->usable);
}

TEST(LearnOutline, AnInputThatMovesItStays) { EXPECT_FALSE(learned({windy()}, {}).model.inputs.empty()); }

TEST(LearnOutline, AnInputThatMovesItStaysWithoutAlignment) {
  OutlineRecipe recipe;
  recipe.align = false;
  EXPECT_FALSE(learned({windy()}, recipe).model.inputs.empty());
}

TEST(LearnOutline, AFilmShorterThanHalfASecondGivesAModelThatCanBeStored) {
  const Fit fit = learned({made::outline_recording({.rows = 100, .rate_hz = 240})}, {});
  EXPECT_TRUE(model_bytes(fit.model));
}

TEST(LearnOutline, CalmRowsWithoutAnOutlineDoNotHideTheOthers) {
  Recording film = made::outline_recording({.rows = 600, .wind = true});
  for (Channel& channel : film.channels) {
    for (std::size_t row = 0; row < 600; ++row) {
      if (channel.name == "wind") channel.samples[row] = row < 90 ? 0 : 3;
      if (channel.name != "wind" && row < 90) channel.samples[row] = std::nan("");
    }
  }
  EXPECT_TRUE(learn_outline(std::vector{film}, {}));
}

TEST(LearnOutline, AGivenRuleOfASilentInputNamesTheInput) {
  Recording quiet = made::outline_recording({.rows = 900});
  quiet.channels.push_back({"wind", "1", Role::kInput, std::vector<double>(quiet.rows(), 0.0)});
  FlameRecipe recipe;
  recipe.extinction = {ExtinctionSource::kGiven, 1.5, 0.25};
  const auto fit = learn_outline(std::vector{quiet}, recipe);
  ASSERT_FALSE(fit);
  EXPECT_THAT(fit.error().message, HasSubstr("wind"));
}

TEST(LearnOutline, FlickerAloneIsLearnedFromFilmsOfWhichOneHasNoSound) {
  FlameRecipe recipe;
  recipe.inputs.emplace();
  const auto fit = learn_outline(std::vector{windy(), made::outline_recording({.rows = 900, .seed = 2})}, recipe);
  EXPECT_TRUE(fit) << fit.error().message;
}

TEST(LearnOutline, ASilentInputBesideOneThatIsHeardIsLeftOut) {
  Recording both = windy();
  both.channels.insert(both.channels.begin(), {"dead", "1", Role::kInput, std::vector<double>(both.rows(), 0.0)});
  const auto fit = learn_outline(std::vector{both}, FlameRecipe());
  ASSERT_TRUE(fit) << fit.error().message;
  ASSERT_EQ(fit->model.inputs.size(), 1u);
  EXPECT_EQ(fit->model.inputs[0].name, "wind");
  EXPECT_TRUE(fit->model.extinction);
  EXPECT_THAT(fit->report.warnings, testing::Contains(HasSubstr("its input dead is 0 throughout: left out")));
}

TEST(LearnOutline, AnInputThatTheFirstRecordingLacksIsNamed) {
  const Fit fit = learned({made::outline_recording({.rows = 900, .seed = 2}), windy()}, {});
  EXPECT_TRUE(fit.model.inputs.empty());
  EXPECT_THAT(fit.report.warnings, testing::Contains(HasSubstr("made 1: its input wind is left out: made 2")));
}

TEST(LearnOutline, ARecordingWithoutASampleOfItsInputIsNamedAndNotJudgedBy) {
  Recording deaf = made::outline_recording({.rows = 900, .shock = 0.01, .wind = true, .seed = 2});
  std::ranges::fill(deaf.channels[*find_channel(deaf, "wind")].samples, kMissing);
  const Fit fit = learned({windy(), deaf}, {});
  EXPECT_TRUE(fit.model.training.usable.verdict) << fit.model.training.usable.reason;
  EXPECT_THAT(fit.report.warnings, testing::Contains(HasSubstr("not learned from")));
}

TEST(LearnOutline, CanBeStopped) {
  const auto stopped =
      learn_outline(std::vector{windy()}, {}, [](std::string_view, double share) { return share < 0.5; });
  ASSERT_FALSE(stopped);
  EXPECT_EQ(stopped.error().message, kStopped);
  EXPECT_FALSE(learn_outline({}, {}));
}

TEST(ValidateOutline, TheReportHasEveryPromisedFieldAndSeriesForPlots) {
  const Fit fit = learned({windy()}, {});
  const Recording recording = windy(7);
  const auto found = validate_outline(fit.model, recording, {.responses = true, .play_seconds = 20});
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_THAT(fields(found->report), IsSupersetOf({"gain", "rows", "alignment", "J", "tip", "overlap", "fidelity",
                                                   "held_share", "crossed_share", "extinction"}));
  EXPECT_GT(figure<double>(found->report, "tip.fit_percent.inf"), 60);
  std::set<std::string> series;
  for (const ReportSection& section : found->report.sections) {
    for (const ReportSeries& one : section.series) {
      series.insert(one.id);
      EXPECT_EQ(one.x.size(), one.y.size()) << one.id;
    }
  }
  EXPECT_THAT(series, IsSupersetOf({"tip.captured", "tip.simulated", "input.wind", "flicker.x.synthesized", "poles"}));
  EXPECT_EQ(found->captured.size(), recording.rows());
  EXPECT_EQ(found->played.size(), recording.rows());
  EXPECT_EQ(found->simulated_label, "simulated from the input alone");
}

TEST(ValidateOutline, ACalmRecordingIsJudgedWithItsOwnGainToo) {
  const Fit fit = learned({windy()}, FlameRecipe());
  Recording calm = windy(7);
  std::ranges::fill(calm.channels[*find_channel(calm, "wind")].samples, 0.0);
  const auto found = validate_outline(fit.model, calm, {.own_input_scale = true, .play_seconds = 20});
  EXPECT_TRUE(found) << found.error().message;
}

TEST(ValidateOutline, ADurationOfPlayThatIsNotPositiveIsRefused) {
  const auto found = validate_outline(Model(), windy(), {.play_seconds = -1});
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().message, "play_seconds is -1, expected 0.001 to 86400");
}

TEST(ValidateOutline, CanBeStopped) {
  const Fit fit = learned({windy()}, {});
  const auto stopped = validate_outline(fit.model, windy(7), {}, [](std::string_view, double) { return false; });
  ASSERT_FALSE(stopped);
  EXPECT_EQ(stopped.error().message, kStopped);
  EXPECT_FALSE(validate_outline(fit.model, windy(7), {.steps = {}}));
}

}  // namespace
}  // namespace wisp::learn_outline_test
