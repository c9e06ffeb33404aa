// The commands of docs/guide/hair-dryer.md, in their order, on the data that it is about.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>

#include "cli/program.hpp"
#include "paths.hpp"

namespace wisp::guide_test {
namespace {

using testing::HasSubstr;

// Lines of an indented block that begin with "wisp ", lines that end in a backslash joined to the next.
std::vector<std::string> commands_of(const std::string& page) {
  std::vector<std::string> commands;
  std::istringstream text(page);
  bool open = false;
  for (std::string line; std::getline(text, line);) {
    const auto first = line.find_first_not_of(' ');
    if (first == std::string::npos || first < 4) continue;
    std::string words = line.substr(first);
    if (!open && !words.starts_with("wisp ")) continue;
    const bool goes_on = words.back() == '\\';
    if (goes_on) words.pop_back();
    open ? commands.back() += words : commands.emplace_back(words.substr(5));
    open = goes_on;
  }
  return commands;
}

class Guide : public InFolder {};

TEST_F(Guide, AnHourWithTheHairDryerRuns) {
  // The data set is not ours to pass on: a clone has it only where somebody has put it.
  if (data_folder().empty()) GTEST_SKIP() << "../shared/data is not here";
  const auto data = std::filesystem::path(data_folder()) / "sysid/hairdryer.csv";
  std::filesystem::copy_file(data, at("hairdryer.csv"));
  const auto commands = commands_of(file_text(WISP_SOURCE_DIR "/docs/guide/hair-dryer.md"));
  ASSERT_EQ(commands.size(), 8u);
  for (const std::string& command : commands) {
    const std::string line = "cd " + folder_.string() + " && " WISP_PROGRAM " " + command + " >said 2>&1 </dev/null";
    EXPECT_EQ(std::system(line.c_str()), 0) << command << "\n" << file_text(at("said"));
  }
  for (const char* made : {"response/step.png", "figures/prediction.png", "five.csv", "compared.png"}) {
    EXPECT_TRUE(std::filesystem::exists(at(made))) << made;
  }
}

// The commands of docs/guide/identify.md up to what needs many machines, on the table that comes along.
TEST_F(Guide, IdentifyingATableRuns) {
  for (const char* name : {"load.csv", "monday.csv", "tuesday.csv"}) {
    std::filesystem::copy_file(WISP_SOURCE_DIR "/examples/load.csv", at(name));
  }
  const std::string page = file_text(WISP_SOURCE_DIR "/docs/guide/identify.md");
  const auto commands = commands_of(page.substr(0, page.find("## Data larger than memory")));
  ASSERT_EQ(commands.size(), 14u);
  for (const std::string& command : commands) {
    const std::string line = "cd " + folder_.string() + " && " WISP_PROGRAM " " + command + " >said 2>&1 </dev/null";
    EXPECT_EQ(std::system(line.c_str()), 0) << command << "\n" << file_text(at("said"));
    if (command.ends_with("-o load.wisp")) {
      std::istringstream shown(page.substr(page.find("```text") + 8, page.find("```\n") - page.find("```text") - 8));
      for (std::string one; std::getline(shown, one);) EXPECT_THAT(file_text(at("said")), HasSubstr(one));
    }
    if (command.starts_with("learn")) {
      EXPECT_TRUE(file_text(at("said")).starts_with("usable")) << command << "\n" << file_text(at("said"));
    }
  }
  for (const char* made :
       {"channels.png", "compared.png", "load.html", "load.m", "load.py", "load.c", "load.h", "load.json"}) {
    EXPECT_TRUE(std::filesystem::exists(at(made))) << made;
  }
}

std::string source_text(const std::string& path) { return file_text(WISP_SOURCE_DIR "/" + path); }

// The sentences of `not usable`, and where each is made.
TEST_F(Guide, EverySentenceOfNotUsableHasItsRow) {
  const std::string page = source_text("docs/guide/identify.md");
  const std::string rows = page.substr(page.find("## What to do at each *not usable*"));
  const std::map<std::string, std::vector<std::string>> sentences{
      {"arx/advice.cpp",
       {"it stands for a missing sample", " outliers", " never changes", "it tells nothing new",
        "is missing, and every row", "has only ", "moves only ", "a controller closes the loop", " acts on ",
        " integrates", " drifts by "}},
      {"judge/arx_verdict.cpp",
       {"rows are too few for ", "to make the estimate stable a coefficient was moved by ", "in the same sample",
        "the recording shows no cause", "played in single precision", "is predicted no better than by its"}},
      {"fit/arx_report.cpp", {"the data cannot tell all coefficients", "the model is unstable"}},
      {"choose/delay_estimate.cpp", {"no delay is supported"}}};
  const std::string kinds = source_text("include/wisp/learn/advice.hpp");
  const auto causes = kinds.substr(0, kinds.find("kClock"));
  EXPECT_EQ(std::count(causes.begin() + std::ptrdiff_t(causes.find("enum class")), causes.end(), '<'),
            std::ssize(sentences.at("arx/advice.cpp")));
  for (const auto& [file, said] : sentences) {
    const std::string source = source_text("src/learn/" + file);
    for (const std::string& sentence : said) {
      EXPECT_THAT(source, HasSubstr(sentence)) << file;
      EXPECT_THAT(rows, HasSubstr(sentence)) << file;
    }
  }
}

// The commands of docs/guide/two-phones.md. The rig's candle is flat: seen alike from 0° and from 90° it leans half way
// between the two cameras' right sides, towards 45°.
TEST_F(Guide, TwoPhonesFilmAFlameInTheRound) {
  ASSERT_EQ(wisp("simulate candle --seconds 14 --seed 3 -o " + at("front.mp4")).status, 0);
  ASSERT_EQ(wisp("simulate candle --seconds 14 --seed 3 --chance 4 -o " + at("side.mp4")).status, 0);
  const auto commands = commands_of(file_text(WISP_SOURCE_DIR "/docs/guide/two-phones.md"));
  ASSERT_EQ(commands.size(), 4u);
  for (const std::string& command : commands) {
    const std::string line = "cd " + folder_.string() + " && " WISP_PROGRAM " " + command + " >said 2>&1 </dev/null";
    EXPECT_EQ(std::system(line.c_str()), 0) << command << "\n" << file_text(at("said"));
    if (command.starts_with("capture")) {
      EXPECT_TRUE(file_text(at("said")).starts_with("usable")) << file_text(at("said"));
    }
    if (command.starts_with("learn")) {
      EXPECT_THAT(file_text(at("said")), HasSubstr("lean differs with the wind's direction by"));
    }
  }
  const Said joined =
      wisp("capture flame " + at("front.mp4") + " " + at("side.mp4") + " --angles 0,90 --json -o " + at("again.csv"));
  ASSERT_EQ(joined.status, 0) << joined.err;
  EXPECT_LT(joined.json()["heights_differ"], 3.0);
  EXPECT_NEAR(joined.json()["views"][1]["begins"], 0, 0.02);
  for (const auto& blow : joined.json()["blows"]) EXPECT_NEAR(blow["azimuth"], 45, 8) << blow;
  EXPECT_EQ(wisp("info " + at("candle.wisp") + " --json").json()["view"]["in_the_round"], "symmetry");
  const Said twice =
      wisp("capture flame " + at("front.mp4") + " " + at("front.mp4") + " --angles 0,90 -o " + at("no.csv"));
  EXPECT_NE(twice.status, 0);
  EXPECT_THAT(twice.err, testing::HasSubstr("is the same film"));
  const Said alone = wisp("capture flame " + at("front.mp4") + " --angles 0,90 -o " + at("no.csv"));
  EXPECT_NE(alone.status, 0);
  EXPECT_THAT(alone.err, testing::HasSubstr("expected at least two films"));
}

// The README's own table: the kernel's filter is known, a pole at exp(−5/60).
TEST_F(Guide, AComputersLoadHasItsKernelsTimeConstant) {
  const std::string table = WISP_SOURCE_DIR "/examples/load.csv";
  const Said said = wisp("learn arx " + table + " --inputs busy --outputs load --na 1 --nb 1 --nk 0 -o " +
                         at("load.wisp") + " --json");
  ASSERT_EQ(said.status, 0) << said.err;
  const double error = said.json()["std_error"]["A"][0][0][0];
  EXPECT_NEAR(said.json()["poles"][0][0], std::exp(-5.0 / 60), 3 * error);
}

}  // namespace
}  // namespace wisp::guide_test
