#include "learn/chain/motion/motion.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "learn/chain/made_falls.hpp"

namespace wisp::chain::motion_test {
namespace {

using testing::HasSubstr;

Result<Motion> motion_of_one(const Recording& recording, int smooth = 0) {
  return motion_of(std::span(&recording, 1), smooth);
}

TEST(Motion, RatesAreDerivatives) {
  Recording recording = made_falls({.falls = 1, .seconds = 1, .rate_hz = 100});
  for (std::size_t row = 0; row < recording.rows(); ++row) {
    const double t = static_cast<double>(row) / 100;
    recording.channels[0].samples[row] = std::sin(3 * t);
    recording.channels[1].samples[row] = t * t;
    recording.channels[2].samples[row] = -2 * t;
    // Turning about z at 1.5 radians a second.
    recording.channels[3].samples[row] = std::cos(0.75 * t);
    recording.channels[4].samples[row] = recording.channels[5].samples[row] = 0;
    recording.channels[6].samples[row] = std::sin(0.75 * t);
  }
  const auto motion = motion_of_one(recording);
  ASSERT_TRUE(motion) << motion.error().message;
  const MotionPiece& piece = motion->pieces.at(0);
  for (std::size_t row : {0U, 1U, 50U, 99U}) {
    const double t = static_cast<double>(row) / 100;
    // Second order at the ends: error below h²/3 times the third derivative, 27.
    EXPECT_NEAR(piece.velocity[row][0], 3 * std::cos(3 * t), 1e-3);
    EXPECT_NEAR(piece.velocity[row][1], 2 * t, 1e-9);
    EXPECT_NEAR(piece.velocity[row][2], -2, 1e-9);
    EXPECT_NEAR(piece.spin[row][2], 1.5, 1e-3);
  }
}

TEST(Motion, SmoothedVelocityOfAParabolaIsExact) {
  Recording recording = made_falls({.falls = 1, .seconds = 1, .orientation = false});
  for (std::size_t row = 0; row < recording.rows(); ++row) {
    recording.channels[2].samples[row] = 0.5 * static_cast<double>(row * row);
  }
  const auto motion = motion_of_one(recording, 7);
  ASSERT_TRUE(motion);
  for (std::size_t row = 0; row < recording.rows(); ++row) {
    EXPECT_NEAR(motion->pieces[0].velocity[row][2], 60 * static_cast<double>(row), 1e-6) << row;
  }
}

TEST(Motion, FlippedSignsOfQuaternionsAreUndone) {
  const Recording whole = made_falls({.falls = 1});
  Recording flipped = whole;
  for (std::size_t row = 100; row < 150; ++row) {
    for (std::size_t k = 3; k < 7; ++k) flipped.channels[k].samples[row] *= -1;
  }
  const auto a = motion_of_one(whole), b = motion_of_one(flipped);
  ASSERT_TRUE(a && b);
  EXPECT_EQ(a->pieces[0].orientation, b->pieces[0].orientation);
  EXPECT_TRUE(b->warnings.empty());
}

TEST(Motion, QuaternionsNearlyUnitAreMadeSoWithAWarning) {
  Recording recording = made_falls({.falls = 1});
  for (std::size_t k = 3; k < 7; ++k) recording.channels[k].samples[42] *= 1.008;
  const auto motion = motion_of_one(recording);
  ASSERT_TRUE(motion) << motion.error().message;
  ASSERT_EQ(motion->warnings.size(), 1U);
  EXPECT_THAT(motion->warnings[0], HasSubstr("0.008"));
  const Quad& q = motion->pieces[0].orientation[42];
  EXPECT_NEAR(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3], 1, 1e-12);
}

TEST(Motion, QuaternionsFarFromUnitAreAnErrorThatNamesTheRow) {
  Recording recording = made_falls({.falls = 1});
  for (std::size_t k = 3; k < 7; ++k) recording.channels[k].samples[42] *= 1.02;
  const auto motion = motion_of_one(recording);
  ASSERT_FALSE(motion);
  EXPECT_THAT(motion.error().message, HasSubstr("made.csv: row 43"));
  EXPECT_THAT(motion.error().message, HasSubstr("1.02"));
}

TEST(Motion, TimeThatDoesNotGoOnEvenlyIsAnError) {
  Recording recording = made_falls({.falls = 2});
  Channel time{"t", "s", Role::kMotion, {}};
  for (std::size_t row = 0; row < recording.rows(); ++row) {
    time.samples.push_back(static_cast<double>(row % 360) / 60);
  }
  recording.channels.push_back(time);
  EXPECT_TRUE(motion_of_one(recording));
  recording.channels.back().samples[10] += 0.004;
  const auto motion = motion_of_one(recording);
  ASSERT_FALSE(motion);
  EXPECT_THAT(motion.error().message, HasSubstr("row 11"));
}

TEST(Motion, AMissingTimeIsNoError) {
  Recording recording = made_falls({.falls = 1});
  Channel time{"t", "s", Role::kMotion, {}};
  for (std::size_t row = 0; row < recording.rows(); ++row) time.samples.push_back(static_cast<double>(row) / 60);
  time.samples[0] = time.samples[20] = std::nan("");
  recording.channels.push_back(time);
  EXPECT_TRUE(motion_of_one(recording));
  recording.channels.back().samples[21] += 1;
  EXPECT_FALSE(motion_of_one(recording));
}

TEST(Motion, MissingSamplesCutTheMotion) {
  Recording recording = made_falls({.falls = 1});
  recording.channels[1].samples[100] = std::numeric_limits<double>::quiet_NaN();
  recording.channels[4].samples[104] = std::numeric_limits<double>::quiet_NaN();
  const auto motion = motion_of_one(recording);
  ASSERT_TRUE(motion);
  ASSERT_EQ(motion->pieces.size(), 2U);  // what lies between is too short
  EXPECT_EQ(motion->pieces[0].rows(), 100U);
  EXPECT_EQ(motion->pieces[1].first_row, 105U);
}

TEST(Motion, WhatHasNoPositionOrHalfAnOrientationIsAnError) {
  Recording recording = made_falls({.falls = 1});
  recording.channels.erase(recording.channels.begin() + 2);
  EXPECT_THAT(motion_of_one(recording).error().message, HasSubstr("pos.z"));
  recording = made_falls({.falls = 1});
  recording.channels.pop_back();
  EXPECT_THAT(motion_of_one(recording).error().message, HasSubstr("3 of the channels"));
  const Recording both[] = {made_falls({.falls = 1}), made_falls({.falls = 1, .orientation = false})};
  EXPECT_THAT(motion_of(both).error().message, HasSubstr("learn them apart"));
}

TEST(Motion, RatesOfTwoClocksAreOneRate) {
  const Recording both[] = {made_falls({.rate_hz = 30}), made_falls({.rate_hz = 30 / 1.001, .seed = 2})};
  const auto motion = motion_of(both);
  ASSERT_TRUE(motion) << motion.error().message;
  EXPECT_EQ(motion->rate_hz, 30);
  const Recording other[] = {made_falls({.rate_hz = 30}), made_falls({.rate_hz = 30.1})};
  EXPECT_FALSE(motion_of(other));
}

TEST(Motion, TurnsAndTheirInversesAgree) {
  const Quad q = {0.5, -0.5, 0.1, 0.7};
  double size = 0;
  for (double x : q) size += x * x;
  Quad unit = q;
  for (double& x : unit) x /= std::sqrt(size);
  const Triple v = {1, -2, 3}, back = in_body_axes(unit, in_world_axes(unit, v));
  for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(back[k], v[k], 1e-12);
  const Triple seen = in_world_axes(turned_about_z(unit, 0.7), v), same = turned_about_z(in_world_axes(unit, v), 0.7);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(seen[k], same[k], 1e-12);
}

TEST(Motion, AJumpIsAnErrorWithItsRow) {
  Recording recording = made_falls({.falls = 2, .seconds = 4});
  for (std::size_t row = 300; row < 480; ++row) recording.channels[0].samples[row] += 3;
  const auto motion = motion_of_one(recording);
  ASSERT_FALSE(motion);
  EXPECT_THAT(motion.error().message, HasSubstr("made.csv: row 301 lies 3"));
  EXPECT_THAT(motion.error().message, HasSubstr("begin a new episode there"));
  // Where one fall ends and another begins is no jump.
  for (std::size_t row = 240; row < 300; ++row) recording.channels[0].samples[row] += 3;
  EXPECT_TRUE(motion_of_one(recording));
}

TEST(Motion, WhatRestsAndThenMovesDoesNotJump) {
  Recording recording = made_falls({.falls = 1, .seconds = 4});
  for (Channel& channel : recording.channels) {
    for (std::size_t row = 0; row < 200; ++row) channel.samples[row] = channel.samples[200];
  }
  EXPECT_TRUE(motion_of_one(recording));
}

}  // namespace
}  // namespace wisp::chain::motion_test
