// `wisp simulate candle`, and a flame that is learned from its sound.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cli/program.hpp"
#include "wisp/record/csv.hpp"

namespace wisp::simulate_test {
namespace {

using testing::HasSubstr;
namespace fs = std::filesystem;

class Simulate : public InFolder {};

TEST_F(Simulate, AClipComesWithSoundAndItsTruth) {
  const Said said = wisp("simulate candle -o " + at("clip.mp4") + " --seconds 3 --seed 4 --json");
  ASSERT_EQ(said.status, 0) << said.err;
  EXPECT_EQ(said.json()["frames"], 180);
  const auto truth = read_csv(at("clip.truth.csv"));
  ASSERT_TRUE(truth) << truth.error().message;
  EXPECT_EQ(truth->rows(), 180u);
  EXPECT_TRUE(find_channel(*truth, "wind"));

  const Said captured = wisp("capture flame " + at("clip.mp4") + " -o " + at("rec.csv") + " --json");
  ASSERT_EQ(captured.status, 0) << captured.err;
  EXPECT_TRUE(captured.json()["wind"]["heard"]) << captured.out;
  const auto recording = read_csv(at("rec.csv"));
  ASSERT_TRUE(recording);
  EXPECT_EQ(channels_with_role(*recording, Role::kInput).size(), 1u);
}

TEST_F(Simulate, TheSameSeedGivesTheSameTruth) {
  for (const char* name : {"a.mp4", "b.mp4"}) {
    ASSERT_EQ(wisp("simulate candle -o " + at(name) + " --seconds 1 --seed 7").status, 0);
  }
  EXPECT_EQ(file_text(at("a.truth.csv")), file_text(at("b.truth.csv")));
}

TEST_F(Simulate, AWindFromATableBlowsAtTheTablesOwnRate) {
  std::ofstream(at("wind.csv")) << "time[s],u:wind[m/s]\n0,0\n0.5,0.5\n1,1\n1.5,1.5\n";
  for (const char* rate : {"", " --rate 40"}) {
    const Said said = wisp("simulate candle -o " + at("k.mp4") + " --seconds 0.2 --wind " + at("wind.csv") + rate);
    ASSERT_EQ(said.status, 0) << said.err;
    const auto truth = read_csv(at("k.truth.csv"));
    ASSERT_TRUE(truth) << truth.error().message;
    EXPECT_NEAR(truth->channels[*find_channel(*truth, "wind")].samples.back(), 0.2, 0.03) << rate;
  }
}

TEST_F(Simulate, AFlameLearnedFromItsSoundFollowsTheSound) {
  ASSERT_EQ(wisp("simulate candle -o " + at("clip.mp4") + " --seconds 12 --seed 2").status, 0);
  const Said learned = wisp("learn flame " + at("clip.mp4") + " -o " + at("m.wisp") + " --json");
  ASSERT_EQ(learned.status, 0) << learned.err;
  // Twelve seconds are few; without a dynamic answer to the wind the fit would be 0, with the wrong sign below.
  EXPECT_GT(learned.json()["tip"]["held_out_fit_percent"]["inf"].get<double>(), 40) << learned.out;
  EXPECT_EQ(learned.json()["inputs"][0]["name"], "wind");
}

TEST_F(Simulate, WhatCannotBeSimulatedIsExplained) {
  const auto refused = [&](const std::string& arguments, const std::string& word, int status = 1) {
    const Said said = wisp("simulate candle " + arguments);
    EXPECT_EQ(said.status, status) << arguments;
    EXPECT_THAT(said.err, HasSubstr(word));
  };
  refused("-o " + at("clip.avi"), ".mp4", 2);
  refused("-o " + at("nowhere/clip.mp4") + " --seconds 1", "nowhere");
  refused("-o " + at("clip.mp4") + " --seconds 0", "--seconds", 2);
  refused("-o " + at("clip.mp4") + " --seconds 1 --wind none.csv", "none.csv");
  EXPECT_FALSE(fs::exists(at("clip.mp4")));
  EXPECT_FALSE(fs::exists(at("clip.truth.csv")));
}

}  // namespace
}  // namespace wisp::simulate_test
