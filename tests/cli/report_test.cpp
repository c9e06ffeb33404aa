// `wisp report`: one page that needs nothing beside it.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "cli/program.hpp"

namespace wisp::report_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class ReportPage : public InFolder {
 protected:
  void SetUp() override {
    InFolder::SetUp();
    std::ofstream out(at("made.csv"));
    out << "u,y\n";
    double y = 0;
    for (int t = 0; t < 400; ++t) {
      const double u = t / 7 % 2 == 0 ? 1 : -1;
      y = 0.8 * y + 0.5 * u + 0.05 * std::sin(12.9 * t * t);
      out << u << ',' << y << '\n';
    }
    out.close();
    ASSERT_EQ(wisp("learn arx " + at("made.csv") + " --inputs u --outputs y --rate 10 --na 1 --nb 1 --nk 0 -o " +
                   at("m.wisp"))
                  .status,
              0);
  }
  std::size_t pictures(const std::string& page) const {
    std::size_t count = 0;
    for (std::size_t at = page.find("<img "); at != std::string::npos; at = page.find("<img ", at + 1)) ++count;
    return count;
  }
};

TEST_F(ReportPage, OfAModelAloneSaysWhatItIs) {
  const Said run = wisp("report " + at("m.wisp") + " -o " + at("page.html"));
  ASSERT_EQ(run.status, 0) << run.err;
  const std::string page = file_text(at("page.html"));
  EXPECT_THAT(page,
              AllOf(HasSubstr("<title>m.wisp</title>"), HasSubstr("class=\"verdict usable\""), HasSubstr("made.csv")));
  EXPECT_EQ(pictures(page), 0U);
}

TEST_F(ReportPage, HasTheVerdictAndThePlotsOfEachRecordingWithinIt) {
  const Said run = wisp("report " + at("m.wisp") + " " + at("made.csv") + " " + at("made.csv") +
                        " --rate 10 --json -o " + at("page.html"));
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(run.json()["recordings"], 2);
  const std::string page = file_text(at("page.html"));
  EXPECT_THAT(page, AllOf(HasSubstr("On made.csv"), HasSubstr("data:image/svg+xml;base64,"),
                          Not(HasSubstr("src=\"http")), Not(HasSubstr("wisp-report-"))));
  EXPECT_GE(pictures(page), 4U);
  EXPECT_EQ(pictures(page) % 2, 0U);
}

TEST_F(ReportPage, OfASwitchedModelHasTheVerdictWithoutPlots) {
  ASSERT_EQ(wisp("learn switched " + at("made.csv") + " --inputs u --outputs y --rate 10 --modes 2 -o " + at("s.wisp"))
                .status,
            0);
  const Said run = wisp("report " + at("s.wisp") + " " + at("made.csv") + " --rate 10 -o " + at("page.html"));
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_THAT(file_text(at("page.html")), HasSubstr("On made.csv"));
}

TEST_F(ReportPage, WhatCannotBeJudgedIsOneSentenceAndNoPage) {
  std::ofstream(at("other.csv")) << "a,b\n1,2\n3,4\n";
  const Said run = wisp("report " + at("m.wisp") + " " + at("other.csv") + " --rate 10 -o " + at("page.html"));
  EXPECT_EQ(run.status, 1);
  EXPECT_THAT(run.err, HasSubstr("other.csv"));
  EXPECT_FALSE(std::filesystem::exists(at("page.html")));
}

}  // namespace
}  // namespace wisp::report_test
