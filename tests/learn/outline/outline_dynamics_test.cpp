// Components of an outline's shape, and dynamics that know its symmetry.

#include "learn/outline/outline_dynamics.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "learn/outline/made_outline.hpp"

namespace wisp::outline_dynamics_test {
namespace {

constexpr made::OutlineRecipe kWindy{.points = 7, .rows = 900, .wind = true, .both_sides = true};

PreparedOutlines prepared_of(const made::OutlineRecipe& recipe) {
  const Recording recording = made::outline_recording(recipe);
  auto prepared = prepare_outlines({&recording, 1}, {});
  EXPECT_TRUE(prepared);
  return *std::move(prepared);
}

OutlineDynamics fitted(const PreparedOutlines& prepared) {
  auto dynamics = fit_dynamics(prepared.recordings, prepared, 0);
  EXPECT_TRUE(dynamics) << (dynamics ? "" : dynamics.error().message);
  return *std::move(dynamics);
}

TEST(OutlineDynamics, ComponentsHaveAVarianceOfOneAndTellTheControlPoints) {
  const PreparedOutlines prepared = prepared_of(kWindy);
  const OutlineDynamics dynamics = fitted(prepared);
  const Recording& recording = prepared.recordings.front();
  const Recording moved = moved_recording(dynamics.shape, recording, prepared);
  std::vector<double> components(dynamics.shape.count());
  double square = 0;
  for (std::size_t row = 0; row < recording.rows(); ++row) {
    for (std::size_t k = 0; k < components.size(); ++k) components[k] = moved.channels[k].samples[row];
    square += components[0] * components[0];
    const std::vector<double> control = control_points(dynamics.shape, components);
    // Seven points have fourteen coordinates, and the base's middle is at 0: twelve components are all of them.
    for (std::size_t i = 0; i < control.size(); ++i) EXPECT_NEAR(control[i], recording.channels[i].samples[row], 1e-6);
  }
  EXPECT_NEAR(square / static_cast<double>(recording.rows()), 1, 1e-6);
}

TEST(OutlineDynamics, TheMirrorImageTurnsAntisymmetricComponentsAbout) {
  const PreparedOutlines prepared = prepared_of(kWindy);
  const OutlineDynamics dynamics = fitted(prepared);
  std::vector<double> components(dynamics.shape.count(), 0.5);
  const std::vector<double> rest(components.size(), 0.0);
  const auto one = control_points(dynamics.shape, components), calm = control_points(dynamics.shape, rest);
  for (std::size_t k = dynamics.shape.symmetric; k < components.size(); ++k) components[k] = -components[k];
  const auto other = control_points(dynamics.shape, components);
  for (std::size_t p = 0; p < 7; ++p) {
    EXPECT_NEAR(one[2 * p] - calm[2 * p], -(other[2 * (6 - p)] - calm[2 * (6 - p)]), 1e-12);
    EXPECT_NEAR(one[2 * p + 1] - calm[2 * p + 1], other[2 * (6 - p) + 1] - calm[2 * (6 - p) + 1], 1e-12);
  }
}

TEST(OutlineDynamics, PredictionsAreOfControlPoints) {
  const PreparedOutlines prepared = prepared_of(kWindy);
  const OutlineDynamics dynamics = fitted(prepared);
  const Recording& recording = prepared.recordings.front();
  const auto next = predict_outline(dynamics, recording, prepared, {.steps = 1});
  ASSERT_TRUE(next);
  ASSERT_EQ(next->size(), 14u);
  const auto sd = outline_prediction_sd(dynamics, 2);
  for (std::size_t i : {4, 7}) {
    double square = 0, count = 0;
    for (std::size_t row = 20; row < recording.rows(); ++row) {
      square += std::pow((*next)[i][row] - recording.channels[i].samples[row], 2);
      ++count;
    }
    EXPECT_NEAR(std::sqrt(square / count), sd[i][0], 0.2 * sd[i][0]) << i;
    EXPECT_GT(sd[i][1], sd[i][0]);
  }
}

TEST(OutlineDynamics, WhatNeverMovesIsRefused) {
  PreparedOutlines prepared = prepared_of({.rows = 200});
  for (Channel& channel : prepared.recordings.front().channels) {
    std::fill(channel.samples.begin(), channel.samples.end(), channel.samples.front());
  }
  prepared.rest.clear();
  const auto dynamics = fit_dynamics(prepared.recordings, prepared, 0);
  ASSERT_FALSE(dynamics);
  EXPECT_NE(dynamics.error().message.find("never moves"), std::string::npos);
}

}  // namespace
}  // namespace wisp::outline_dynamics_test
