// A report becomes the same document for programs and a readable page for people.

#include <gmock/gmock.h>

#include <cmath>

#include "wisp/describe/json.hpp"
#include "wisp/describe/text.hpp"

namespace wisp::report_test {
namespace {

Report sample() {
  Report report;
  report.verdict = ReportVerdict{false, "too few rows"};
  report.warnings = {"the sound is clipped"};
  ReportSection& fit = report.add("Fit");
  fit.entries = {
      {.id = "stable.radius", .value = 0.9876, .label = "spectral radius", .meaning = "below 1: stable"},
      {.id = "delay", .value = 0.25, .label = "delay", .unit = "s", .interval = {{0.2, 0.3}}},
      {.id = "fpe", .value = NAN, .label = "FPE"},
      {.id = "A", .value = ReportList{ReportList{1.0, 2}, ReportList{}}},
      {.value = "a sentence", .label = "note"},
  };
  fit.tables = {{.id = "channels",
                 .label = "channels",
                 .columns = {{"name", "channel"}, {"fit_percent.1", "fit", "%"}, {"hidden", ""}},
                 .rows = {{"tip", 81.25, 1}, {"p0.x", NAN, 2}}}};
  return report;
}

TEST(ReportAsHtml, SaysWhatTheTextSaysInTables) {
  EXPECT_EQ(to_html(sample()),
            "<p class=\"verdict refused\">not usable: too few rows</p>\n"
            "<ul class=\"warnings\">\n<li>the sound is clipped</li>\n</ul>\n"
            "<h3>Fit</h3>\n<table class=\"figures\">\n"
            "<tr><th>spectral radius</th><td>0.9876</td><td>below 1: stable</td></tr>\n"
            "<tr><th>delay</th><td>0.25 s (95 %: 0.2 to 0.3)</td><td></td></tr>\n"
            "<tr><th>FPE</th><td>none</td><td></td></tr>\n"
            "<tr><th>note</th><td>a sentence</td><td></td></tr>\n</table>\n"
            "<table><caption>channels</caption>\n<tr><th>channel</th><th>fit %</th></tr>\n"
            "<tr><td>tip</td><td>81.25</td></tr>\n<tr><td>p0.x</td><td>none</td></tr>\n</table>\n");
}

TEST(ReportAsHtml, TextIsText) {
  Report report;
  report.warnings = {"<b> & \"c\""};
  EXPECT_EQ(to_html(report), "<ul class=\"warnings\">\n<li>&lt;b&gt; &amp; &quot;c&quot;</li>\n</ul>\n");
}

TEST(Report, JsonNestsDottedIdsAndKeepsMissingFiguresAsNull) {
  EXPECT_EQ(to_json(sample(), -1),
            R"({"stable":{"radius":0.9876},"delay":0.25,"delay_ci95":[0.2,0.3],"fpe":null,"A":[[1.0,2],[]],)"
            R"("channels":[{"name":"tip","fit_percent":{"1":81.25},"hidden":1},)"
            R"({"name":"p0.x","fit_percent":{"1":null},"hidden":2}],)"
            R"("warnings":["the sound is clipped"],"usable":{"verdict":false,"reason":"too few rows"}})");
}

TEST(Report, AnIdNamesElementsOfListsAndKeepsDotsAfterABackslash) {
  Report report;
  report.add("").entries = {
      {.id = "step[0][1].sd", .value = 2}, {.id = "step[0][0].sd", .value = 1}, {.id = "p.u\\.x\\[1]", .value = 3}};
  EXPECT_EQ(to_json(report, -1), R"({"step":[[{"sd":1},{"sd":2}]],"p":{"u.x[1]":3}})");
}

TEST(Report, TextBeginsWithTheVerdictAndAlignsFigures) {
  EXPECT_EQ(to_text(sample()),
            "not usable: too few rows\n"
            "warning: the sound is clipped\n"
            "Fit\n"
            "  spectral radius  0.9876   below 1: stable\n"
            "  delay            0.25 s (95 %: 0.2 to 0.3)\n"
            "  FPE              none\n"
            "  note             a sentence\n"
            "  channels\n"
            "  channel  fit %\n"
            "  tip      81.25\n"
            "  p0.x     none\n");
}

TEST(Report, AnEmptyReportIsEmptyTextAndAnEmptyObject) {
  EXPECT_EQ(to_text({}), "");
  EXPECT_EQ(to_json({}, -1), "{}");
}

TEST(Report, TextThatIsNotUtf8StillMakesValidJson) {
  Report report;
  report.add("").entries = {{.id = "name", .value = "caf\xE9", .label = "name"}};
  EXPECT_EQ(to_json(report, -1), "{\"name\":\"caf\xEF\xBF\xBD\"}");
}

TEST(Report, FindAndAppendSeeAllSections) {
  Report report = sample(), other;
  other.warnings = {"late"};
  other.add("More").entries = {{.id = "seconds", .value = 3.0}};
  report.append(other);
  ASSERT_TRUE(report.find("seconds"));
  EXPECT_EQ(std::get<double>(report.find("seconds")->value), 3.0);
  EXPECT_EQ(report.find("nothing"), nullptr);
  EXPECT_EQ(report.warnings.size(), 2u);
}

}  // namespace
}  // namespace wisp::report_test
