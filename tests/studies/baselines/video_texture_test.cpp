// A video texture goes on only where the motion goes on.

#include "studies/baselines/video_texture.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace wisp::baselines::video_texture_test {
namespace {

constexpr int kTurn = 40;  // frames a turn

// So strict that a jump by one frame too many has a probability of e^-25.
constexpr VideoTextureOptions kStrict{.jumps = 20, .looseness = 0.005};

// A point that goes around a circle with the wind's sense of turning, so that every place is passed in two directions.
Frames turning(int frames, int sense, double wind) {
  Frames out{Eigen::MatrixXd(frames, 2), Eigen::VectorXd::Constant(frames, wind)};
  for (int t = 0; t < frames; ++t) {
    const double angle = 2 * std::numbers::pi * sense * t / kTurn;
    out.outputs.row(t) << std::cos(angle), std::sin(angle);
  }
  return out;
}

double angle_between(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  return std::atan2(a[0] * b[1] - a[1] * b[0], a.dot(b));
}

TEST(VideoTexture, JumpsOnlyToWhereTheMotionGoesOn) {
  const std::vector<Frames> frames{turning(100, 1, 0), turning(100, 1, 0)};
  const VideoTexture texture = learn_video_texture(frames, kStrict);
  VideoTexturePlayer player(texture, 1, true);
  Eigen::VectorXd before = player.step(0);
  int jumps = 0;
  std::size_t frame = player.frame();
  for (int step = 0; step < 5000; ++step) {
    const Eigen::VectorXd now = player.step(0);
    ASSERT_NEAR(angle_between(before, now), 2 * std::numbers::pi / kTurn, 1e-6) << "at step " << step;
    jumps += player.frame() != frame + 1 ? 1 : 0;
    frame = player.frame();
    before = now;
  }
  EXPECT_GT(jumps, 50) << "it plays on for longer than what was recorded";
}

TEST(VideoTexture, DoesNotTurnBackWhereAFrameLooksAlikeButMovesTheOtherWay) {
  const std::vector<Frames> frames{turning(200, 1, 0), turning(200, -1, 0)};
  const VideoTexture texture = learn_video_texture(frames, kStrict);
  VideoTexturePlayer player(texture, 3, true);
  Eigen::VectorXd before = player.step(0);
  for (int step = 0; step < 2000; ++step) {
    const Eigen::VectorXd now = player.step(0);
    ASSERT_GT(angle_between(before, now), -1e-6) << "at step " << step;
    before = now;
  }
}

TEST(VideoTexture, NeverReachesADeadEnd) {
  const std::vector<Frames> frames{turning(60, 1, 0)};
  const VideoTexture texture = learn_video_texture(frames, kStrict);
  VideoTexturePlayer player(texture, 2, true);
  for (int step = 0; step < 3000; ++step) {
    (void)player.step(0);
    ASSERT_FALSE(texture.jumps[player.frame()].empty());
  }
}

TEST(VideoTexture, SteeredGoesWhereTheWindIsAsItIsNow) {
  // The same motion in two winds.
  const std::vector<Frames> frames{turning(200, 1, 0), turning(200, 1, 1)};
  const VideoTexture texture = learn_video_texture(frames, {.looseness = 0.05, .steering = 20});
  VideoTexturePlayer player(texture, 1, false);
  for (double wind : {1.0, 0.0, 1.0}) {
    for (int step = 0; step < kTurn; ++step) (void)player.step(wind);
    EXPECT_EQ(texture.wind[static_cast<Eigen::Index>(player.frame())], wind);
  }
}

}  // namespace
}  // namespace wisp::baselines::video_texture_test
