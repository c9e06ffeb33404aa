#include "run/bank/outline_lanes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "model/bspline.hpp"
#include "wisp/run/random.hpp"

namespace wisp::outline_lanes_test {
namespace {

constexpr int kLanes = LiveNumbers::kLanes;

// A stand-in for random numbers between −1 and 1.
float coordinate(std::size_t k) {
  const auto words = random_words({.seed = 3, .stream = k, .step = 0});
  return static_cast<float>(static_cast<std::int32_t>(words[0]) >> 8) / 8388608.0f;
}

// The largest error of a polyline, as a share of the largest control coordinate; infinite where it has not all points.
double error_of(const std::vector<double>& knots, int points) {
  std::vector<std::byte> memory(1 << 20);
  Arena arena(memory);
  const PolylineProgram program = make_polyline(OutlineView{knots, 0, 0}, points, arena);
  std::vector<float> controls((knots.size() - kSplineDegree - 1) * 2 * kLanes);
  for (std::size_t k = 0; k < controls.size(); ++k) controls[k] = coordinate(k);
  double worst = 0;
  for (int axis : {0, 1}) {
    int shown = 0;
    polyline_lanes<LiveNumbers>(program, axis, controls.data(), [&](int point, const auto& values) {
      float lanes[kLanes];
      store(values, lanes);
      const BasisWeights weights = basis(knots, static_cast<double>(point) / (points - 1));
      for (int lane = 0; lane < kLanes; ++lane) {
        double expected = 0;
        for (int i = 0; i < 4; ++i) {
          expected += weights.weight[i] * controls[(2 * (weights.first + i) + axis) * kLanes + lane];
        }
        worst = std::max(worst, std::abs(lanes[lane] - expected));
      }
      if (point == shown) ++shown;
    });
    if (shown != points) return std::numeric_limits<double>::infinity();
  }
  return worst;
}

// Seven additions follow a point's six operations: half an ulp of what is at most twice the largest coordinate each,
// and the differences between them, a few ulps off, count up to seven times.
constexpr double kRounding = 32 * 0x1p-24;

TEST(Polyline, IsTheSplineToRounding) {
  for (int controls : {4, 5, 8, 16, 40}) {
    for (int points : {2, 3, 9, 32, 33, 96, 1000, 4096}) {
      EXPECT_LT(error_of(uniform_knots(controls), points), kRounding) << controls << " control points, " << points;
    }
  }
}

TEST(Polyline, IsTheSplineWhereverItsKnotsLie) {
  const std::vector<std::vector<double>> interiors = {{0.13, 0.4, 0.4, 0.77},
                                                      {0.5, 0.5, 0.5},
                                                      {1.0 / 31, 2.0 / 31, 3.0 / 31, 30.0 / 31},
                                                      {1e-4, 0.2, 0.2 + 1e-6, 0.2 + 2e-6, 0.9999},
                                                      {1e-12, 0.5, 0.5 + 1e-9, 0.5 + 2e-9}};
  for (const auto& interior : interiors) {
    for (int points : {2, 3, 17, 32, 501}) {
      EXPECT_LT(error_of(clamped_knots(interior), points), kRounding) << interior[0] << ", " << points;
    }
  }
}

TEST(Polyline, BeginsAndEndsInControlPoints) {
  std::vector<std::byte> memory(1 << 16);
  Arena arena(memory);
  const PolylineProgram program = make_polyline(OutlineView{uniform_knots(8), 0, 0}, 32, arena);
  std::vector<float> controls(16 * kLanes);
  for (std::size_t k = 0; k < controls.size(); ++k) controls[k] = coordinate(k);
  int ends = 0;
  polyline_lanes<LiveNumbers>(program, 1, controls.data(), [&](int point, const auto& values) {
    float lanes[kLanes];
    store(values, lanes);
    ends |= point == 0 && lanes[3] == controls[1 * kLanes + 3] ? 1 : 0;
    ends |= point == 31 && lanes[3] == controls[15 * kLanes + 3] ? 2 : 0;
  });
  EXPECT_EQ(ends, 3);
}

}  // namespace
}  // namespace wisp::outline_lanes_test
