// A flame that is blown out: learned, given, shown, run and lit again, by the program.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "cli/program.hpp"
#include "learn/flame/made_blow_outs.hpp"
#include "wisp/record/csv.hpp"

namespace wisp::blow_out_test {
namespace {

using nlohmann::json;
using testing::HasSubstr;
namespace fs = std::filesystem;

class BlowOutProgram : public InFolder {
 protected:
  void write_recording(const std::string& name, const made::BlowOutRecipe& recipe) {
    ASSERT_TRUE(write_csv(at(name), made::blow_out_recording(recipe).recording));
  }

  // A wind of `wind` for half a second after one second of calm, in what drives a model.
  void write_puff(double wind) {
    std::ofstream out(at("puff.csv"));
    out << "# wisp-recording 1\n# rate_hz 60\nu:wind\n";
    for (int row = 0; row < 300; ++row) out << (row >= 60 && row < 90 ? wind : 0) << "\n";
  }

  std::vector<std::uint8_t> lit_rows(const std::string& arguments) {
    const Said ran = wisp("run " + at("m.wisp") + " " + arguments + " -o " + at("run.csv"));
    EXPECT_EQ(ran.status, 0) << ran.err;
    const auto recording = read_csv(at("run.csv"));
    EXPECT_TRUE(recording);
    EXPECT_EQ(recording->flags.size(), 1U);
    return recording->flags.at(0).rows;
  }
};

TEST_F(BlowOutProgram, TheRuleIsLearnedWhereTheRecordingHasIt) {
  write_recording("rec.csv", {.rows = 3600, .shortest = 0.2, .seed = 2});
  write_recording("unseen.csv", {.rows = 3600, .shortest = 0.2, .seed = 3});
  const Said learned = wisp("learn flame " + at("rec.csv") + " -o " + at("m.wisp") + " --json");
  ASSERT_EQ(learned.status, 0) << learned.err;
  const json found = learned.json()["extinction"];
  EXPECT_EQ(found["source"], "learned");
  EXPECT_EQ(found["input"], "wind");
  EXPECT_GT(found["agreement"]["deaths"].get<int>(), 4);
  EXPECT_GE(found["agreement"]["died"].get<int>() + 1, found["agreement"]["deaths"].get<int>());
  EXPECT_LE(found["level_range"][0].get<double>(), found["level"].get<double>());
  EXPECT_EQ(wisp("info " + at("m.wisp") + " --json").json()["extinction"]["level"], found["level"]);
  EXPECT_THAT(wisp("info " + at("m.wisp")).out, HasSubstr("Extinction"));
  const json modes = wisp("info " + at("m.wisp") + " --json").json()["extinction"]["modes"];
  ASSERT_EQ(modes.size(), 2U);
  EXPECT_EQ(modes[0]["name"], "dying");
  for (int mode : {0, 1}) {
    EXPECT_EQ(modes[mode]["source"], "recorded");
    EXPECT_GT(modes[mode]["events"].get<int>(), 3);
  }
  EXPECT_LE(modes[0]["seconds"].get<double>(), 0.1);  // it vanishes from one row to the next; dim rows follow
  EXPECT_NEAR(modes[1]["seconds"].get<double>(), 0.75, 0.02);
  EXPECT_THAT(wisp("info " + at("m.wisp")).out, HasSubstr("puts it out in"));

  const Said validated = wisp("validate " + at("m.wisp") + " " + at("unseen.csv") + " --json");
  ASSERT_EQ(validated.status, 0) << validated.err;
  const json judged = validated.json()["extinction"];
  EXPECT_GT(judged["deaths"].get<int>(), 4);
  EXPECT_GE(judged["died"].get<int>() + 1, judged["deaths"].get<int>());
}

TEST_F(BlowOutProgram, TheRuleIsWhatIsGiven) {
  write_recording("rec.csv", {.rows = 1200, .every = 0});
  const Said learned = wisp("learn flame " + at("rec.csv") + " --blow-out 1.5,0.25 -o " + at("m.wisp") + " --json");
  ASSERT_EQ(learned.status, 0) << learned.err;
  EXPECT_EQ(learned.json()["extinction"]["source"], "given");
  EXPECT_EQ(learned.json()["extinction"]["level"], 1.5);
  EXPECT_EQ(learned.json()["extinction"]["seconds"], 0.25);
  EXPECT_EQ(learned.json()["extinction"]["haste"], 0);

  const auto out = lit_rows("--frames 120 --wind 1.6");
  EXPECT_NEAR(static_cast<double>(std::find(out.begin(), out.end(), 0) - out.begin()), 15, 1);
  EXPECT_EQ(std::count(out.begin(), out.end(), 0), 120 - (std::find(out.begin(), out.end(), 0) - out.begin()));
  const auto survived = lit_rows("--frames 600 --wind 1.4");
  EXPECT_EQ(std::count(survived.begin(), survived.end(), 0), 0);
}

TEST_F(BlowOutProgram, WithoutADeathThereIsADefaultAndItCanBeTurnedOff) {
  write_recording("rec.csv", {.rows = 1200, .every = 0});
  const Said learned = wisp("learn flame " + at("rec.csv") + " -o " + at("m.wisp") + " --json");
  ASSERT_EQ(learned.status, 0) << learned.err;
  EXPECT_EQ(learned.json()["extinction"]["source"], "default");
  EXPECT_EQ(learned.json()["extinction"]["modes"][1]["source"], "borrowed from a simulated candle");
  EXPECT_NEAR(learned.json()["extinction"]["modes"][1]["seconds"].get<double>(), 0.7, 0.01);
  EXPECT_GE(learned.json()["extinction"]["level"].get<double>(), 2);
  for (const std::string command : {"learn flame --blow-out off ", "learn outline "}) {
    const Said off = wisp(command + at("rec.csv") + " -o " + at("off.wisp") + " --json");
    ASSERT_EQ(off.status, 0) << off.err;
    EXPECT_TRUE(off.json()["extinction"].is_null());
    EXPECT_TRUE(wisp("info " + at("off.wisp") + " --json").json()["extinction"].is_null());
  }
  EXPECT_EQ(wisp("run " + at("off.wisp") + " --frames 60 --relight 0.5 -o " + at("x.csv")).status, 1);
}

TEST_F(BlowOutProgram, ItStaysOutUntilItIsLitAgain) {
  write_recording("rec.csv", {.rows = 1200, .every = 0});
  ASSERT_EQ(wisp("learn flame " + at("rec.csv") + " --blow-out 1.5,0.2 -o " + at("m.wisp")).status, 0);
  write_puff(20);
  const auto out = lit_rows("--input " + at("puff.csv"));
  ASSERT_EQ(out.size(), 300U);
  EXPECT_EQ(out[59], 1);
  EXPECT_EQ(out[90], 0);
  EXPECT_EQ(out[299], 0);
  const auto relit = lit_rows("--input " + at("puff.csv") + " --relight 4");
  EXPECT_EQ(relit[239], 0);
  EXPECT_EQ(relit[240], 1);
  EXPECT_EQ(relit[299], 1);
  const auto recording = read_csv(at("run.csv"));
  const auto& tip = recording->channels[*find_channel(*recording, "p3.y")].samples;
  EXPECT_EQ(tip[200], 0);
  EXPECT_GT(tip[245], 0);
  EXPECT_LT(tip[245], 0.95 * tip[50]);
  EXPECT_GT(tip[299], 0.6 * tip[50]);
}

TEST_F(BlowOutProgram, PicturesShowItBurningSmokingAndDark) {
  write_recording("rec.csv", {.rows = 1200, .every = 0});
  ASSERT_EQ(wisp("learn flame " + at("rec.csv") + " --blow-out 1.5,0.2 -o " + at("m.wisp")).status, 0);
  write_puff(20);
  const auto picture = [&](int frames) {
    const std::string path = at("frame.png");
    const Said said = wisp("run " + at("m.wisp") + " --input " + at("puff.csv") + " --frames " +
                           std::to_string(frames) + " -o " + path);
    EXPECT_EQ(said.status, 0) << said.err;
    return file_text(path);
  };
  const std::string burning = picture(50), smoking = picture(120), dark = picture(1200);
  EXPECT_NE(burning, smoking);
  EXPECT_NE(smoking, picture(125));  // smoke moves
  EXPECT_NE(smoking, dark);
  EXPECT_EQ(dark, picture(1260));  // what is left does not
}

TEST_F(BlowOutProgram, FramesOfATableAreItsRows) {
  write_recording("rec.csv", {.rows = 1200, .every = 0});
  const auto learned = [&](const std::string& frames) {
    return wisp("learn flame " + at("rec.csv") + " --frames " + frames + " -o " + at("m.wisp") + " --json");
  };
  const Said part = learned("301:900");
  ASSERT_EQ(part.status, 0) << part.err;
  const auto samples = part.json()["samples"];
  EXPECT_EQ(samples["learned"].get<int>() + samples["held_out"].get<int>(), 600);
  const Said beyond = learned("301:1201");
  EXPECT_EQ(beyond.status, 1);
  EXPECT_THAT(beyond.err, testing::HasSubstr("--frames 301:1201 reaches beyond its 1200 rows"));
}

TEST_F(BlowOutProgram, FlagsOfFilmsAreRefusedBesideATable) {
  write_recording("rec.csv", {.rows = 1200, .every = 0});
  const std::string learn = "learn flame " + at("rec.csv") + " -o " + at("m.wisp");
  ASSERT_EQ(wisp(learn).status, 0);
  const std::string validate = "validate " + at("m.wisp") + " " + at("rec.csv");
  for (const std::string flag : {"--channel red", "--region 0,0,50,50", "--dark", "--flame 1", "--wind-measure rms"}) {
    for (const std::string& command : {learn, validate}) {
      const Said said = wisp(command + " " + flag);
      EXPECT_EQ(said.status, 2) << command << flag;
      EXPECT_THAT(said.err, HasSubstr(flag.substr(0, flag.find(' ')) + " is of a clip")) << command;
    }
  }
  EXPECT_THAT(wisp(learn + " --points 8").err, HasSubstr("--points is of a clip"));
}

TEST_F(BlowOutProgram, WhatCannotBeARuleIsWrongUsage) {
  write_recording("rec.csv", {.rows = 1200, .every = 0});
  for (const std::string value : {"hard", "1.5", "1.5,", ",2", "1.5,0.2,3", "-1,0.2", "1,0", "nan,1"}) {
    const Said said = wisp("learn flame " + at("rec.csv") + " --blow-out=" + value + " -o " + at("x.wisp"));
    EXPECT_EQ(said.status, 2) << value;
    EXPECT_THAT(said.err, HasSubstr("--blow-out")) << value;
    EXPECT_FALSE(fs::exists(at("x.wisp"))) << value;
  }
  ASSERT_EQ(wisp("learn flame " + at("rec.csv") + " -o " + at("m.wisp")).status, 0);
  for (const std::string value : {"soon", "-1", "1,x", "nan"}) {
    EXPECT_EQ(wisp("run " + at("m.wisp") + " --frames 9 --relight=" + value + " -o " + at("x.csv")).status, 2) << value;
  }
}

TEST_F(BlowOutProgram, AFilmedFlameThatIsBlownOutAndLitAgainIsLearnedFromBothSides) {
  ASSERT_EQ(wisp("simulate candle -o " + at("clip.mp4") + " --seconds 11 --blow-out 5 --seed 3").status, 0);
  const Said learned = wisp("learn flame " + at("clip.mp4") + " -o " + at("m.wisp") + " --json");
  ASSERT_EQ(learned.status, 0) << learned.err;
  const json found = learned.json()["extinction"];
  EXPECT_EQ(found["source"], "learned") << learned.err;
  EXPECT_EQ(found["agreement"]["deaths"], 1);
  EXPECT_EQ(found["agreement"]["died"], 1);
  EXPECT_LT(found["agreement"]["median_off_ms"].get<double>(), 100);
  // Of 660 frames it burns undisturbed in about 6.4 and 2.5 seconds' worth.
  EXPECT_GT(learned.json()["samples"]["learned"].get<int>() + learned.json()["samples"]["held_out"].get<int>(), 400);
}

}  // namespace
}  // namespace wisp::blow_out_test
