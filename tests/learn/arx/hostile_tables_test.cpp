// Tables that an expert tried: the sentence and the figure that each has to yield.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "learn/shared_files.hpp"
#include "wisp/learn/advice.hpp"
#include "wisp/learn/learn.hpp"
#include "wisp/learn/validate.hpp"

namespace wisp::hostile_tables_test {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::Field;
using testing::HasSubstr;
using testing::SizeIs;

class HostileTables : public testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(path("white"))) GTEST_SKIP() << "the shared tables are not here";
  }

  static std::filesystem::path path(const std::string& name) {
    return shared::folder("WISP_HOSTILE", "hostile") / "identification" / (name + ".csv");
  }

  static Recording read(const std::string& name, std::vector<std::string> inputs, std::vector<std::string> outputs,
                        double rate_hz = 1) {
    const auto recording =
        read_csv(path(name), {.usual_rate_hz = rate_hz, .inputs = std::move(inputs), .outputs = std::move(outputs)});
    EXPECT_TRUE(recording) << recording.error().message;
    return recording ? *recording : Recording{};
  }

  static Result<Fit> learned(const std::vector<Recording>& recordings, ArxRecipe recipe) {
    for (const Channel& channel : recordings.front().channels) {
      (channel.role == Role::kInput ? recipe.inputs : recipe.outputs).push_back(channel.name);
    }
    return learn(recordings, recipe);
  }

  static double first_of(const Report& report, const char* id) {
    return std::get<double>(std::get<ReportList>(report.find(id)->value).front());
  }

  static std::vector<Remark> remarks(const Recording& recording) {
    std::vector<std::string> inputs, outputs;
    for (const Channel& channel : recording.channels) {
      (channel.role == Role::kInput ? inputs : outputs).push_back(channel.name);
    }
    return remarks_on({&recording, 1}, inputs, outputs);
  }

  static auto remark(RemarkKind kind) { return Contains(Field(&Remark::kind, kind)); }
};

TEST_F(HostileTables, KernelByFocusCountsWhatItDetermines) {
  const Recording recording = read("kernel_by_focus", {"u"}, {"y"});
  const auto fit = learned({recording}, {.na = 4, .nb = 4, .nk = 1, .focus = ArxFocus::kAuto});
  ASSERT_TRUE(fit);
  EXPECT_TRUE(fit->report.verdict->usable) << fit->report.verdict->reason;
  EXPECT_LT(first_of(fit->report, "effective_coefficients"), 32);
  EXPECT_LT(std::get<double>(fit->report.find("fpe")->value), 1.93);
}

TEST_F(HostileTables, RedundantInputsAreNotUsableAndTheChannelIsNamed) {
  const auto fit = learned({read("col12", {"u1", "u2"}, {"y"})}, {.na = 2, .nb = 2});
  ASSERT_TRUE(fit);
  EXPECT_FALSE(fit->report.verdict->usable);
  EXPECT_THAT(fit->report.verdict->reason,
              AllOf(HasSubstr("'u2' is 1.8 'u1' + 32"), HasSubstr("leave one of them out")));
  const auto degrees =
      learned({read("celsius_and_fahrenheit", {"heater", "outside_C", "outside_F"}, {"room"})}, {.na = 2, .nb = 2});
  ASSERT_TRUE(degrees);
  EXPECT_FALSE(degrees->report.verdict->usable);
  EXPECT_THAT(degrees->report.verdict->reason, HasSubstr("'outside_F' is 1.8 'outside_C' + 32"));
}

TEST_F(HostileTables, AnIntegratorIsHeldAndSimulates) {
  const auto fit = learned({read("integrator_clean", {"u"}, {"y"})}, {.na = 1, .nb = 1});
  ASSERT_TRUE(fit);
  EXPECT_TRUE(fit->report.verdict->usable) << fit->report.verdict->reason;
  EXPECT_EQ(std::get<std::int64_t>(fit->report.find("integrators[0].poles")->value), 1);
  EXPECT_GT(first_of(fit->report, "fit_percent.inf"), 97);
}

TEST_F(HostileTables, RecordingsAtThreeLevelsAreEachAboutTheirOwn) {
  std::vector<Recording> recordings;
  for (const char* name : {"multi0", "multi1", "multi2"}) recordings.push_back(read(name, {"u"}, {"y"}));
  const auto fit = learned(recordings, {.na = 2, .nb = 2});
  ASSERT_TRUE(fit);
  EXPECT_TRUE(fit->report.verdict->usable) << fit->report.verdict->reason;
  EXPECT_GT(first_of(fit->report, "fit_percent.inf"), 89);
  const auto report = validate(fit->model, recordings[2], {.steps = {kFreeRun}});
  ASSERT_TRUE(report);
  EXPECT_GT(std::get<double>(report->sections.front().tables.front().rows.front()[1]), 88);
}

TEST_F(HostileTables, ALongDelayIsFoundAndNoneInNoise) {
  const auto fit = learned({read("delay45", {"u"}, {"y"})}, {.na = 2, .nb = 2, .nk = {}});
  ASSERT_TRUE(fit);
  EXPECT_EQ(std::get<ArxModel>(fit->model.dynamics).orders.nk(0, 0), 45);
  EXPECT_TRUE(fit->report.verdict->usable) << fit->report.verdict->reason;
  const auto short_of = learned({read("delay45", {"u"}, {"y"})}, {.na = 2, .nb = 2});
  ASSERT_TRUE(short_of);
  EXPECT_FALSE(short_of->report.verdict->usable);
  EXPECT_THAT(short_of->report.verdict->reason, HasSubstr("after 45 samples"));
  const auto none = learned({read("white", {"u"}, {"y"})}, {.na = 2, .nb = 2, .nk = {}});
  ASSERT_FALSE(none);
  EXPECT_THAT(none.error().message, HasSubstr("no delay is supported"));
}

TEST_F(HostileTables, OutliersAreTheCauseThatIsNamed) {
  const Recording recording = read("outliers", {"u"}, {"y"});
  EXPECT_THAT(remarks(recording), remark(RemarkKind::kOutliers));
  const auto fit = learned({recording}, {.na = 2, .nb = 2});
  ASSERT_TRUE(fit);
  EXPECT_FALSE(fit->report.verdict->usable);
  EXPECT_THAT(fit->report.verdict->reason,
              AllOf(HasSubstr(" outliers (rows 133, 346, "), HasSubstr("leave these cells empty")));
}

TEST_F(HostileTables, TimeInMillisecondsIsToldOf) {
  const Recording recording = read("time_ms", {"u"}, {"y"});
  EXPECT_DOUBLE_EQ(recording.rate_hz, 100);
  EXPECT_THAT(recording.rate_note.text, HasSubstr("taken as milliseconds"));
  EXPECT_THAT(remarks(recording), remark(RemarkKind::kClock));
  const auto fit = learned({recording}, {.na = 1, .nb = 1});
  ASSERT_TRUE(fit);
  EXPECT_THAT(fit->report.warnings, Contains(HasSubstr("taken as milliseconds")));
}

TEST_F(HostileTables, AJitteredClockIsResampledWithItsError) {
  const Recording recording = read("jittered_clock", {"Heater (%)"}, {"Temperature (degC)"});
  EXPECT_NEAR(recording.rate_hz, 1, 0.01);
  EXPECT_THAT(recording.rate_note.text,
              AllOf(HasSubstr("resampled by straight lines"), HasSubstr("% of a channel's deviation")));
  const auto fit = learned({recording}, {.na = 1, .nb = 1});
  ASSERT_TRUE(fit);
  EXPECT_THAT(fit->report.warnings, Contains(HasSubstr("the clock is uneven by")));
  EXPECT_FALSE(fit->report.verdict->usable);
  EXPECT_THAT(fit->report.verdict->reason, HasSubstr("input 'Heater (%)' moves only twice"));
}

TEST_F(HostileTables, DatesSayTheRate) {
  EXPECT_NEAR(read("dates", {"heater"}, {"temperature"}).rate_hz, 1.0 / 900, 1e-12);
}

}  // namespace
}  // namespace wisp::hostile_tables_test
