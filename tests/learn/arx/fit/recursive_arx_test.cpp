#include "wisp/learn/recursive_arx.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "wisp/learn/arx_fit.hpp"
#include "wisp/learn/arx_orders.hpp"

namespace wisp {
namespace {

// Two outputs that feed each other, one input.
class Source {
 public:
  explicit Source(double feedback = 1.5) : feedback_(feedback) {}

  void step(double wind) {
    const double y1 = feedback_ * y_[0][0] - 0.7 * y_[0][1] + 0.1 * y_[1][0] + u_ + 0.05 * normal_(generator_);
    const double y2 = 0.8 * y_[1][0] - 0.05 * y_[0][0] - 0.5 * u_ + 0.05 * normal_(generator_);
    y_[0][1] = y_[0][0], y_[0][0] = y1;
    y_[1][1] = y_[1][0], y_[1][0] = y2;
    u_ = wind;
  }
  void change(double feedback) { feedback_ = feedback; }
  std::vector<double> outputs() const { return {y_[0][0], y_[1][0]}; }
  double wind() { return normal_(generator_); }
  double input() const { return u_; }

 private:
  double feedback_;
  double y_[2][2] = {};
  double u_ = 0;
  std::mt19937 generator_{4};
  std::normal_distribution<double> normal_;
};

ArxOrders orders() { return make_orders({.outputs = 2, .inputs = 1, .na = 2, .nb = 1, .nk = 1}); }

TEST(RecursiveArx, WithoutForgettingIsTheBatchFit) {
  auto learner = RecursiveArx::create({.orders = orders(), .forgetting = 1, .trust = 1e-12, .floor = 0});
  ASSERT_TRUE(learner);
  Recording recording;
  recording.rate_hz = 60;
  recording.channels = {{"u", "", Role::kInput, {}}, {"y1", "", Role::kOutput, {}}, {"y2", "", Role::kOutput, {}}};
  Source source;
  for (int t = 0; t < 500; ++t) {
    source.step(source.wind());
    const auto y = source.outputs();
    const double u = source.input();
    learner->update(y, {&u, 1});
    recording.channels[0].samples.push_back(u);
    recording.channels[1].samples.push_back(y[0]);
    recording.channels[2].samples.push_back(y[1]);
  }
  ArxOptions options;
  options.orders = orders();
  options.offset = ArxOffset::kNone;
  const auto fit = fit_arx({&recording, 1}, {{"u"}, {"y1", "y2"}}, options);
  ASSERT_TRUE(fit);
  for (std::size_t i = 0; i < 2; ++i) {
    for (std::size_t p = 0; p < 5; ++p) EXPECT_NEAR(learner->model().theta[i][p], fit->model.theta[i][p], 1e-9);
  }
  EXPECT_TRUE(check(learner->model()));
}

TEST(RecursiveArx, FollowsASystemThatChanges) {
  auto learner = RecursiveArx::create({.orders = orders(), .forgetting = 0.98});
  Source source;
  for (int t = 0; t < 2000; ++t) {
    if (t == 1000) source.change(1.2);
    source.step(source.wind());
    const double u = source.input();
    learner->update(source.outputs(), {&u, 1});
    if (t == 999) {
      EXPECT_NEAR(learner->model().theta[0][0], -1.5, 0.03);
    }
  }
  EXPECT_NEAR(learner->model().theta[0][0], -1.2, 0.03);
  EXPECT_NEAR(learner->model().noise.sd[0], 0.05, 0.02);
}

TEST(RecursiveArx, ModelIsStableAfterEveryUpdateOfExplosiveData) {
  auto learner = RecursiveArx::create({.orders = orders(), .forgetting = 0.95});
  Source source(1.75);  // poles outside the circle
  bool held = false;
  for (int t = 0; t < 300; ++t) {
    source.step(source.wind());
    const double u = source.input();
    learner->update(source.outputs(), {&u, 1});
    ASSERT_LT(spectral_radius(learner->model()), 1) << t;
    ASSERT_TRUE(check(learner->model()));
    held = held || learner->held();
  }
  EXPECT_TRUE(held);
}

TEST(RecursiveArx, LongCalmDoesNotWindItUp) {
  auto learner = RecursiveArx::create({.orders = orders(), .forgetting = 0.97});
  Source source;
  for (int t = 0; t < 500; ++t) {
    source.step(source.wind());
    const double u = source.input();
    learner->update(source.outputs(), {&u, 1});
  }
  const double before = learner->model().theta[0][4];
  learner->restart();
  // Nearly no wind, and outputs that only tremble: what wind does can no longer be learned, and must not be unlearned.
  for (int t = 0; t < 2000; ++t) {
    const double tremble = 1e-6 * source.wind();
    learner->update(std::vector<double>{1e-3 * source.wind(), 1e-3 * source.wind()}, {&tremble, 1});
    ASSERT_NEAR(learner->model().theta[0][4], before, 0.01) << t;
  }
}

TEST(RecursiveArx, WhatAMissingSampleEntersIsNotLearnedFrom) {
  auto learner = RecursiveArx::create({.orders = orders()});
  Source source;
  int learned = 0;
  for (int t = 0; t < 100; ++t) {
    source.step(source.wind());
    auto y = source.outputs();
    const double u = source.input();
    if (t == 50) y[0] = std::numeric_limits<double>::quiet_NaN();
    learned += learner->update(y, {&u, 1});
  }
  EXPECT_EQ(learned, 100 - 2 - 3);
}

TEST(RecursiveArx, StartsFromAModel) {
  ArxModel start;
  start.orders = orders();
  start.theta = {{-1.5, 0.7, -0.1, 0, 1}, {0.05, 0, -0.8, 0, -0.5}};
  start.constant = {0, 0};
  start.output_mean = {3, -2};
  start.input_mean = {0.5};
  const auto learner = RecursiveArx::create({.orders = orders(), .output_scale = {2, 5}, .input_scale = {10}}, &start);
  ASSERT_TRUE(learner);
  for (std::size_t i = 0; i < 2; ++i) {
    for (std::size_t p = 0; p < 5; ++p) EXPECT_NEAR(learner->model().theta[i][p], start.theta[i][p], 1e-12);
  }
  EXPECT_EQ(learner->model().output_mean, start.output_mean);
}

TEST(RecursiveArx, RefusesOptionsOutOfRange) {
  EXPECT_FALSE(RecursiveArx::create({.orders = orders(), .forgetting = 0}));
  EXPECT_FALSE(RecursiveArx::create({.orders = orders(), .forgetting = 1.1}));
  EXPECT_FALSE(RecursiveArx::create({.orders = orders(), .output_scale = {1}}));
  EXPECT_FALSE(RecursiveArx::create({.orders = {}}));
}

}  // namespace
}  // namespace wisp
