// `wisp run` of a flame in the round: where the wind blows, and from where it is seen.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "cli/program.hpp"
#include "paths.hpp"
#include "wisp/record/csv.hpp"

namespace wisp::run_round_test {
namespace {

using testing::HasSubstr;

const std::string kModels = std::string(WISP_SOURCE_DIR) + "/apps/web/public/models/";

class RunRound : public InFolder {
 protected:
  Said run(const std::string& flags, const std::string& to = "out.csv", const std::string& model = "flame.wisp") {
    return wisp("run " + kModels + model + " --frames 60 --noise off -o " + at(to) + " --json " + flags);
  }

  double last(const std::string& name) {
    const auto recording = read_csv(at("out.csv"));
    EXPECT_TRUE(recording) << recording.error().message;
    return recording->channels[find_channel(*recording, name).value()].samples.back();
  }
};

TEST_F(RunRound, TheWindBlowsToTheRightOfTheCameraThatIsNamed) {
  ASSERT_EQ(run("--camera 0 --wind 0").status, 0);
  const double calm = last("p3.x");
  ASSERT_EQ(run("--camera 0 --wind 0.6").status, 0);
  EXPECT_NEAR(last("wind.x"), 0.6, 1e-6);
  EXPECT_NEAR(last("wind.z"), 0, 1e-6);
  EXPECT_GT(last("p3.x"), calm + 0.2);
  // A quarter round, anticlockwise from above, the right is away from the first camera: it leans in depth alone.
  ASSERT_EQ(run("--camera 0 --wind 0.6 --wind-direction 90").status, 0);
  EXPECT_NEAR(last("wind.x"), 0, 1e-6);
  EXPECT_NEAR(last("wind.z"), -0.6, 1e-6);
  EXPECT_NEAR(last("p3.x"), calm, 0.02);
}

TEST_F(RunRound, ACameraAndAnOrbitSeeItFromElsewhere) {
  std::string before;
  for (const char* flags : {"--camera 0", "--camera 90", "--camera 0,40", "--orbit 2", "--orbit 3"}) {
    ASSERT_EQ(run(std::string(flags) + " --wind 0.6", "a.png").status, 0) << flags;
    const std::string picture = file_text(at("a.png"));
    EXPECT_NE(picture, before) << flags;
    before = picture;
  }
}

TEST_F(RunRound, RefusesWhatIsNoCameraAndWhatIsNoBody) {
  for (const char* camera : {"45,95", "45:20", "north", "45,20,1"}) {
    const Said said = run("--camera " + std::string(camera));
    EXPECT_NE(said.status, 0) << camera;
    EXPECT_THAT(said.err, HasSubstr("--camera"));
  }
  const Said leaf = run("--camera 45", "out.csv", "leaf.wisp");
  EXPECT_NE(leaf.status, 0);
  EXPECT_THAT(leaf.err, HasSubstr("about the vertical"));
}

}  // namespace
}  // namespace wisp::run_round_test
