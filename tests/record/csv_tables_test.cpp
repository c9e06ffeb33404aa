// Tables from elsewhere: as spreadsheets, loggers and other programs write them, and what each refusal says.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "wisp/record/csv.hpp"

namespace wisp::csv_tables_test {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

const CsvOptions kTwo{.rate_hz = 1, .inputs = {"u"}, .outputs = {"y"}};

Result<Recording> parse(const std::string& text, const CsvOptions& options = kTwo) {
  std::istringstream stream(text);
  return read_csv(stream, "t.csv", options);
}

std::string complaint(const std::string& text, const CsvOptions& options = kTwo) {
  const auto outcome = parse(text, options);
  return outcome ? "no complaint" : outcome.error().message;
}

// u is 1, 2.5, -3e-4 and y is 4, 5, 6.
void expect_samples(const std::string& text, const CsvOptions& options = kTwo) {
  const auto recording = parse(text, options);
  ASSERT_TRUE(recording) << text << recording.error().message;
  ASSERT_EQ(recording->channels.size(), 2u) << text;
  EXPECT_THAT(recording->channels[0].samples, ElementsAre(1, 2.5, -3e-4)) << text;
  EXPECT_THAT(recording->channels[1].samples, ElementsAre(4, 5, 6)) << text;
}

TEST(CsvTable, SeparatorsAndDecimalMarksAreFound) {
  expect_samples("u,y\n1,4\n2.5,5\n-3e-4,6\n");
  expect_samples("u;y\n1;4\n2,5;5\n-3e-4;6\n");
  expect_samples("u;y\n1,0;4,0\n2,5;5,0\n-0,0003;6,0\n");
  expect_samples("u\ty\n1\t4\n2,5\t5\n-3E-4\t6\n");
  expect_samples("u y\n1 4\n2.5 5\n-3e-4 6\n");
  expect_samples("  u     y\n  1.0   4\n  2.5   5\n-3.0e-4\t6   \n");
  expect_samples(" u , y \r\n 1 , 4 \r\n 2.5 , 5 \r\n -3e-4 , 6 \r\n");
  expect_samples("u,y\n\"1\",\"4\"\n\"2,5\",\"5\"\n\"-0,0003\",6\n");
  expect_samples("u,y\n1.0D+00,4\n2.5d0,5\n-3.0D-04,6\n");
}

TEST(CsvTable, ExcelsSeparatorLineIsObeyed) {
  expect_samples("sep=;\nu;y\n1;4\n2,5;5\n-3e-4;6\n");
  expect_samples("sep=\t\nu\ty\n1\t4\n2.5\t5\n-3e-4\t6\n");
  expect_samples("\xef\xbb\xbf\"sep=|\"\r\nu|y\r\n1|4\r\n2.5|5\r\n-3e-4|6\r\n");
}

TEST(CsvTable, ARowOfUnitsIsNoRowOfNumbers) {
  const auto recording = parse("time;u;y\ns;[W];-\n0;1,5;4\n1;2,5;5\n");
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_EQ(recording->channels[0].unit, "W");
  EXPECT_EQ(recording->channels[1].unit, "1");
  EXPECT_THAT(recording->channels[0].samples, ElementsAre(1.5, 2.5));
  EXPECT_THAT(complaint("u,y\nvolts,amps\nmore,text\n1,2\n"), HasSubstr("row 2: found \"volts\""));
  EXPECT_THAT(complaint("u,y\nvolts,amps\nmore,3\n1,2\n"), HasSubstr("row 3: found \"more\""));
}

TEST(CsvTable, AFirstRowOfADateAndMissingSamplesStatesNoUnits) {
  const auto recording = parse("Datum;u;y\n31.01.2024 13:05:00;NA;NA\n31.01.2024 13:05:01;1,5;4\n");
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_THAT(recording->channels[0].samples, ElementsAre(testing::IsNan(), 1.5));
  EXPECT_EQ(recording->channels[0].unit, "");
}

TEST(CsvTable, WithoutAHeaderTheColumnsAreNamed) {
  const CsvOptions named{.rate_hz = 1, .inputs = {"u"}, .outputs = {"y"}, .columns = {"u", "y"}};
  expect_samples("1 4\n2.5 5\n-3e-4 6\n", named);
  expect_samples("   1.0000e+00   4.0000e+00\n   2.5000e+00   5.0000e+00\n  -3.0000e-04   6.0000e+00\n", named);
  expect_samples("1,4\n2.5,5\n-3e-4,6\n", named);
  expect_samples("a,a\n1,4\n2.5,5\n-3e-4,6\n", named);
  expect_samples("% u y\n1 4\n2.5 5\n-3e-4 6\n", named);
  EXPECT_THAT(complaint("1 2 3\n4 5 6\n"), AllOf(HasSubstr("t.csv, row 1"), HasSubstr("give names to its 3 columns"),
                                                 HasSubstr("--columns u1,u2,y1")));
  EXPECT_THAT(complaint("1 2 3\n4 5 6\n", named), HasSubstr("has 3 columns, --columns names 2"));
}

TEST(CsvTable, AFirstRowWithADateIsNoHeader) {
  const auto recording = parse("2024-01-31 13:05:00,1,4\n2024-01-31 13:05:05,2,5\n2024-01-31 13:05:10,3,6\n",
                               {.inputs = {"u"}, .outputs = {"y"}, .columns = {"date", "u", "y"}});
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_THAT(recording->channels[0].samples, ElementsAre(1, 2, 3));
  EXPECT_DOUBLE_EQ(recording->rate_hz, 0.2);
}

TEST(CsvTable, AFirstRowWithTextIsNoHeader) {
  const CsvOptions named{.rate_hz = 1, .inputs = {"u"}, .outputs = {"y"}, .columns = {"u", "lamp", "y"}};
  expect_samples("1,ON,4\n2.5,OFF,5\n-3e-4,ON,6\n", named);
  EXPECT_THAT(complaint("1,ON,4\n2,OFF,5\n3,ON,6\n"), HasSubstr("give names to its 3 columns"));
  const auto dated = parse("31.01.2024 13:05:00;ON;1,5\n31.01.2024 13:05:01;OFF;2\n",
                           {.outputs = {"y"}, .columns = {"date", "lamp", "y"}});
  ASSERT_TRUE(dated) << dated.error().message;
  EXPECT_THAT(dated->channels[0].samples, ElementsAre(1.5, 2));
}

TEST(CsvTable, NumbersAsNamesBesideADateAreAHeader) {
  const auto recording = parse("date,0.5,1.5\n2024-01-31,1,2\n2024-02-01,3,4\n", {.outputs = {"1.5"}});
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_THAT(recording->channels[0].samples, ElementsAre(2, 4));
}

TEST(CsvTable, NamesOfRowsAsRWritesThemHaveNoNameThemselves) {
  expect_samples("\"u\" \"y\"\n\"1\" 1 4\n\"2\" 2.5 5\n\"3\" -3e-4 6\n");
  expect_samples("\"u\",\"y\"\n\"first one\",1,4\n\"b\",2.5,5\n\"c\",-3e-4,6\n");
  const auto one = parse("\"y\"\n\"1\" 4\n\"2\" NA\n", {.rate_hz = 1, .outputs = {"y"}});
  ASSERT_TRUE(one) << one.error().message;
  EXPECT_THAT(one->channels[0].samples, ElementsAre(4, testing::IsNan()));
  EXPECT_THAT(complaint("note,u\n\"a\",1,2\n", {.rate_hz = 1, .inputs = {"u"}}),
              HasSubstr("has 3 columns, the header has 2"));
}

TEST(CsvTable, NamesThatAreNotUtf8AreLatin1) {
  const auto recording = parse("Temperatur (\xb0\x43);y [\xb5m]\n1,5;4\n2,5;5\n",
                               {.rate_hz = 1, .inputs = {"Temperatur (°C)"}, .outputs = {"y"}});
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_THAT(recording->channels[0].samples, ElementsAre(1.5, 2.5));
  EXPECT_EQ(recording->channels[1].unit, "µm");
}

TEST(CsvTable, WithoutAHeaderTheFirstRowMayEndInAMissingSample) {
  const auto recording =
      parse("1,\n2,5\n3,6\n", {.rate_hz = 1, .inputs = {"u"}, .outputs = {"y"}, .columns = {"u", "y"}});
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_THAT(recording->channels[0].samples, ElementsAre(1, 2, 3));
  EXPECT_THAT(recording->channels[1].samples, ElementsAre(testing::IsNan(), 5, 6));
}

TEST(CsvTable, WhatIsMissingIsSaidInManyWays) {
  const auto recording = parse("u,y\n,1\nNaN,2\nNA,3\nn/a,4\n#N/A,5\nnull,6\n#NV,7\n#N/D,8\n9,9\n");
  ASSERT_TRUE(recording) << recording.error().message;
  for (std::size_t row = 0; row < 8; ++row) EXPECT_TRUE(std::isnan(recording->channels[0].samples[row])) << row;
  EXPECT_EQ(recording->channels[0].samples[8], 9);
  EXPECT_THAT(complaint("u,y\n1,2\n#DIV/0!,3\n"), HasSubstr("row 3: found \"#DIV/0!\", column 1, expected a number"));
}

TEST(CsvTable, RowsWithoutATimeOrAnythingElseAreNone) {
  const CsvOptions timed{.inputs = {"u"}, .outputs = {"y"}};
  expect_samples("t,u,y\n0,1,4\n0.5,2.5,5\n1,-3e-4,6\n,,\n\"\",,\n", timed);
  const auto gap = parse("t;u;y\n0;1,5;4\n0,5;2;5\n;;\n1,5;3;7\n2;3;8\n", timed);
  ASSERT_TRUE(gap) << gap.error().message;
  EXPECT_THAT(gap->channels[1].samples, ElementsAre(4, 5, testing::IsNan(), 7, 8));
}

TEST(CsvTable, ARowOfTabsAloneIsARowOfMissingSamples) {
  const auto recording = parse("u\ty\n1\t4\n\t\n3\t6\n\n");
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_THAT(recording->channels[0].samples, ElementsAre(1, testing::IsNan(), 3));
  EXPECT_THAT(recording->channels[1].samples, ElementsAre(4, testing::IsNan(), 6));
}

TEST(CsvTable, QuotedCellsHoldSeparatorsAndQuotes) {
  const CsvOptions options{.rate_hz = 1, .inputs = {"Power, W"}, .outputs = {"the \"y\""}};
  const auto recording =
      parse("note,\"Power, W\",\"the \"\"y\"\"\"\n\"a, b\",1,2\n\"say \"\"hi\"\", x\",3,4\n", options);
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_EQ(recording->channels[0].name, "Power, W");
  EXPECT_EQ(recording->channels[1].name, "the \"y\"");
  EXPECT_THAT(recording->channels[1].samples, ElementsAre(2, 4));
  EXPECT_THAT(complaint("\"Power, W\",y\n1,2\n"), HasSubstr("its columns are \"Power, W\", y"));
}

TEST(CsvTable, AQuoteAtTheEndAloneIsAnInch) {
  expect_samples("5\",y\n1,4\n2.5,5\n-3e-4,6\n", {.rate_hz = 1, .inputs = {"5\""}, .outputs = {"y"}});
}

TEST(CsvTable, NamesThatHoldSeparatorsAreWrittenBack) {
  const CsvOptions options{.rate_hz = 1, .inputs = {"Power, W"}, .outputs = {"the \"y\""}};
  const auto recording = parse("\"Power, W\";\"the \"\"y\"\"\"\nkW, or so;m\n1,5;2\n", options);
  ASSERT_TRUE(recording) << recording.error().message;
  const auto again = parse(csv_text(*recording), {});
  ASSERT_TRUE(again) << again.error().message;
  EXPECT_EQ(again->channels[0].name, "Power, W");
  EXPECT_EQ(again->channels[0].unit, "kW, or so");
  EXPECT_EQ(again->channels[1].name, "the \"y\"");
  EXPECT_THAT(again->channels[0].samples, ElementsAre(1.5));
}

TEST(CsvTable, SeparatorsAtTheEndOfRowsAreNobodysCells) {
  expect_samples("u,y,\n1,4,\n2.5,5,\n-3e-4,6,\n");
  expect_samples("u,y\n1,4,\n2.5,5,,,\n-3e-4,6\n");
  EXPECT_THAT(complaint("u,y\n1,2\n1,2,3\n"),
              AllOf(HasSubstr("row 3"), HasSubstr("3 columns, the header has 2"), HasSubstr("stands in quotes")));
}

TEST(CsvTable, ColumnsWithoutANameAndUnwantedTwinsAreNoMatter) {
  expect_samples(",u,y,z,z\n0,1,4,0,0\n1,2.5,5,0,0\n2,-3e-4,6,0,0\n");
  EXPECT_THAT(complaint("y:,u:u\n1,2\n", {.rate_hz = 1}), HasSubstr("column 1 has no name"));
  EXPECT_THAT(complaint("u,y,y\n1,2,3\n"), HasSubstr("two columns are named \"y\"; rename one"));
  EXPECT_THAT(complaint("episode,u,y,episode\n1,1,2,1\n"), HasSubstr("two columns are named \"episode\"; rename one"));
}

TEST(CsvTable, NumbersThatMeanTwoThingsAreRefused) {
  EXPECT_THAT(complaint("u;y\n1.5;2\n1,234;3\n"),
              AllOf(HasSubstr("row 3"), HasSubstr("\"1,234\""), HasSubstr("decimal point")));
  EXPECT_THAT(complaint("u;y\n1.234,5;2\n"), HasSubstr("without separators of thousands"));
  EXPECT_THAT(complaint("u,y\n\"1,234.5\",2\n"), HasSubstr("without separators of thousands"));
}

TEST(CsvTable, TinyNumbersAreNotZero) {
  const auto recording = parse("u,y\n1e-200,2e-300\n3e-200,4e-300\n");
  ASSERT_TRUE(recording);
  EXPECT_EQ(recording->channels[0].samples[1], 3e-200);
  EXPECT_EQ(recording->channels[1].samples[0], 2e-300);
}

TEST(CsvTable, Utf16IsNamed) {
  EXPECT_THAT(complaint(std::string("\xff\xfeu\0,\0y\0\n\0", 10)), HasSubstr("is UTF-16; save it as UTF-8"));
}

TEST(CsvTable, RowsAreCountedAsAnEditorDoes) {
  EXPECT_THAT(complaint("# note\n\nsep\n"), HasSubstr("row 3"));
  EXPECT_THAT(complaint("# note\n\nu,y\nW,V\n\n1,2\nx,3\n"), HasSubstr("row 7"));
}

TEST(CsvTable, CommasThatMaySeparateThousandsAreRefused) {
  EXPECT_THAT(
      complaint("k;u;y\n1;1;1,012\n2;1;987\n3;0;1,003\n"),
      AllOf(HasSubstr("row 2"), HasSubstr("column 3"), HasSubstr("in row 3"), HasSubstr("thousands or decimals?")));
  EXPECT_THAT(complaint("k,u,y\n1,1,\"1,012\"\n2,1,987\n"), HasSubstr("thousands or decimals?"));
  EXPECT_EQ(complaint("k;u;y\n1;1;1,012\n2;1;987\n3;0;1,5\n"),
            "no complaint");                                                  // decimals: nobody writes 1,5 thousands
  EXPECT_EQ(complaint("k;u;y\n100;1;1,012\n101;1;0,987\n"), "no complaint");  // another column's whole numbers
}

TEST(CsvTable, PointsBetweenSemicolonsThatMaySeparateThousandsAreRefused) {
  EXPECT_THAT(complaint("k;u;y\n1;1;1.012\n2;1;987\n3;0;1.003\n"),
              AllOf(HasSubstr("row 2"), HasSubstr("column 3 has numbers such as 1.012 and, in row 3")));
  EXPECT_EQ(complaint("k;u;y\n1;1;1.012\n2;1;987\n3;0;1.5\n"), "no complaint");
  EXPECT_EQ(complaint("k,u,y\n1,1,1.012\n2,1,987\n3,0,1.003\n"), "no complaint");
}

TEST(CsvTable, AllColumnsWriteNumbersInOneWayAlsoThoseThatAreNotUsed) {
  for (const char* text : {"t,u,y\n0.0,1,\"1,012\"\n0.1,1,\"1,064\"\n", "t;u;y\n0.0;1;1,000\n0.1;1;1,064\n"})
    EXPECT_THAT(complaint(text), AllOf(HasSubstr("row 2"), HasSubstr("numbers above have a decimal point")));
  EXPECT_EQ(complaint("when;u;y\n1.12.2026;1;0,5\n2.12.2026;1;0,7\n"), "no complaint");  // a date is no number
}

TEST(CsvTable, ALongCellIsCutBetweenCharacters) {
  const std::string cell(39, 'x');
  EXPECT_THAT(complaint("u,y\n1,2\n" + cell + "é and more,4\n"), HasSubstr("found \"" + cell + "…\""));
}

TEST(CsvTable, ADateBeyondTheCalendarIsNoTime) {
  const CsvOptions two{.inputs = {"u"}, .outputs = {"y"}};
  EXPECT_EQ(complaint("date,u,y\n2024-01-01,1,2\n2024-01-02,2,3\n", two), "no complaint");
  for (const char* date : {"2024-257", "2024-13", "67890-01", "12345678901-01"}) {
    const std::string day(date);
    EXPECT_THAT(complaint("date,u,y\n" + day + "-01,1,2\n" + day + "-02,2,3\n", two),
                HasSubstr("\"date\" is no number of seconds"));
  }
  EXPECT_THAT(complaint("date,u,y\n2024-01-257,1,2\n2024-01-258,2,3\n", two), HasSubstr("is no number of seconds"));
}

TEST(CsvTable, AJumpOfTheClockByYearsIsNamed) {
  EXPECT_THAT(complaint("t,u,y\n0.0,1,2\n0.1,2,3\n0.2,2,3\n1.7e9,1,2\n1700000000.1,1,2\n1700000000.2,1,2\n",
                        {.inputs = {"u"}, .outputs = {"y"}}),
              HasSubstr("time has gaps of 1000 times as many rows as there are"));
}

TEST(CsvTable, ATimeThatIsNoFiniteNumberIsNamedWithItsRow) {
  for (const std::string time : {"inf", "nan"}) {
    EXPECT_THAT(complaint("t,u,y\n0,1,2\n0.5,2,3\n" + time + ",3,4\n", {.inputs = {"u"}, .outputs = {"y"}}),
                HasSubstr("row 4: column \"t\" is \"" + time + "\", expected steps of 0.5"));
  }
}

TEST(CsvTable, ACommentBetweenRowsIsPassedOver) {
  EXPECT_EQ(complaint("u,y\n1,2\n# lamp switched on, a little late\n3,4\n% done\n#\n"), "no complaint");
  EXPECT_THAT(complaint("u,y\n1,2\n# here\n3,x\n"), HasSubstr("row 4"));
}

TEST(CsvTable, AColumnOfNumbersAloneMayHaveDecimalCommas) {
  const auto recording = parse("y\n1,5\n2,5\n", {.rate_hz = 1, .outputs = {"y"}});
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_THAT(recording->channels[0].samples, ElementsAre(1.5, 2.5));
}

}  // namespace
}  // namespace wisp::csv_tables_test
