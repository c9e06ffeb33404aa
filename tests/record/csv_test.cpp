#include "wisp/record/csv.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <filesystem>
#include <limits>
#include <random>
#include <sstream>

namespace wisp::csv_test {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

Result<Recording> parse(const std::string& text, const CsvOptions& options = {}) {
  std::istringstream stream(text);
  return read_csv(stream, "test.csv", options);
}

std::string complaint(const std::string& text, const CsvOptions& options = {}) {
  const auto outcome = parse(text, options);
  return outcome ? "no complaint" : outcome.error().message;
}

const std::string kHead = "# wisp-recording 1\n# rate_hz 30\n";

TEST(Csv, ReadsItsOwnFormWithRolesUnitsEpisodesFlagsAndAttributes) {
  const auto recording = parse(kHead +
                               "# knots 0 0 0 0 1 1 1 1\n"
                               "episode,u:wind[m/s],y:p0.x[px],m:base.x[px],flag:filled\n"
                               "0,0.5,1e-3,7,0\n"
                               "0,,2,7,1\n"
                               "4,-1,3,8,0\n");
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_EQ(recording->rate_hz, 30);
  ASSERT_EQ(recording->channels.size(), 3u);
  EXPECT_EQ(recording->channels[0].role, Role::kInput);
  EXPECT_EQ(recording->channels[0].unit, "m/s");
  EXPECT_EQ(recording->channels[1].name, "p0.x");
  EXPECT_EQ(recording->channels[2].role, Role::kMotion);
  EXPECT_TRUE(std::isnan(recording->channels[0].samples[1]));
  EXPECT_EQ(recording->flags.at(0).rows, (std::vector<std::uint8_t>{0, 1, 0}));
  EXPECT_EQ(find_attribute(*recording, "knots"), "0 0 0 0 1 1 1 1");
  const auto found = episodes(*recording);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].end, 2u);
  EXPECT_EQ(found[1].size(), 1u);
}

TEST(Csv, ReadsAPlainTableWhenNamesAndRateAreGiven) {
  const auto recording = parse("\xef\xbb\xbftime, \"u1\",y1\r\n12:00,1,2\r\n12:01,+3,-4.5e2\r\n\r\n",
                               {.rate_hz = 12.5, .inputs = {"u1"}, .outputs = {"y1"}});
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_EQ(recording->rate_hz, 12.5);
  ASSERT_EQ(recording->rows(), 2u);
  EXPECT_EQ(recording->channels[1].samples[1], -450);
}

TEST(Csv, SkippedRowsAreCountedButNotUnderstood) {
  std::istringstream stream(kHead + "u:a,y:b\n1,2\n\nno number,at all,here\n3,4\n5,6\n");
  auto reader = CsvReader::open(stream, "test.csv");
  ASSERT_TRUE(reader);
  EXPECT_EQ(*reader->skip(2), 2u);
  Recording rest = reader->header();
  EXPECT_EQ(*reader->read(rest, 1), 1u);
  EXPECT_EQ(rest.channels[1].samples, std::vector<double>{4});
  EXPECT_EQ(*reader->skip(10), 1u);
  EXPECT_EQ(*reader->skip(10), 0u);
}

TEST(Csv, ReadsSemicolonsAndTabs) {
  const CsvOptions options{.rate_hz = 1, .outputs = {"b"}};
  EXPECT_EQ(parse("a;b\n1;2\n", options)->channels[0].samples[0], 2);
  EXPECT_EQ(parse("a\tb\n1\t2\n", options)->channels[0].samples[0], 2);
}

TEST(Csv, NumbersRoundTripBitForBit) {
  Recording recording{"", 29.97002997002997, {{"a", "", Role::kOutput, {}}, {"b", "px", Role::kInput, {}}}, {}, {}, {}};
  std::mt19937_64 random(1);
  while (recording.channels[0].samples.size() < 20000) {
    const double value = std::bit_cast<double>(random());
    if (!std::isfinite(value)) continue;
    recording.channels[0].samples.push_back(value);
    recording.channels[1].samples.push_back(random() % 7 ? value / 3 : std::numeric_limits<double>::quiet_NaN());
  }
  recording.channels[0].samples[0] = -0.0;
  recording.channels[0].samples[1] = std::numeric_limits<double>::denorm_min();
  const auto read = parse(csv_text(recording));
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->rate_hz, recording.rate_hz);
  for (std::size_t k : {0u, 1u}) {
    for (std::size_t row = 0; row < recording.rows(); ++row) {
      const double was = recording.channels[k].samples[row], is = read->channels[k].samples[row];
      if (std::isnan(was)) {
        EXPECT_TRUE(std::isnan(is));
      } else {
        EXPECT_EQ(std::bit_cast<std::uint64_t>(was), std::bit_cast<std::uint64_t>(is));
      }
    }
  }
}

TEST(Csv, ASingleChannelKeepsItsMissingSamples) {
  Recording recording{"", 1, {{"a", "", Role::kOutput, {1, std::nan(""), 3}}}, {}, {}, {}};
  const auto read = parse(csv_text(recording));
  ASSERT_TRUE(read) << read.error().message;
  ASSERT_EQ(read->rows(), 3u);
  EXPECT_TRUE(std::isnan(read->channels[0].samples[1]));
}

TEST(Csv, AWrongColumnCountIsNamedWithItsRow) {
  EXPECT_THAT(complaint(kHead + "u:a,y:b\n1,2\n1,2,3\n"), AllOf(HasSubstr("test.csv, row 5"), HasSubstr("3 columns")));
  EXPECT_THAT(complaint(kHead + "u:a,y:b\n1\n"),
              AllOf(HasSubstr("row 4"), HasSubstr("has 1 columns, the header has 2")));
}

TEST(Csv, WhatIsNotANumberIsNamedWithItsRow) {
  EXPECT_THAT(complaint(kHead + "u:a,y:b\n1,two\n"), AllOf(HasSubstr("row 4"), HasSubstr("\"two\", column 2")));
  EXPECT_THAT(complaint(kHead + "u:a,y:b\n1,2.5.1\n"), HasSubstr("expected a number"));
  EXPECT_THAT(complaint(kHead + "u:a,y:b\n1,0x10\n"), HasSubstr("expected a number"));
  for (const char* cell : {"inf", "-Infinity", "1e999"}) {
    EXPECT_THAT(complaint(kHead + "u:a,y:b\n1," + cell + "\n"), HasSubstr("expected a finite number")) << cell;
  }
}

double rate_by_time(const std::string& text, double usual = 0) {
  const auto recording = parse(text, {.usual_rate_hz = usual, .inputs = {"u"}, .outputs = {"y"}});
  EXPECT_TRUE(recording) << recording.error().message;
  return recording ? recording->rate_hz : 0;
}

TEST(Csv, AColumnOfTimeGivesTheRate) {
  EXPECT_DOUBLE_EQ(rate_by_time("t,u,y\n0,1,2\n0.08,2,3\n0.16,3,4\n"), 12.5);
  EXPECT_DOUBLE_EQ(rate_by_time("Time (ms),u,y\n0,1,2\n33,2,3\n67,3,4\n100,1,1\n133,1,1\n"), 30);
  EXPECT_DOUBLE_EQ(rate_by_time("time[ms];u;y\n0;1;2\n2,5;2;3\n5;3;4\n"), 400);
  EXPECT_DOUBLE_EQ(rate_by_time("time,u,y\nmin,V,K\n0,1,2\n0.5,2,3\n1,3,4\n"), 1 / 30.0);
  EXPECT_DOUBLE_EQ(rate_by_time("t_s,u,y\n1,1,2\n2,2,3\n3,3,4\n"), 1);
  EXPECT_DOUBLE_EQ(rate_by_time("t,u,y\n10.1,1,2\n10.2,2,3\n10.3,3,4\n", 25), 10);
  EXPECT_DOUBLE_EQ(rate_by_time("time,u,y\n0,1,2\n33,2,3\n67,3,4\n100,1,1\n133,1,1\n"), 30);
  EXPECT_DOUBLE_EQ(rate_by_time("time,u,y\n08:00:00.000,1,2\n08:00:02.500,2,3\n08:00:05.000,3,4\n"), 0.4);
  EXPECT_DOUBLE_EQ(rate_by_time("time,u,y\n2024-01-01T08:00:00+02:00,1,2\n2024-01-01T08:00:05+02:00,2,3\n"), 0.2);
}

TEST(Csv, DatesAndTimesOfDayAreInSecondsWhateverTheColumnsNameSays) {
  const std::string dates = ",u,y\n2024-01-31 13:05:00,1,2\n2024-01-31 13:05:05,2,3\n";
  for (const char* name : {"Timestamp (UTC)", "time[UTC]", "Date (yyyy-mm-dd)"}) {
    EXPECT_DOUBLE_EQ(rate_by_time(name + dates), 0.2) << name;
  }
  EXPECT_DOUBLE_EQ(rate_by_time("Time (h),u,y\n08:00:00,1,2\n08:00:05,2,3\n"), 0.2);
}

TEST(Csv, ATimeOfDayWithAFractionMayLackItsHour) {
  EXPECT_DOUBLE_EQ(rate_by_time("time,u,y\n05:00.9,1,2\n05:01.0,2,3\n05:01.1,3,4\n"), 10);
  EXPECT_DOUBLE_EQ(rate_by_time("time;u;y\n05:00,9;1;2\n05:01,0;2;3\n05:01,1;3;4\n"), 10);
  EXPECT_DOUBLE_EQ(rate_by_time("date;u;y\n31.01.2024 13:05:00,5;1;2\n31.01.2024 13:05:01,0;2;3\n"), 2);
}

TEST(Csv, ATimeOfDayMayHavePointsWhereItIsNoDate) {
  EXPECT_DOUBLE_EQ(rate_by_time("time,u,y\n13.05.59,1,2\n13.06.00,2,3\n13.06.01,3,4\n"), 1);
  EXPECT_DOUBLE_EQ(rate_by_time("date,u,y\n13.05.59,1,2\n14.05.59,2,3\n15.05.59,3,4\n"), 1 / 86400.0);
  EXPECT_DOUBLE_EQ(rate_by_time("time,u,y\n22.01.24,1,2\n23.01.24,2,3\n24.01.24,3,4\n"), 1 / 86400.0);
}

TEST(Csv, ATimeOfDayMayBeOfTheMorningOrTheAfternoon) {
  EXPECT_DOUBLE_EQ(rate_by_time("time,u,y\n12:59:59 PM,1,2\n1:00:00 PM,2,3\n1:00:01 PM,3,4\n"), 1);
  EXPECT_DOUBLE_EQ(rate_by_time("date,u,y\n2024-01-31 11:59:58 p. m.,1,2\n2024-02-01 12:00:00 a.m.,2,3\n"), 0.5);
}

TEST(Csv, ATimeOfDayGoesOnAfterMidnightAndAfterTheHour) {
  EXPECT_DOUBLE_EQ(rate_by_time("time,u,y\n23:59:58,1,2\n23:59:59,2,3\n00:00:00,3,4\n00:00:01,4,5\n"), 1);
  EXPECT_DOUBLE_EQ(rate_by_time("time,u,y\n59:59.8,1,2\n59:59.9,2,3\n00:00.0,3,4\n00:00.1,4,5\n"), 10);
}

TEST(Csv, ATimeThatCountsFrom1970IsInFractionsOfASecond) {
  EXPECT_DOUBLE_EQ(rate_by_time("timestamp,u,y\n1706706000000,1,2\n1706706000030,2,3\n1706706000060,3,4\n"), 1 / 0.03);
  EXPECT_DOUBLE_EQ(rate_by_time("t,u,y\n1706706000000000,1,2\n1706706000001000,2,3\n1706706000002000,3,4\n"), 1000);
}

TEST(Csv, BesideADateThatStaysTheSameATimeOfDayGivesTheRate) {
  EXPECT_DOUBLE_EQ(rate_by_time("date,time,u,y\n2024-01-31,13:05:00,1,2\n2024-01-31,13:05:05,2,3\n"), 0.2);
  EXPECT_DOUBLE_EQ(rate_by_time("date,time,u,y\n2024-01-31,00:00,1,2\n2024-02-01,00:00,2,3\n"), 1 / 86400.0);
  EXPECT_DOUBLE_EQ(rate_by_time("date,time,u,y\n-,-,V,K\n2024-01-31,13:05:00,1,2\n2024-01-31,13:05:05,2,3\n"), 0.2);
}

TEST(Csv, AColumnOfTimeBeginsAnewWithEveryEpisode) {
  EXPECT_DOUBLE_EQ(rate_by_time("t,episode,u,y\n0,1,1,2\n0.1,1,2,3\n0,2,2,3\n0.1,2,3,4\n"), 10);
}

TEST(Csv, UnevenTimeInATableWithEpisodesIsNamed) {
  EXPECT_THAT(complaint("t,episode,u,y\n0,1,1,2\n0.1,1,2,3\n0.25,1,2,3\n0,2,2,3\n0.1,2,3,4\n", {.inputs = {"u"}}),
              HasSubstr("row 4: column \"t\" goes on by 0.15, expected steps of 0.1"));
}

TEST(Csv, ACountOfRowsIsNoTime) {
  const std::string table = "t,u,y\n1,1,2\n2,2,3\n3,3,4\n";
  EXPECT_THAT(complaint(table, {.inputs = {"u"}}), HasSubstr("states no rate"));
  EXPECT_DOUBLE_EQ(rate_by_time(table, 25), 25);
}

TEST(Csv, UnevenTimeIsResampledAndAGapIsMissing) {
  const std::string table = "time,u,y\n0,1,2\n0.1,2,3\n0.2,2,3\n0.4,3,4\n0.5,3,4\n";
  const auto even = parse(table, {.inputs = {"u"}});
  ASSERT_TRUE(even) << even.error().message;
  EXPECT_NEAR(even->rate_hz, 10, 1e-9);
  ASSERT_EQ(even->rows(), 6u);
  EXPECT_TRUE(std::isnan(even->channels[0].samples[3]));
  EXPECT_NEAR(even->channels[0].samples[5], 3, 1e-9);
  EXPECT_THAT(even->rate_note.text, HasSubstr("resampled by straight lines"));
  EXPECT_TRUE(parse(table, {.rate_hz = 10, .inputs = {"u"}})->rate_note.text.empty());
  EXPECT_THAT(complaint("time,u\n0,1\n0.1,1\n0.2,1\n0.15,1\n", {.inputs = {"u"}}), HasSubstr("time does not go on"));
}

TEST(Csv, ResamplingKeepsASampleBesideAMissingOne) {
  // The fourth new row is at 3 * 0.1 s, in double precision a little above 0.3 s; 0.6 / 0.1 is a little below 6.
  const auto even = parse("time,y\n0,1\n0.1,\n0.2,3\n0.3,4\n0.4,\n0.53,6\n0.6,7\n", {.outputs = {"y"}});
  ASSERT_TRUE(even) << even.error().message;
  const std::vector<double>& samples = even->channels[0].samples;
  ASSERT_EQ(samples.size(), 7u);
  EXPECT_EQ(samples[0], 1);
  EXPECT_TRUE(std::isnan(samples[1]));
  EXPECT_EQ(samples[2], 3);
  EXPECT_EQ(samples[3], 4);
  EXPECT_EQ(samples[6], 7);
}

TEST(Csv, ResamplingMovesNoSampleThatIsOnTheGrid) {
  // In double precision 2.3 + 3 * 0.1 is below 2.6, and 2.3 + 8 * 0.1 below 3.1.
  std::string table = "time,u,y\n2.3,0,0\n2.4,0,1\n2.6,0,3\n2.7,0,4\n2.8,0,5\n2.9,0,6\n3.0,0,7\n3.1,1,8\n3.2,1,9\n";
  const auto even = parse(table + "3.3,1,10\n", {.inputs = {"u"}, .outputs = {"y"}});
  ASSERT_TRUE(even) << even.error().message;
  EXPECT_THAT(even->channels[0].samples, ElementsAre(0, 0, testing::IsNan(), 0, 0, 0, 0, 0, 1, 1, 1));
  EXPECT_THAT(even->channels[1].samples, ElementsAre(0, 1, testing::IsNan(), 3, 4, 5, 6, 7, 8, 9, 10));
}

TEST(Csv, ATableThatLacksARowKeepsItsRoundRate) {
  const std::string table = "time,u\n0.0000,1\n0.0167,2\n0.0333,3\n0.0500,4\n0.0667,5\n0.1000,6\n0.1167,7\n";
  const auto even = parse(table, {.inputs = {"u"}});
  ASSERT_TRUE(even) << even.error().message;
  EXPECT_DOUBLE_EQ(even->rate_hz, 60);
}

TEST(Csv, AnUnevenClockTakenAsMillisecondsIsSaidToBeBoth) {
  const auto even = parse("time,u\n0,1\n20,2\n47,3\n60,4\n80,5\n100,6\n", {.inputs = {"u"}});
  ASSERT_TRUE(even) << even.error().message;
  EXPECT_THAT(even->rate_note.text, AllOf(HasSubstr("taken as milliseconds; "), HasSubstr("the clock is uneven by")));
}

TEST(Csv, AJitteredClockIsResampledAtItsRoundRateAndSaysTheTrueError) {
  const auto truth = [](double t) { return std::sin(9 * t); };
  std::mt19937 chance(5);
  std::uniform_real_distribution<double> late(0, 0.02);
  std::string table = "time,y\n0,0\n";
  for (int row = 1; row < 400; ++row) {
    const double t = std::round(1e4 * (0.1 * row + late(chance))) / 1e4;
    table += std::to_string(t) + "," + std::to_string(truth(t)) + "\n";
  }
  const auto even = parse(table, {.outputs = {"y"}});
  ASSERT_TRUE(even) << even.error().message;
  EXPECT_EQ(even->rate_hz, 10) << "the mean step is 0.10001 s";
  const std::vector<double>& samples = even->channels[0].samples;
  double wrong = 0, square = 0;
  for (std::size_t row = 0; row < samples.size(); ++row) {
    wrong += std::pow(samples[row] - truth(0.1 * static_cast<double>(row)), 2);
    square += std::pow(samples[row], 2);
  }
  const std::string before = "may be wrong by ", &text = even->rate_note.text;
  ASSERT_THAT(text, HasSubstr(before));
  const double said = std::stod(text.substr(text.find(before) + before.size()));
  EXPECT_NEAR(said, 100 * std::sqrt(wrong / square), 0.25 * said) << text;
}

TEST(Csv, DatesSayTheRate) {
  for (const char* table : {"time,u\n2024-01-01 23:59,1\n2024-01-02T00:00Z,2\n",
                            "date,u\n31.12.2023 23:59:30,1\n01.01.2024 00:00:30,2\n"}) {
    const auto recording = parse(table, {.inputs = {"u"}});
    ASSERT_TRUE(recording) << recording.error().message;
    EXPECT_NEAR(recording->rate_hz, 1.0 / 60, 1e-9) << table;
  }
}

TEST(Csv, DatesWithPointsAreEvenWithinTheSecondsThatAreWritten) {
  std::string table = "time,u\n";
  for (const std::string row : {"00,1", "02,2", "05,3", "07,4", "10,5"}) table += "31.01.2024 13:05:" + row + "\n";
  const auto recording = parse(table, {.inputs = {"u"}});
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_DOUBLE_EQ(recording->rate_hz, 0.4);
  EXPECT_THAT(recording->rate_note.text, Not(HasSubstr("uneven")));
  EXPECT_THAT(recording->channels[0].samples, ElementsAre(1, 2, 3, 4, 5));
}

TEST(Csv, TimeThatSaysNoRateIsRefused) {
  EXPECT_THAT(complaint("time,u\n0.1,1\n,2\n0.3,3\n", {.inputs = {"u"}}), HasSubstr("states no rate"));
  EXPECT_THAT(complaint("time,u\n0.1,1\n0.2,2\n,3\n", {.inputs = {"u"}}), HasSubstr("row 4: column \"time\" is"));
  EXPECT_THAT(complaint("time,u\n0.2,1\n0.1,2\n", {.inputs = {"u"}}), HasSubstr("row 3: column \"time\" does not go"));
  EXPECT_THAT(complaint("time,u\nmorning,1.5\nnoon,2\n", {.inputs = {"u"}}),
              AllOf(HasSubstr("row 2: column \"time\" is no number of seconds"), HasSubstr("--dt")));
  EXPECT_THAT(complaint("time[days],u\n0.2,1\n0.3,2\n", {.inputs = {"u"}}), HasSubstr("is in \"days\""));
}

TEST(Csv, LinesMayEndInCarriageReturnsAlone) {
  const auto recording = parse("u,y\r1,2\r3,4\r", {.rate_hz = 1, .inputs = {"u"}, .outputs = {"y"}});
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_EQ(recording->channels[1].samples, (std::vector<double>{2, 4}));
}

TEST(Csv, AHeaderOfMarksAloneHasNoChannels) {
  EXPECT_THAT(complaint(kHead + "episode,flag:filled\n0,1\n"),
              HasSubstr("the header has no input, output or motion column"));
}

TEST(Csv, OfManyColumnsSomeAreListed) {
  std::string header = "c0";
  for (int k = 1; k < 100; ++k) header += ",c" + std::to_string(k);
  EXPECT_THAT(complaint(header + "\n", {.inputs = {"u"}}), HasSubstr("c39 and 60 more"));
}

TEST(Csv, AFileWithoutRateRowsOrHeaderIsRefused) {
  EXPECT_THAT(complaint("# wisp-recording 1\nu:a\n1\n"), HasSubstr("states no rate"));
  EXPECT_THAT(complaint("# wisp-recording 1\n# rate_hz fast\nu:a\n1\n"), HasSubstr("rate_hz is \"fast\""));
  EXPECT_THAT(complaint("# wisp-recording 1\n# rate_hz -30\nu:a\n1\n"), HasSubstr("above 0"));
  EXPECT_THAT(complaint(kHead + "u:a,y:b\n"), HasSubstr("no rows"));
  EXPECT_THAT(complaint(""), HasSubstr("is empty"));
  EXPECT_THAT(complaint(kHead), HasSubstr("is empty"));
  EXPECT_THAT(complaint("1,2\n3,4\n", {.rate_hz = 1, .inputs = {"a"}}), HasSubstr("starts with numbers"));
}

TEST(Csv, ColumnsThatCannotBeUnderstoodAreNamed) {
  EXPECT_THAT(complaint(kHead + "u:a,b\n1,2\n"), HasSubstr("\"b\" has no role"));
  EXPECT_THAT(complaint(kHead + "u:a,y:a\n1,2\n"), HasSubstr("two columns are named"));
  EXPECT_THAT(complaint("a,b\n1,2\n", {.rate_hz = 1}), HasSubstr("--inputs and --outputs"));
  EXPECT_THAT(complaint("a,b\n1,2\n", {.rate_hz = 1, .inputs = {"c"}}), HasSubstr("its columns are a, b"));
  EXPECT_THAT(complaint("# wisp-recording 9\n# rate_hz 1\nu:a\n1\n"), HasSubstr("version"));
  EXPECT_THAT(complaint(kHead + "y:a,flag:x\n1,2\n"), HasSubstr("expected a flag, 0 or 1"));
  EXPECT_THAT(complaint(kHead + "episode,y:a\n1.5,2\n"), HasSubstr("whole number"));
}

TEST(Csv, ASpreadsheetMayEndCommentLinesInCommas) {
  const auto recording = parse("# wisp-recording 1,,\n# rate_hz 30,,\n# usable no,,\nepisode,u:a,y:b\n0,1,2\n0,3,4\n");
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_EQ(recording->rate_hz, 30);
  EXPECT_EQ(find_attribute(*recording, "usable"), "no");
}

TEST(Csv, ASpreadsheetMayWriteSemicolonsAndDecimalCommas) {
  const auto recording = parse("# wisp-recording 1;;\n# rate_hz 30;;\nepisode;u:a;y:b\n0;1,5;2\n0;2,5;\n");
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_EQ(recording->rate_hz, 30);
  EXPECT_THAT(recording->channels[0].samples, ElementsAre(1.5, 2.5));
  const auto named = parse(kHead + "y:a;b,u:c\n1,2\n3,4\n");  // a semicolon in a name separates nothing
  ASSERT_TRUE(named) << named.error().message;
  EXPECT_EQ(named->channels[0].name, "a;b");
}

TEST(Csv, BinaryRubbishAndEndlessLinesAreRefusedInBoundedMemory) {
  EXPECT_THAT(complaint(std::string("\x7f\x45\x4c\x46\x02\x01\x00\x00", 8)), HasSubstr("not text"));
  EXPECT_THAT(complaint(kHead + "u:a,y:b\n1,\x01\n"), AllOf(HasSubstr("row 4"), HasSubstr("not text")));

  // A stream that never ends a line stands for the 2 GB one; reading must stop by itself.
  struct Endless : std::streambuf {
    char block[4096];
    std::size_t served = 0;
    int underflow() override {
      served += sizeof block;
      std::fill(std::begin(block), std::end(block), '7');
      setg(block, block, block + sizeof block);
      return block[0];
    }
  } endless;
  std::istream stream(&endless);
  const auto outcome = read_csv(stream, "endless.csv");
  ASSERT_FALSE(outcome);
  EXPECT_THAT(outcome.error().message, HasSubstr("longer than 16 MiB"));
  EXPECT_LT(endless.served, std::size_t{17} << 20);
}

TEST(Csv, IsReadAStretchAtATime) {
  std::istringstream stream(kHead + "u:a\n1\n2\n3\n");
  auto reader = CsvReader::open(stream, "test.csv");
  ASSERT_TRUE(reader);
  Recording chunk = reader->header();
  EXPECT_EQ(*reader->read(chunk, 2), 2u);
  EXPECT_EQ(*reader->read(chunk, 2), 1u);
  EXPECT_EQ(*reader->read(chunk, 2), 0u);
  EXPECT_EQ(chunk.channels[0].samples, (std::vector<double>{1, 2, 3}));
}

TEST(Csv, AnEpisodeMayBeginWithAStretch) {
  std::istringstream stream("t,episode,u\n0,1,1\n0.1,1,2\n0,2,3\n0.1,2,4\n");
  auto reader = CsvReader::open(stream, "test.csv", {.inputs = {"u"}});
  ASSERT_TRUE(reader) << reader.error().message;
  for (int stretch = 0; stretch < 2; ++stretch) {
    Recording chunk = reader->header();
    const auto rows = reader->read(chunk, 2);
    ASSERT_TRUE(rows) << rows.error().message;
    EXPECT_EQ(*rows, 2u);
  }
}

TEST(Csv, ABadRecordingIsNotWritten) {
  const auto path = std::filesystem::path(testing::TempDir()) / "bad_recording.csv";
  std::filesystem::remove(path);
  Recording recording{"", 0, {{"a", "", Role::kOutput, {1}}}, {}, {}, {}};
  EXPECT_FALSE(write_csv(path, recording));
  recording.rate_hz = 1;
  recording.channels[0].name = "a[b";
  EXPECT_FALSE(write_csv(path, recording));
  recording.channels[0].name = "a";
  recording.channels[0].samples[0] = INFINITY;
  EXPECT_FALSE(write_csv(path, recording));
  recording.channels[0].samples[0] = 1;
  recording.flags = {{"filled", {1, 0}}};
  EXPECT_FALSE(write_csv(path, recording)) << "two marks of one row";
  recording.flags = {};
  recording.attributes = {{"good", "yes"}, {"bad", "one\nline more"}};
  EXPECT_FALSE(write_csv(path, recording));
  EXPECT_FALSE(std::filesystem::exists(path));
  recording.attributes.pop_back();
  EXPECT_TRUE(write_csv(path, recording));
}

}  // namespace
}  // namespace wisp::csv_test
