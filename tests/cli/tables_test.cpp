// Tables as strangers have them, through the program; numbers out again: predict, compare, run along a table.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "cli/program.hpp"
#include "wisp/record/csv.hpp"

namespace wisp::tables_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class Tables : public InFolder {
 protected:
  // y(t) = 0.8 y(t−1) + 0.5 u(t−1) + 0.05 e(t), at 10 Hz; every row is written by `row`.
  template <class Row>
  std::string write(const std::string& name, const std::string& head, Row row) const {
    std::ofstream out(at(name));
    out.precision(12);
    out << head;
    std::mt19937 random(1);
    double y = 0, u = 0;
    for (int t = 0; t < 400; ++t) {
      y = 0.8 * y + 0.5 * u + 0.05 * (static_cast<double>(random() % 2001) / 1000 - 1);
      if (t % 5 == 0) u = static_cast<double>(random() % 1000) / 500 - 1;
      row(out, t, u, y);
    }
    return at(name);
  }
  std::string plain(const std::string& name = "plain.csv") const {
    return write(name, "u,y\n", [](std::ostream& out, int, double u, double y) { out << u << ',' << y << '\n'; });
  }
  std::string model(int order = 1) {
    const std::string path = at("m" + std::to_string(order) + ".wisp"), na = std::to_string(order);
    EXPECT_EQ(wisp("learn arx " + plain("learned.csv") + " --inputs u --outputs y --rate 10 --na " + na + " --nb " +
                   na + " --nk 1 -o " + path)
                  .status,
              0);
    return path;
  }
  Recording recording(const std::string& name) const {
    auto found = read_csv(at(name));
    EXPECT_TRUE(found) << found.error().message;
    return *found;
  }
  static const std::vector<double>& samples(const Recording& recording, const std::string& name) {
    return recording.channels[find_channel(recording, name).value()].samples;
  }
};

std::string with_comma(double x) {
  std::ostringstream text;
  text.precision(12);
  text << x;
  std::string out = text.str();
  if (out.find('.') != out.npos) out[out.find('.')] = ',';
  return out;
}

// An element of a MATLAB file of level 5, padded to eight bytes.
std::string element(std::uint32_t kind, std::string bytes) {
  const std::uint32_t tag[] = {kind, static_cast<std::uint32_t>(bytes.size())};
  bytes.resize((bytes.size() + 7) / 8 * 8);
  return std::string(reinterpret_cast<const char*>(tag), sizeof tag) + bytes;
}

template <class Number>
std::string bytes_of(const std::vector<Number>& numbers) {
  return {reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(Number)};
}

std::string matrix(const std::string& name, int rows, int columns, const std::vector<double>& numbers) {
  return element(14, element(6, bytes_of<std::uint32_t>({6, 0})) + element(5, bytes_of<std::int32_t>({rows, columns})) +
                         element(1, name) + element(9, bytes_of(numbers)));
}

TEST_F(Tables, ColumnsOfAMatrixAreNamedAsTheMessageListsThem) {
  std::vector<double> u, y;
  write("rows.csv", "", [&](std::ostream&, int, double a, double b) { u.push_back(a), y.push_back(b); });
  u.insert(u.end(), y.rbegin(), y.rend());
  const std::string mat = at("m.mat"), named = " --outputs y --rate 10 --na 1 --nb 1 --json --inputs ";
  std::ofstream(mat, std::ios::binary) << std::string(124, ' ') << std::string("\0\1IM", 4) << matrix("u", 400, 2, u)
                                       << matrix("y", 400, 1, y);
  EXPECT_THAT(wisp("learn arx " + mat + named + "u").err, HasSubstr("it has: u1, u2, y"));
  const Said columns = wisp("learn arx " + mat + named + "u1,u2 -o " + at("columns.wisp"));
  ASSERT_EQ(columns.status, 0) << columns.err;
  EXPECT_EQ(columns.json()["B"], wisp("learn arx " + mat + named + "'u(:,1),u(:,2)'").json()["B"]);
  EXPECT_EQ(wisp("validate " + at("columns.wisp") + " " + mat).status, 0);
  EXPECT_THAT(wisp("learn arx " + mat + named + "u3").err, HasSubstr("variable u(:,3): the variable has 2 columns"));
  EXPECT_EQ(wisp("learn arx " + mat + named + "u1 --unpacked -1").status, 2);
  EXPECT_THAT(wisp("capture brightness " + mat + " --channel u --rate 10 -o " + at("light.csv")).err,
              HasSubstr("several columns; name one, such as u1"));
}

TEST_F(Tables, TheLightOfAPlainTableIsItsOnlyColumnOrTheNamedOne) {
  std::ofstream one(at("one.csv")), two(at("two.csv"));
  one << "light\n";
  two << "light,volts\n";
  std::mt19937 random(3);
  double light = 0;
  for (int t = 0; t < 4000; ++t) {
    light = 0.9 * light + (t / 60 % 3 == 0 ? 0.08 : 0.008) * (static_cast<double>(random() % 2001) / 1000 - 1);
    one << 1 + light << '\n';
    two << 1 + light << ',' << t % 7 << '\n';
  }
  one.close();
  two.close();
  const Said only = wisp("learn flicker " + at("one.csv") + " --rate 50 --json");
  ASSERT_EQ(only.status, 0) << only.err;
  EXPECT_THAT(wisp("learn flicker " + at("two.csv") + " --rate 50 --json").err,
              HasSubstr("name the one that is light"));
  const Said named = wisp("learn flicker " + at("two.csv") + " --channel light --rate 50 --json");
  ASSERT_EQ(named.status, 0) << named.err;
  EXPECT_EQ(named.json()["modes"], only.json()["modes"]);
}

TEST_F(Tables, TheSameNumbersGiveTheSameModelHoweverTheyAreWritten) {
  plain();
  write("german.csv", "sep=;\nZeit;\"u, Kraft\";y\ns;N;m\n", [](std::ostream& out, int t, double u, double y) {
    out << t << ';' << with_comma(u) << ';' << with_comma(y) << ";\r\n";
  });
  write("daisy.dat", "",
        [](std::ostream& out, int t, double u, double y) { out << "  " << t << "   " << u << "  \t " << y << "\n"; });
  write("pandas.csv", ",u,y\n",
        [](std::ostream& out, int t, double u, double y) { out << t << ", \"" << u << "\", " << y << "\n"; });
  const auto learned = [&](const std::string& table, const std::string& names) {
    const Said said = wisp("learn arx " + at(table) + " --rate 10 --na 1 --nb 1 --nk 1 --json " + names);
    EXPECT_EQ(said.status, 0) << table << said.err;
    return said.json()["A"];
  };
  const auto expected = learned("plain.csv", "--inputs u --outputs y");
  EXPECT_EQ(learned("german.csv", "--inputs '\"u, Kraft\"' --outputs y"), expected);
  EXPECT_EQ(learned("daisy.dat", "--columns t,u,y --inputs u --outputs y"), expected);
  EXPECT_EQ(learned("pandas.csv", "--inputs u --outputs y"), expected);
}

TEST_F(Tables, AColumnOfTimeGivesTheRateOfLearningAndOfJudging) {
  const std::string even = write("even.csv", "time,u,y\n", [](std::ostream& out, int t, double u, double y) {
    out << t * 0.08 << ',' << u << ',' << y << '\n';
  });
  const std::string slower = write("slower.csv", "time[ms],u,y\n", [](std::ostream& out, int t, double u, double y) {
    out << t * 100 << ',' << u << ',' << y << '\n';
  });
  const std::string names = " --inputs u --outputs y";
  ASSERT_EQ(wisp("learn arx " + even + names + " --na 1 --nb 1 -o " + at("timed.wisp")).status, 0);
  EXPECT_EQ(wisp("info --json " + at("timed.wisp")).json()["rate_hz"], 12.5);
  EXPECT_EQ(wisp("validate " + at("timed.wisp") + " " + even + " --json").status, 0);
  const Said other = wisp("validate " + at("timed.wisp") + " " + slower + " --json");
  EXPECT_EQ(other.status, 1);
  EXPECT_THAT(other.err, AllOf(HasSubstr("10"), HasSubstr("12.5")));
}

TEST_F(Tables, ANameMayHoldQuotes) {
  const std::string table = write("quoted.csv", "\"Air \"\"out\"\"\",\"u, \"\"W\"\"\"\n",
                                  [](std::ostream& out, int, double u, double y) { out << y << ',' << u << '\n'; });
  const Said said = wisp("learn arx " + table + " --rate 10 --na 1 --nb 1 --json --outputs 'Air \"out\"' --inputs " +
                         "'\"u, \"\"W\"\"\"'");
  EXPECT_EQ(said.status, 0) << said.err;
}

TEST_F(Tables, ARefusalSaysWhatWouldWork) {
  write("daisy.dat", "",
        [](std::ostream& out, int t, double u, double y) { out << t << " " << u << " " << y << "\n"; });
  const Said nameless = wisp("learn arx " + at("daisy.dat") + " --rate 10 --outputs y --json");
  EXPECT_EQ(nameless.status, 1);
  EXPECT_THAT(nameless.err, AllOf(HasSubstr("daisy.dat, row 1"), HasSubstr("--columns u1,u2,y1")));
  const Said rateless = wisp("learn arx " + plain() + " --inputs u --outputs y --json");
  EXPECT_THAT(rateless.err, HasSubstr("states no rate; expected"));
  write("split.csv", "u,y\n",
        [](std::ostream& out, int t, double u, double y) { out << u << ',' << y << (t == 50 ? ",5\n" : "\n"); });
  EXPECT_THAT(wisp("learn arx " + at("split.csv") + " --inputs u --outputs y --rate 10 --json").err,
              AllOf(HasSubstr("split.csv, row 52: has 3 columns, the header has 2"), HasSubstr("stands in quotes")));
}

TEST_F(Tables, NumbersWhoseSquaresNoNumberHoldsAreNotConstant) {
  for (const char* power : {"e-200", "e200"}) {
    const std::string far = write("far.csv", "u,y\n", [&](std::ostream& out, int, double u, double y) {
      out << std::fixed << u << ',' << y << power << '\n';
    });
    const Said said = wisp("learn arx " + far + " --inputs u --outputs y --rate 10 --json");
    EXPECT_EQ(said.status, 1) << power;
    EXPECT_THAT(said.err, AllOf(HasSubstr("channel 'y' reaches from"), HasSubstr("give it in another unit"))) << power;
  }
}

TEST_F(Tables, WithJsonALearnerNeedsNoFile) {
  const Said said = wisp("learn arx " + plain() + " --inputs u --outputs y --rate 10 --na 1 --nb 1 --json");
  ASSERT_EQ(said.status, 0) << said.err;
  EXPECT_TRUE(said.json().contains("A"));
  EXPECT_FALSE(said.json().contains("output"));
  EXPECT_EQ(wisp("learn arx " + plain() + " --inputs u --outputs y --rate 10").status, 2);
}

TEST_F(Tables, HelpListsTheChoicesOfAFlag) {
  EXPECT_THAT(wisp("learn arx --help").out, HasSubstr("(one of mean, none, estimate)"));
  EXPECT_THAT(wisp("validate --help").out, HasSubstr("(one of measured, zero, estimated)"));
}

TEST_F(Tables, AModelIsValidatedOnColumnsOfOtherNames) {
  const std::string m = model();
  write("other.csv", "a,b,u\n",
        [](std::ostream& out, int t, double u, double y) { out << u << ',' << y << ',' << t << '\n'; });
  const Said own = wisp("validate " + m + " " + plain() + " --json");
  ASSERT_EQ(own.status, 0) << own.err;
  const Said other = wisp("validate " + m + " " + at("other.csv") + " --inputs a --outputs b --json");
  ASSERT_EQ(other.status, 0) << other.err;
  EXPECT_EQ(other.json()["channels"], own.json()["channels"]);
  EXPECT_THAT(wisp("validate " + m + " " + at("other.csv") + " --inputs a").err, HasSubstr("has no column \"y\""));
  EXPECT_THAT(wisp("validate " + m + " " + at("other.csv") + " --inputs a,b --outputs b").err,
              HasSubstr("--inputs names 2 channels, the model has 1"));
  EXPECT_THAT(wisp("validate " + m + " " + plain() + " --inputs y").err,
              HasSubstr("channel y stands for the model's u and for its y: name another"));
}

TEST_F(Tables, AModelOfPlainOutputsIsNotFilmed) {
  const Said said = wisp("validate " + model() + " " + plain() + " --film " + at("f.mp4"));
  EXPECT_EQ(said.status, 1);
  EXPECT_THAT(said.err, HasSubstr("is not a model of an outline, for which --film draws nothing"));
}

TEST_F(Tables, ARecordingOfAnotherRateIsRefused) {
  const std::string m = model();
  for (const std::string& line :
       {"validate " + m + " " + plain() + " --rate 20", "predict " + m + " " + plain() + " --rate 20 -o " + at("p.csv"),
        "compare " + plain() + " " + m + " --dt 0.05"}) {
    const Said said = wisp(line);
    EXPECT_EQ(said.status, 1) << line;
    EXPECT_THAT(said.err, HasSubstr("has 20 samples a second, the model 10: resample")) << line;
  }
}

TEST_F(Tables, ATableOfAModelThatResamplesStatesItsOwnRate) {
  const std::string m = at("slow.wisp");
  const std::string flags = " --inputs u --outputs y --rate 10 --prepare resample:5 --na 1 --nb 2 --nk 0 -o ";
  ASSERT_EQ(wisp("learn arx " + plain() + flags + m).status, 0);
  for (const std::string& line :
       {"validate " + m + " " + plain(), "predict " + m + " " + plain() + " -o " + at("p.csv"),
        "compare " + plain() + " " + m}) {
    const Said said = wisp(line);
    EXPECT_EQ(said.status, 1) << line;
    EXPECT_THAT(said.err, HasSubstr("states no rate")) << line;
    EXPECT_EQ(wisp(line + " --rate 10").status, 0) << line;
  }
}

TEST_F(Tables, FlagsOfFilmsAreRefusedWhereATableIsJudged) {
  const std::string models = WISP_SOURCE_DIR "/tests/c/models/";
  for (const std::string flag : {"--frames 1:100", "--own-gain", "--dark", "--align off"}) {
    for (const std::string& model : {model(), models + "leaf.wisp"}) {
      const Said said = wisp("validate " + model + " " + plain() + " " + flag);
      EXPECT_EQ(said.status, 2) << flag;
      EXPECT_THAT(said.err, HasSubstr("is for models of outlines, which this model is not")) << flag;
    }
  }
  EXPECT_THAT(wisp("validate " + model() + " " + plain() + " --clip c.mp4").err, HasSubstr("--clip draws nothing"));
  EXPECT_THAT(wisp("validate " + models + "flame.wisp " + plain() + " --frames 1:100").err,
              HasSubstr("--frames is of a clip"));
}

TEST_F(Tables, PredictWritesPredictionsAndTheirIntervals) {
  const std::string m = model();
  ASSERT_EQ(wisp("predict " + m + " " + plain() + " -o " + at("one.csv")).status, 0);
  const Recording one = recording("one.csv");
  const auto &u = samples(one, "u"), &y = samples(one, "y"), &said = samples(one, "y.predicted");
  ASSERT_EQ(one.rows(), 400u);
  EXPECT_TRUE(std::isnan(said[0]));
  int inside = 0;
  for (std::size_t t = 1; t < 400; ++t) {
    // The model is the truth but for what 400 noisy rows leave open.
    ASSERT_NEAR(said[t], 0.8 * y[t - 1] + 0.5 * u[t - 1], 0.03) << t;
    inside += samples(one, "y.low")[t] <= y[t] && y[t] <= samples(one, "y.high")[t];
  }
  // Uniform noise never leaves 1.96 of its standard deviations.
  EXPECT_GE(inside, 395);
  ASSERT_EQ(wisp("predict " + m + " " + at("plain.csv") + " --steps inf --initial zero -o " + at("free.csv")).status,
            0);
  const Recording free = recording("free.csv");
  const auto width = [&](std::size_t t) { return samples(free, "y.high")[t] - samples(free, "y.low")[t]; };
  EXPECT_NEAR(width(0), samples(one, "y.high")[9] - samples(one, "y.low")[9], 1e-9);
  EXPECT_GT(width(30), 1.5 * width(0));
  EXPECT_NEAR(width(300), width(399), 1e-9);
}

TEST_F(Tables, PredictOfASwitchedModelHasNoIntervals) {
  ASSERT_EQ(wisp("learn switched " + plain() + " --inputs u --outputs y --rate 10 --modes 2 -o " + at("s.wisp")).status,
            0);
  ASSERT_EQ(wisp("predict " + at("s.wisp") + " " + plain() + " --steps 2 -o " + at("two.csv")).status, 0);
  const Recording two = recording("two.csv");
  EXPECT_TRUE(find_channel(two, "y.predicted"));
  EXPECT_FALSE(find_channel(two, "y.low"));
  const Said said = wisp("validate " + at("s.wisp") + " " + plain() + " --initial zero");
  EXPECT_EQ(said.status, 2);
  EXPECT_THAT(said.err, HasSubstr("--initial is for single models"));
}

TEST_F(Tables, CompareHoldsModelsAgainstTheSameRows) {
  const std::string first = model(1), third = model(3);
  const Said said =
      wisp("compare " + plain() + " " + first + " " + third + " --steps 1,inf --json -o " + at("compared.png"));
  ASSERT_EQ(said.status, 0) << said.err;
  const auto rows = said.json()["compared"];
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0]["model"], "m1");
  EXPECT_EQ(rows[1]["model"], "m3");
  for (const auto& row : rows) {
    EXPECT_EQ(row["output"], "y");
    EXPECT_EQ(row["rows"]["1"], 397);
    EXPECT_GT(row["fit_percent"]["1"], 80);
    EXPECT_LE(row["fit_percent"]["inf"], row["fit_percent"]["1"]);
  }
  EXPECT_TRUE(std::filesystem::exists(at("compared.png")));
}

TEST_F(Tables, RunGoesAlongAPlainTable) {
  const std::string m = model();
  write("pushes.txt", "time push\n", [](std::ostream& out, int t, double u, double) { out << t << ' ' << u << '\n'; });
  ASSERT_EQ(wisp("run " + m + " --noise off --input " + at("pushes.txt") + " --inputs push -o " + at("ran.csv")).status,
            0);
  const Recording ran = recording("ran.csv");
  EXPECT_EQ(ran.rows(), 400u);
  ASSERT_EQ(wisp("run " + m + " --noise off --input " + plain() + " -o " + at("same.csv")).status, 0);
  EXPECT_EQ(samples(recording("same.csv"), "y"), samples(ran, "y"));
  EXPECT_THAT(wisp("run " + m + " --input " + plain() + " --rate 1e-12 -o " + at("x.csv")).err,
              HasSubstr("1e-12 samples a second, expected 1e-6 to 1e7"));
}

// An amplifier settles: the light of the trace is right from its ninth sample on.
TEST_F(Tables, ATracesStartUpIsLeftOutAndSaid) {
  for (const bool gap : {false, true}) {
    std::ofstream out(at("trace.csv"));
    out << "light,volts\n";
    for (int t = 0; t < 1000; ++t) {
      const double settled = t < 8 ? 0.05 + 0.1 * t : 1;
      if (!gap || t != 500) out << settled * (1 + 0.05 * std::sin(0.9 * t));
      out << ",1\n";
    }
    out.close();
    const Said said =
        wisp("capture brightness " + at("trace.csv") + " --channel light --rate 100 -o " + at("light.csv"));
    EXPECT_EQ(said.status, 0) << said.err;
    EXPECT_THAT(said.err, HasSubstr("left out its first 8 samples")) << gap;
    const std::vector<double> light = samples(recording("light.csv"), "brightness");
    EXPECT_TRUE(std::isnan(light[7])) << gap;
    EXPECT_NEAR(light[8], 1, 0.06) << gap;
  }
}

}  // namespace
}  // namespace wisp::tables_test
