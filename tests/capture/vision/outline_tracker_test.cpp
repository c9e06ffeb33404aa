#include "capture/vision/outline_tracker.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "capture/support/seen_flame.hpp"

namespace wisp::outline_tracker_test {
namespace {

// Edge points of a known curve, with noise.
EdgeCloud points_on(const SplineTable& table, std::span<const double> controls, int count, double noise,
                    unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> error(0, noise);
  EdgeCloud cloud;
  for (int k = 0; k < count; ++k) {
    const double s = static_cast<double>(k) / (count - 1);
    const CurvePoint at = table.at(controls, s), slope = table.slope(controls, s);
    const double size = std::hypot(slope.x, slope.y), off = noise > 0 ? error(random) : 0;
    cloud.points.push_back({at.x + off * slope.y / size, at.y - off * slope.x / size, slope.y / size, -slope.x / size});
    cloud.s.push_back(s);
  }
  cloud.base_x = 0.5 * (controls[0] + controls[controls.size() - 2]);
  cloud.base_y = 0.5 * (controls[1] + controls[controls.size() - 1]);
  cloud.height = 100;
  return cloud;
}

const std::vector<double> kControls{60, 150, 50, 110, 62, 70, 76, 40, 84, 40, 98, 70, 108, 110, 100, 150};

double farthest_apart(std::span<const double> a, std::span<const double> b) {
  double worst = 0;
  for (std::size_t k = 0; k < a.size(); ++k) worst = std::max(worst, std::abs(a[k] - b[k]));
  return worst;
}

TEST(OutlineTracker, FindsTheControlPointsOfAnExactCurve) {
  OutlineTracker tracker(uniform_knots(8));
  const auto& estimate = tracker.update(points_on(tracker.table(), kControls, 200, 0, 1));
  // The vague prior pulls by one part in 10^6 of its distance.
  EXPECT_LT(farthest_apart(estimate.mean, kControls), 1e-3);
  EXPECT_LT(estimate.residual, 1e-3);
  EXPECT_EQ(estimate.used, 200);
}

TEST(OutlineTracker, IsTheSamePosteriorAsScalarKalmanUpdates) {
  // The textbook recursion on the whole covariance, one measurement after the other, with the same numbers.
  TrackerOptions options;
  options.passes = 1;
  options.slip = 0;
  OutlineTracker tracker(uniform_knots(8), options);
  const EdgeCloud cloud = points_on(tracker.table(), kControls, 40, 0.5, 2);
  const auto& estimate = tracker.update(cloud);
  const int n = 16;
  std::vector<double> mean(n), cov(n * n, 0.0), gain(n);
  for (int i = 0; i < n; ++i) {
    mean[i] = i % 2 == 0 ? cloud.base_x : cloud.base_y;
    cov[i * n + i] = 1e6;  // sd of ten heights of 100
  }
  const auto take = [&](double s, double nx, double ny, double value, double variance) {
    const BasisWeights weights = tracker.table().weights(s);
    std::vector<double> row(n, 0.0);
    for (int r = 0; r < 4; ++r) {
      row[2 * (weights.first + r)] = weights.weight[r] * nx;
      row[2 * (weights.first + r) + 1] = weights.weight[r] * ny;
    }
    double spread = variance, expected = 0;
    for (int i = 0; i < n; ++i) {
      gain[i] = 0;
      for (int j = 0; j < n; ++j) gain[i] += cov[i * n + j] * row[j];
    }
    for (int i = 0; i < n; ++i) {
      spread += row[i] * gain[i];
      expected += row[i] * mean[i];
    }
    for (int i = 0; i < n; ++i) mean[i] += gain[i] / spread * (value - expected);
    const std::vector<double> before = gain;
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) cov[i * n + j] -= before[i] * before[j] / spread;
    }
  };
  const double normal = 0.25 * 0.25, tangent = std::pow(options.tangent_sd * 100, 2);
  for (std::size_t k = 0; k < cloud.points.size(); ++k) {
    const EdgePoint& p = cloud.points[k];
    take(cloud.s[k], p.normal_x, p.normal_y, p.normal_x * p.x + p.normal_y * p.y, normal);
    take(cloud.s[k], -p.normal_y, p.normal_x, p.normal_x * p.y - p.normal_y * p.x, tangent);
  }
  for (const int last : {0, 1}) {
    const EdgePoint& end = last ? cloud.points.back() : cloud.points.front();
    take(last, 1, 0, end.x, normal / 4);
    take(last, 0, 1, end.y, normal / 4);
  }
  EXPECT_LT(farthest_apart(estimate.mean, mean), 1e-6);
  EXPECT_LT(farthest_apart(estimate.covariance, cov), 1e-6);
}

TEST(OutlineTracker, LeavesOutEdgePointsThatLieFarOff) {
  OutlineTracker tracker(uniform_knots(8));
  EdgeCloud cloud = points_on(tracker.table(), kControls, 200, 0.2, 3);
  for (std::size_t k = 60; k < 66; ++k) cloud.points[k].x -= 40;
  const auto& estimate = tracker.update(cloud);
  EXPECT_EQ(estimate.gated, 6);
  EXPECT_LT(farthest_apart(estimate.mean, kControls), 2);
}

TEST(OutlineTracker, FollowsACurveThatIsCarriedAlong) {
  OutlineTracker tracker(uniform_knots(8));
  std::vector<double> controls = kControls;
  for (int frame = 0; frame < 20; ++frame) {
    for (std::size_t k = 0; k < controls.size(); k += 2) controls[k] += 9;
    const auto& estimate = tracker.update(points_on(tracker.table(), controls, 150, 0.3, 10 + frame));
    EXPECT_LT(farthest_apart(estimate.mean, controls), 3) << frame;
  }
}

TEST(OutlineTracker, ControlPointsOfAStillThingStandStill) {
  // Noise of four grey levels on a ramp of 74 levels a pixel moves an edge point by 0.05 px, and boundary pixels come
  // and go with it, which moves the places along the curve by a pixel among some three hundred. At the tip a control
  // point lies far from the curve, where its lever is about eight: half a pixel on a flame 110 pixels high.
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0, 4);
  OutlineTracker tracker(uniform_knots(8));
  std::vector<double> sum(16), squares(16);
  const int frames = 60;
  for (int frame = 0; frame < frames; ++frame) {
    support::Plane plane = support::flame_picture(support::Flame{});
    for (auto& pixel : plane.pixels) {
      pixel = static_cast<std::uint8_t>(std::clamp(pixel + std::lround(noise(random)), 0L, 255L));
    }
    const auto& estimate = tracker.update(support::cloud_of(plane, 118));
    for (int i = 0; i < 16; ++i) {
      sum[i] += estimate.mean[i] / frames;
      squares[i] += estimate.mean[i] * estimate.mean[i] / frames;
    }
  }
  for (int i = 0; i < 16; ++i) EXPECT_LT(std::sqrt(squares[i] - sum[i] * sum[i]), 0.55) << i;
}

TEST(OutlineTracker, ForgettingMakesTheNextFrameTheFirst) {
  OutlineTracker used(uniform_knots(8)), fresh(uniform_knots(8));
  std::vector<double> elsewhere = kControls;
  for (double& value : elsewhere) value += 500;
  used.update(points_on(used.table(), elsewhere, 100, 0.2, 4));
  used.forget();
  const EdgeCloud cloud = points_on(used.table(), kControls, 100, 0.2, 5);
  EXPECT_EQ(used.update(cloud).mean, fresh.update(cloud).mean);
}

}  // namespace
}  // namespace wisp::outline_tracker_test
