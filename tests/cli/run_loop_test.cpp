// `wisp run --loop`: a loop whose last frame meets its first.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "cli/program.hpp"
#include "wisp/record/csv.hpp"

namespace wisp::run_loop_test {
namespace {

using testing::HasSubstr;

const std::string kModels = WISP_SOURCE_DIR "/apps/web/public/models/";

class RunLoop : public InFolder {
 protected:
  Said run(const std::string& model, const std::string& flags, const std::string& to) {
    return wisp("run " + kModels + model + ".wisp --loop " + flags + " -o " + at(to) + " --json");
  }
};

// Steps of steps over the seam against the largest elsewhere: 1 where there is no seam to see.
double seam(const std::vector<double>& values) {
  const auto bend = [&](std::size_t t) {
    const std::size_t size = values.size();
    return std::abs(values[(t + 1) % size] - 2 * values[t] + values[(t + size - 1) % size]);
  };
  double elsewhere = 0;
  for (std::size_t t = 1; t + 1 < values.size(); ++t) elsewhere = std::max(elsewhere, bend(t));
  return std::max(bend(0), bend(values.size() - 1)) / elsewhere;
}

TEST_F(RunLoop, OfAFlameMeetsItsBeginAndIsTheSameAgain) {
  const Said said = run("flame", "4 --seed 2", "a.csv");
  ASSERT_EQ(said.status, 0) << said.err;
  EXPECT_EQ(said.json()["frames"], 240);
  const auto recording = read_csv(at("a.csv"));
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_EQ(recording->rows(), 240U);
  for (const Channel& channel : recording->channels) {
    if (channel.role == Role::kOutput && channel.name != "p0.y" && channel.name != "p7.y") {
      EXPECT_LT(seam(channel.samples), 1.2) << channel.name;
    }
  }
  ASSERT_EQ(run("flame", "4 --seed 2", "b.csv").status, 0);
  EXPECT_EQ(file_text(at("a.csv")), file_text(at("b.csv")));
}

TEST_F(RunLoop, OfLeavesAreEpisodesThatLeadOn) {
  const Said said = run("leaf", "3 --instances 2", "a.csv");
  ASSERT_EQ(said.status, 0) << said.err;
  ASSERT_EQ(said.json()["travel"].size(), 2U);
  const auto recording = read_csv(at("a.csv"));
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_EQ(episodes(*recording).size(), 2U);
  EXPECT_LT(said.json()["travel"][0][2].get<double>(), -1);
}

TEST_F(RunLoop, OfAFlameIsAFilmToo) {
  ASSERT_EQ(run("flame-2", "0.5 --instances 2", "a.mp4").status, 0);
  const std::string ffprobe = "ffprobe -v error -count_frames -show_entries stream=nb_read_frames -of csv=p=0 " +
                              at("a.mp4") + " >" + at("frames");
  ASSERT_EQ(std::system(ffprobe.c_str()), 0);
  EXPECT_EQ(std::stoi(file_text(at("frames"))), 30);
}

TEST_F(RunLoop, WhatDoesNotGoWithItIsSaid) {
  const auto refused = [&](const std::string& model, const std::string& flags, const std::string& to, int status,
                           const std::string& words) {
    const Said said = run(model, flags, to);
    EXPECT_EQ(said.status, status) << flags;
    EXPECT_THAT(said.err, HasSubstr(words)) << flags;
    EXPECT_FALSE(std::filesystem::exists(at(to))) << flags;
  };
  refused("flame-4", "2 --frames 10", "a.csv", 2, "--frames does not go with --loop");
  refused("leaf", "2 --steer 0,0,-1@1", "a.csv", 2, "--steer does not go with --loop");
  refused("flame-4", "0", "a.csv", 1, "expected above 0");
  refused("flame-4", "0.02", "a.csv", 1, "a single frame");
  refused("flame-4", "2 --wind 9", "a.csv", 1, "goes out");
  refused("leaf", "2", "a.mp4", 1, "only a loop of an outline is a film");
  refused("flame-4", "2", "a.png", 1, "expected a name that ends in .csv or .mp4");
}

}  // namespace
}  // namespace wisp::run_loop_test
