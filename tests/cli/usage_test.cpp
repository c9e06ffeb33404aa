// Exit statuses, help and the manual.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

#include "cli/program.hpp"
#include "paths.hpp"

namespace wisp::usage_test {
namespace {

using testing::HasSubstr;

class Usage : public InFolder {
 protected:
  std::string at_file() const { return at("completed"); }
};

TEST_F(Usage, HelpIsStatus0AndWrongUsageIsStatus2) {
  EXPECT_EQ(wisp("--help").status, 0);
  EXPECT_EQ(wisp("learn arx --help").status, 0);
  EXPECT_EQ(wisp("--version").status, 0);
  EXPECT_EQ(wisp("").status, 2);
  EXPECT_EQ(wisp("dance").status, 2);
  EXPECT_EQ(wisp("info").status, 2);
  EXPECT_EQ(wisp("info a.wisp --nonsense").status, 2);
  EXPECT_EQ(wisp("run '' -o a.csv --frames 10").status, 2);
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
  EXPECT_THAT(wisp("--json info a.csv").err, HasSubstr("found --json, expected a command before flags"));
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
  for (const char* command :
       {"capture outline", "capture flame", "learn outline", "learn flame", "learn arx", "learn switched",
        "capture brightness", "capture wind", "learn flicker", "learn chain", "learn leaf", "simulate candle",
        "simulate leaf", "validate", "run", "export", "info", "demo"}) {
    const Said said = wisp(std::string(command) + " --help");
    EXPECT_EQ(said.status, 0) << command;
    EXPECT_THAT(said.out, HasSubstr("Examples:")) << command;
    EXPECT_THAT(said.out, HasSubstr("--json")) << command;
  }
}

TEST_F(Usage, HelpListsAllCommandsWithWhatTheyDoInLinesOfAHundredLetters) {
  const Said said = wisp("--help");
  for (const char* command : {"capture flame ", "learn arx ", "simulate leaf ", "manual "}) {
    EXPECT_THAT(said.out, testing::ContainsRegex("\n  " + std::string(command) + " *[A-Z]")) << command;
  }
  EXPECT_EQ(wisp("help").out, said.out);
  EXPECT_EQ(wisp("help learn arx").out, wisp("learn arx --help").out);
  EXPECT_THAT(wisp("help learn").out, testing::AllOf(HasSubstr("learn leaf"), testing::Not(HasSubstr("capture"))));
  EXPECT_EQ(wisp("learn --help").out, wisp("help learn").out);
  EXPECT_EQ(wisp("dance --help").out, said.out);
  EXPECT_EQ(wisp("-V").out, wisp("--version").out);
  EXPECT_EQ(wisp("help lern").status, 2);
  for (const char* about : {"", "capture flame", "learn arx", "learn leaf", "validate", "run", "export"}) {
    std::istringstream lines(wisp("help " + std::string(about)).out);
    for (std::string line; std::getline(lines, line);) {
      if (line.starts_with("  wisp ")) continue;  // an example is for copying
      EXPECT_LE(line.size(), 110u) << line;
    }
  }
}

TEST_F(Usage, AloneItSaysWhatToTypeFirst) {
  const Said said = wisp("");
  EXPECT_EQ(said.status, 2);
  EXPECT_THAT(said.err, testing::AllOf(HasSubstr("wisp demo"), HasSubstr("wisp play"), HasSubstr("wisp help")));
}

TEST_F(Usage, TheManualIsAlsoAManPageAndCompletion) {
  EXPECT_THAT(wisp("manual man").out, testing::AllOf(HasSubstr(".TH WISP 1"), HasSubstr(".SS wisp learn arx ")));
  EXPECT_THAT(wisp("manual fish").out, HasSubstr("-a arx"));
  EXPECT_THAT(wisp("manual zsh").out, HasSubstr("bashcompinit"));
  EXPECT_EQ(wisp("manual runes").status, 2);
  const std::string complete = "bash -c 'source <(" WISP_PROGRAM " manual bash); COMP_WORDS=(wisp ";
  const auto completed = [&](const std::string& words, int at) {
    const std::string line =
        complete + words + "); COMP_CWORD=" + std::to_string(at) + "; _wisp; echo \"${COMPREPLY[*]}\"' >" + at_file();
    EXPECT_EQ(std::system(line.c_str()), 0) << line;
    return file_text(at_file());
  };
  EXPECT_EQ(completed("le", 1), "learn\n");
  EXPECT_EQ(completed("learn ar", 2), "arx\n");
  EXPECT_EQ(completed("learn arx --coup", 3), "--coupling\n");
}

TEST_F(Usage, WhatIsWrongWithAFlagIsStatus2BeforeAnyWork) {
  EXPECT_EQ(wisp("simulate candle -o clip.avi").status, 2);
  EXPECT_EQ(wisp("capture flame a.mp4 b.mp4 -o one.csv").status, 2);
  EXPECT_EQ(wisp("capture flame frames --rate 1e9 -o a.csv").status, 2);
  EXPECT_EQ(wisp("learn arx a.csv --outputs y --na 0 --nb 0 -o m.wisp").status, 2);
  EXPECT_EQ(wisp("learn arx a.csv --outputs y --rate 1e9 -o m.wisp").status, 2);
  EXPECT_THAT(wisp("capture flame \"$(printf 'a\\nb.mp4')\" -o a.csv").err,
              HasSubstr("the name has a line break in it"));
}

TEST_F(Usage, AFlagThatNeedsAnotherIsRefusedWithoutIt) {
  for (const std::string flag : {"--inputs a", "--own-gain", "--columns a,b", "--rate 3", "--dt 3"}) {
    const Said said = wisp("run a.wisp --frames 3 -o a.csv " + flag);
    EXPECT_EQ(said.status, 2) << flag;
    EXPECT_THAT(said.err, HasSubstr(flag.substr(0, flag.find(' ')) + " requires --input")) << flag;
  }
}

TEST_F(Usage, ValuesThatCannotBeMeantAreRefused) {
  for (const auto& [line, found] : {std::pair{"run a.wisp --frames 3 -o a.csv --wind 1e300", "found \"1e300\""},
                                    {"capture flame a.mp4 -o a.csv --frames 1:99999999999999999999", "--frames: found"},
                                    {"capture flame a.mp4 -o a.csv --region ''", "is empty"},
                                    {"predict a.wisp a.csv -o -", "nothing is written to standard output"}}) {
    const Said said = wisp(line);
    EXPECT_EQ(said.status, 2) << line;
    EXPECT_THAT(said.err, HasSubstr(found)) << line;
  }
}

TEST_F(Usage, TheManualInDocsIsTheProgramsOwn) {
  EXPECT_EQ(wisp("manual").out, file_text(WISP_SOURCE_DIR "/docs/reference/cli.md"))
      << "make it again: wisp manual > docs/reference/cli.md";
}

}  // namespace
}  // namespace wisp::usage_test
