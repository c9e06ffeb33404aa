// Exit statuses, help and the manual.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cli/program.hpp"
#include "paths.hpp"

namespace wisp::usage_test {
namespace {

using testing::HasSubstr;

class Usage : public InFolder {};

TEST_F(Usage, HelpIsStatus0AndWrongUsageIsStatus2) {
  EXPECT_EQ(wisp("--help").status, 0);
  EXPECT_EQ(wisp("learn arx --help").status, 0);
  EXPECT_EQ(wisp("--version").status, 0);
  EXPECT_EQ(wisp("").status, 2);
  EXPECT_EQ(wisp("dance").status, 2);
  EXPECT_EQ(wisp("info").status, 2);
  EXPECT_EQ(wisp("info a.wisp --nonsense").status, 2);
  EXPECT_EQ(wisp("run a.wisp -o a.csv --frames many").status, 2);
  EXPECT_EQ(wisp("run a.wisp -o a.csv --frames 10 --noise loud").status, 2);
  EXPECT_EQ(wisp("learn arx a.csv -o m.wisp --outputs y --range 30:1").status, 2);
}

TEST_F(Usage, AMistypedWordIsAnsweredWithTheNearest) {
  EXPECT_THAT(wisp("lern flame a.csv").err, HasSubstr("no command lern; did you mean learn? There are: "));
  EXPECT_THAT(wisp("learn flam a.csv").err, HasSubstr("wisp learn: there is no flam; did you mean learn flame?"));
  EXPECT_THAT(wisp("learn").err, HasSubstr("wisp learn: expected one of "));
  EXPECT_THAT(wisp("learn --json").err, HasSubstr("wisp learn: expected one of "));
  EXPECT_THAT(wisp("capture flame a.mp4 -o a.csv --pionts=3").err,
              HasSubstr("wisp capture flame: there is no flag --pionts; did you mean --points?"));
  EXPECT_THAT(wisp("capture flame a.mp4 -o a.csv --purple").err, HasSubstr("there is no flag --purple. Its flags: "));
  // What is wrong here is no word.
  EXPECT_THAT(wisp("capture flame a.mp4").err, HasSubstr("--output is required"));
}

TEST_F(Usage, AMissingOutputNameIsWrongUsage) {
  EXPECT_EQ(wisp("run a.wisp --frames 10").status, 2);
  EXPECT_EQ(wisp("learn arx a.csv --outputs y").status, 2);
}

TEST_F(Usage, AMissingFileIsStatus1AndOneLine) {
  const Said said = wisp("info nowhere.wisp");
  EXPECT_EQ(said.status, 1);
  EXPECT_THAT(said.err, HasSubstr("nowhere.wisp"));
  EXPECT_EQ(std::count(said.err.begin(), said.err.end(), '\n'), 1);
  EXPECT_EQ(said.out, "");
}

TEST_F(Usage, WithJsonAFailureIsADocumentToo) {
  const Said said = wisp("info nowhere.wisp --json");
  EXPECT_EQ(said.status, 1);
  EXPECT_THAT(said.json()["error"].get<std::string>(), HasSubstr("nowhere.wisp"));
}

TEST_F(Usage, EveryCommandHasHelpWithAnExample) {
  for (const char* command : {"capture outline", "capture flame", "learn outline", "learn flame", "learn arx",
                              "learn switched", "capture brightness", "learn flicker", "learn chain", "learn leaf",
                              "simulate candle", "simulate leaf", "validate", "run", "export", "info", "demo"}) {
    const Said said = wisp(std::string(command) + " --help");
    EXPECT_EQ(said.status, 0) << command;
    EXPECT_THAT(said.out, HasSubstr("Examples:")) << command;
    EXPECT_THAT(said.out, HasSubstr("--json")) << command;
  }
}

TEST_F(Usage, TheManualInDocsIsTheProgramsOwn) {
  EXPECT_EQ(wisp("manual").out, file_text(WISP_SOURCE_DIR "/docs/reference/cli.md"))
      << "make it again: wisp manual > docs/reference/cli.md";
}

}  // namespace
}  // namespace wisp::usage_test
