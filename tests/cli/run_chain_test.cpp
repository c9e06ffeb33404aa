// `wisp run` of a segment chain: how it is to walk, and where to.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cli/program.hpp"
#include "model/sample_chain.hpp"
#include "model/sample_model.hpp"
#include "wisp/model/file.hpp"
#include "wisp/record/csv.hpp"

namespace wisp::run_chain_test {
namespace {

using testing::HasSubstr;

class RunChain : public InFolder {
 protected:
  RunChain() {
    EXPECT_TRUE(write_model(at("leaf.wisp"), steered_chain()));
    EXPECT_TRUE(write_model(at("old.wisp"), sample_chain()));
    EXPECT_TRUE(write_model(at("flame.wisp"), sample_model()));
  }

  Said run(const std::string& flags, const std::string& model = "leaf.wisp") {
    return wisp("run " + at(model) + " --frames 300 -o " + at("out.csv") + " --json " + flags);
  }

  // What is said of flags that are bad, or bad for that model.
  std::string refused(const std::string& flags, const std::string& model = "leaf.wisp", int status = 2) {
    const Said said = run(flags, model);
    EXPECT_EQ(said.status, status) << flags;
    EXPECT_FALSE(std::filesystem::exists(at("out.csv"))) << flags;
    return said.err;
  }
};

TEST_F(RunChain, WalksAsItIsTold) {
  ASSERT_EQ(run("").status, 0);
  const std::string plain = file_text(at("out.csv"));
  EXPECT_EQ(run("--steer 1,-0.5,-0.4@0.5").status, 0);
  EXPECT_NE(file_text(at("out.csv")), plain);
}

TEST_F(RunChain, SeveralInstancesAreEpisodesOfOneRecording) {
  ASSERT_EQ(run("--instances 3").status, 0);
  const auto recording = read_csv(at("out.csv"));
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_TRUE(find_channel(*recording, "pos.x"));
  EXPECT_EQ(recording->rows(), 900U);
  EXPECT_EQ(episodes(*recording).size(), 3U);
}

TEST_F(RunChain, WarnsOfATargetThatIsOutOfReach) {
  EXPECT_THAT(run("--steer 50,0,-1@1").err, HasSubstr("the target lies out of reach"));
  EXPECT_THAT(run("--steer 0.1,0,-0.75@1").err, testing::Not(HasSubstr("out of reach")));
}

TEST_F(RunChain, WarnsOfWindBeyondWhatWasLearned) {
  ASSERT_TRUE(write_model(at("windy.wisp"), windy_chain()));
  EXPECT_THAT(run("--wind 4", "windy.wisp").err, HasSubstr("wind.x reaches 4 m/s, and the model was learned up to 3"));
  EXPECT_THAT(run("--wind 2", "windy.wisp").err, testing::Not(HasSubstr("learned up to")));
}

TEST_F(RunChain, RefusesWhatItCannotDo) {
  for (const char* target : {"1,2@3", "1,2,3", "1,2,3@0", "1,2,3@-4", "a,b,c@d", "1,2,3@4x", "1e9,2,3@4"}) {
    EXPECT_THAT(refused("--steer " + std::string(target)), HasSubstr("expected X,Y,Z@S")) << target;
  }
  EXPECT_THAT(refused("--steer 1,2,3@4", "old.wisp", 1),
              HasSubstr("can't be steered: it does not say where its segments lead"));
  EXPECT_THAT(refused("--steer 1,2,3@4", "flame.wisp"), HasSubstr("is for segment chains"));
}

TEST_F(RunChain, ARealisationThatIsNoneIsAnError) {
  EXPECT_EQ(wisp("learn leaf drops.csv -o " + at("m.wisp") + " --realisation fourier").status, 2);
}

}  // namespace
}  // namespace wisp::run_chain_test
