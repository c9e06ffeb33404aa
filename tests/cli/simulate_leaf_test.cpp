// `wisp simulate leaf`.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include "cli/program.hpp"
#include "wisp/capture/media/video.hpp"
#include "wisp/record/csv.hpp"

namespace wisp::simulate_leaf_test {
namespace {

using testing::HasSubstr;
namespace fs = std::filesystem;

class SimulateLeaf : public InFolder {
 protected:
  Said wisp(const std::string& arguments) { return InFolder::wisp("simulate leaf " + arguments); }
};

TEST_F(SimulateLeaf, DropsAreEpisodesOfARecording) {
  const Said said = wisp("-o " + at("rec.csv") + " --drops 3 --seconds 2 --rate 30 --json");
  ASSERT_EQ(said.status, 0) << said.err;
  EXPECT_EQ(said.json()["episodes"], 3);
  const auto recording = read_csv(at("rec.csv"));
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_EQ(episodes(*recording).size(), 3u);
  EXPECT_EQ(recording->rows(), 180u);
  EXPECT_EQ(channels_with_role(*recording, Role::kOutput).size(), 7u);
}

TEST_F(SimulateLeaf, TheSameSeedGivesTheSameFile) {
  ASSERT_EQ(wisp("-o " + at("a.csv") + " --drops 4 --seconds 1 --wind gusts --seed 7").status, 0);
  ASSERT_EQ(wisp("-o " + at("b.csv") + " --drops 4 --seconds 1 --wind gusts --seed 7").status, 0);
  ASSERT_EQ(wisp("-o " + at("c.csv") + " --drops 4 --seconds 1 --wind gusts --seed 8").status, 0);
  EXPECT_EQ(file_text(at("a.csv")), file_text(at("b.csv")));
  EXPECT_NE(file_text(at("a.csv")), file_text(at("c.csv")));
}

TEST_F(SimulateLeaf, PairsAreTwoRecordingsThatDifferInTheirWind) {
  const Said said = wisp("-o " + at("rec.csv") + " --pairs --drops 2 --seconds 1 --json");
  ASSERT_EQ(said.status, 0) << said.err;
  EXPECT_EQ(said.json()["calm"], at("rec.calm.csv"));
  const auto windy = read_csv(at("rec.csv")), calm = read_csv(at("rec.calm.csv"));
  ASSERT_TRUE(windy && calm);
  EXPECT_EQ(episodes(*windy).size(), 64u);
  EXPECT_EQ(find_attribute(*windy, "pair"), find_attribute(*calm, "pair"));
  EXPECT_TRUE(find_attribute(*windy, "pair"));
}

TEST_F(SimulateLeaf, AWindFromAFileBlowsAsItWasRecorded) {
  std::ofstream(at("wind.csv")) << "# rate_hz 60\nu:wind.x[m/s],u:wind.y[m/s]\n0,0\n0.5,-1\n0.25,0\n0,0\n";
  const std::string fall = "-o " + at("rec.csv") + " --drops 2 --seconds 0.5 --wind ";
  ASSERT_EQ(wisp(fall + at("wind.csv")).status, 0);
  const auto recording = read_csv(at("rec.csv"));
  ASSERT_TRUE(recording);
  EXPECT_NEAR(recording->channels[*find_channel(*recording, "wind.x")].samples[1], 0.5, 1e-9);
  EXPECT_NEAR(recording->channels[*find_channel(*recording, "wind.y")].samples[31], -1, 1e-9);
  std::ofstream(at("bad.csv")) << "# rate_hz 60\nu:wind.x[m/s]\n0\n\n99\n";
  EXPECT_THAT(wisp(fall + at("bad.csv")).err, HasSubstr("wind.x in row"));
  EXPECT_THAT(wisp(fall + "breeze").err, HasSubstr("expected calm, gusts"));
  EXPECT_THAT(wisp(fall + at("wind.csv") + " --pairs").err, HasSubstr("--pairs makes gusts of its own"));
}

TEST_F(SimulateLeaf, TheFirstDropsAreFilmed) {
  const Said said = wisp("-o " + at("rec.csv") + " --drops 2 --seconds 0.2 --video " + at("clip.mp4"));
  ASSERT_EQ(said.status, 0) << said.err;
  EXPECT_GT(fs::file_size(at("clip.mp4")), 1000u);
}

// Pictures of a clip that are the same as the one before, byte for byte.
int frozen_frames(const std::string& path) {
  auto clip = VideoReader::open(path);
  EXPECT_TRUE(clip) << clip.error().message;
  int frozen = 0;
  RgbImage before;
  for (auto frame = clip->next(); frame && *frame; frame = clip->next()) {
    RgbImage now = clip->rgb();
    frozen += now.pixels == before.pixels ? 1 : 0;
    before = std::move(now);
  }
  return frozen;
}

TEST_F(SimulateLeaf, NoFrameOfAFilmRepeatsTheOneBefore) {
  // Row 123 is at 123 / 60 s, which times 60 is less than 123.
  ASSERT_EQ(wisp("-o " + at("rec.csv") + " --drops 1 --seconds 4.2 --video " + at("clip.mp4")).status, 0);
  EXPECT_EQ(frozen_frames(at("clip.mp4")), 0);
}

TEST_F(SimulateLeaf, AStrongSteadyWindIsSimulated) {
  std::ofstream(at("wind.csv")) << "# rate_hz 60\nu:wind[m/s]\n3\n";
  const Said said = wisp("-o " + at("rec.csv") + " --drops 4 --seconds 2 --wind " + at("wind.csv"));
  ASSERT_EQ(said.status, 0) << said.err;
  const auto recording = read_csv(at("rec.csv"));
  ASSERT_TRUE(recording);
  const auto& x = recording->channels[*find_channel(*recording, "pos.x")].samples;
  EXPECT_NEAR(x[119], 6, 2);
}

TEST_F(SimulateLeaf, ItsFallsTeachAChainWhoseOwnFallsAreFilmed) {
  ASSERT_EQ(wisp("-o " + at("rec.csv") + " --drops 12 --seconds 6").status, 0);
  const Said learned = InFolder::wisp("learn leaf " + at("rec.csv") + " -o " + at("leaf.wisp") + " --json");
  ASSERT_EQ(learned.status, 0) << learned.err;
  EXPECT_EQ(learned.json()["modes"], 1);
  EXPECT_GT(learned.json()["segments"], 100);
  const std::string run = "run " + at("leaf.wisp") + " --frames 40 --instances 2 -o ";
  ASSERT_EQ(InFolder::wisp(run + at("falls.csv")).status, 0);
  const auto falls = read_csv(at("falls.csv"));
  ASSERT_TRUE(falls) << falls.error().message;
  EXPECT_EQ(channels_with_role(*falls, Role::kOutput).size(), 7u);
  EXPECT_EQ(episodes(*falls).size(), 2u);
  const Said filmed = InFolder::wisp(run + at("falls.mp4"));
  ASSERT_EQ(filmed.status, 0) << filmed.err;
  EXPECT_GT(fs::file_size(at("falls.mp4")), 1000u);
}

// The most that a child of this process has had in memory at once, kB.
long peak_of_children() {
  rusage used{};
  ::getrusage(RUSAGE_CHILDREN, &used);
  return used.ru_maxrss;
}

TEST_F(SimulateLeaf, MemoryOfLearningGrowsWithTheFallsAndNotWithTheirSquare) {
  // 110 MB of 60 falls; 912 MB where the lists of candidates for a join kept room for all segments.
  ASSERT_EQ(wisp("-o " + at("rec.csv") + " --drops 60").status, 0);
  ASSERT_EQ(InFolder::wisp("learn leaf " + at("rec.csv") + " -o " + at("leaf.wisp")).status, 0);
  EXPECT_LT(peak_of_children(), 600'000);
}

TEST_F(SimulateLeaf, OnlyTheRowsOfARangeAreLearnedFrom) {
  ASSERT_EQ(wisp("-o " + at("rec.csv") + " --drops 12 --seconds 6").status, 0);
  const std::string learn = "learn leaf " + at("rec.csv") + " --json -o " + at("leaf.wisp");
  const Said all = InFolder::wisp(learn), part = InFolder::wisp(learn + " --range 1:2160");
  ASSERT_EQ(part.status, 0) << part.err;
  EXPECT_LT(part.json()["segments"].get<int>(), 0.6 * all.json()["segments"].get<int>());
  EXPECT_THAT(InFolder::wisp(learn + " --range 1:4321").err, HasSubstr("--range 1:4321 reaches beyond its 4320 rows"));
}

TEST_F(SimulateLeaf, ItsFallsTeachSplinesThatAreSteered) {
  ASSERT_EQ(wisp("-o " + at("rec.csv") + " --drops 12 --seconds 9").status, 0);
  const Said learned =
      InFolder::wisp("learn leaf " + at("rec.csv") + " --modes 3 --realisation spline -o " + at("spline.wisp"));
  ASSERT_EQ(learned.status, 0) << learned.err;
  EXPECT_EQ(InFolder::wisp("run " + at("spline.wisp") + " --frames 40 --steer 0,0,-0.5@1 -o " + at("fall.csv")).status,
            0);
}

TEST_F(SimulateLeaf, WhatCannotBeSimulatedIsExplained) {
  const auto refused = [&](const std::string& arguments, const std::string& words, int status) {
    const Said said = wisp("-o " + at("rec.csv") + " " + arguments);
    EXPECT_EQ(said.status, status) << arguments;
    EXPECT_THAT(said.err, HasSubstr(words));
  };
  refused("--drops 0", "--drops: found \"0\", expected 1 to 100000", 2);
  refused("--seconds -2", "--seconds: found \"-2\", expected 0.1 to 3600", 2);
  refused("--rate 0", "--rate", 2);
  refused("--wind hurricane", "--wind", 2);
  refused("--drops 100000 --seconds 3600", "too many", 1);
  refused("--drops 1 --seconds 0.2 --video " + at("nowhere/clip.mp4"), "nowhere", 1);
  refused("--drops 1 --seconds 0.2 --video " + at("clip.gif"), "expected a name that ends in .mp4", 1);
  refused("--pairs --drops 2 --seconds 0.3", "--seconds is 0.3, expected at least 0.7 with --pairs", 2);
  EXPECT_FALSE(fs::exists(at("rec.csv")));
  EXPECT_EQ(wisp("-o " + at("nowhere/rec.csv")).status, 1);
  EXPECT_EQ(wisp("-o /proc/rec.csv").status, 1);
  EXPECT_EQ(wisp("-o " + at("rec.txt")).status, 1);
}

TEST_F(SimulateLeaf, AWindFileThatIsNoneIsExplained) {
  const struct {
    const char* text;
    const char* words;
  } files[] = {
      {"", "is empty, expected a header line"},
      {"# rate_hz 60\nu:wind.x\n", "has a header but no rows"},
      {"u:wind.x\n1\n", "states no rate"},
      {"# rate_hz 0\nu:wind.x\n1\n", "row 1: rate_hz is \"0\""},
      {"# rate_hz 60\nu:wind.x\n1\ngale\n", "row 4: found \"gale\", column 1, expected a number"},
      {"# rate_hz 60\nu:wind.x,u:wind.y\n1,2\n3\n", "row 4: has 1 columns, the header has 2"},
      {"# rate_hz 60\nu:wind.x,u:wind.y\n1,2\n,3\n", "wind.x in row 2 is missing"},
      {"# rate_hz 60\nu:wind.x\n1\n31\n", "wind.x in row 2 is 31, expected a wind within 30 m/s"},
      {"# rate_hz 60\ny:pos.x\n1\n", "has 0 inputs and no wind.x, wind.y or wind.z"},
      {"# rate_hz 60\nu:left,u:right\n1,2\n", "has 2 inputs and no wind.x, wind.y or wind.z"},
      {"# rate_hz 10\nm:t,u:wind.x\n0,1\n0.1,2\n0.05,3\n", "t goes on by -0.05 s in row 3, expected 0.1"},
  };
  for (const auto& file : files) {
    std::ofstream(at("wind.csv")) << file.text;
    const Said said = wisp("-o " + at("rec.csv") + " --drops 1 --seconds 0.2 --wind " + at("wind.csv"));
    EXPECT_EQ(said.status, 1) << file.text;
    EXPECT_THAT(said.err, HasSubstr(at("wind.csv"))) << file.text;
    EXPECT_THAT(said.err, HasSubstr(file.words)) << file.text;
    EXPECT_FALSE(fs::exists(at("rec.csv"))) << file.text;
  }
}

}  // namespace
}  // namespace wisp::simulate_leaf_test
