#include "simulate/candle/virtual_camera.hpp"

#include <gtest/gtest.h>

namespace wisp::flow::light_sampling_test {
namespace {

double sampled(const std::vector<float>& values, int columns, int rows, double x, double y) {
  const SamplePlaces across = sample_places(1, x, 1, columns);
  const SamplePlaces upward = sample_places(1, y, 1, rows);
  std::vector<float> mixed(columns);
  mix_rows(values, columns, upward, 0, mixed);
  return static_cast<double>(sample(mixed, across, 0));
}

// The cubic B-spline kernel gives back a plane exactly.
TEST(LightSampling, GivesBackAPlane) {
  std::vector<float> values;
  for (int j = 0; j < 8; ++j)
    for (int i = 0; i < 9; ++i) values.push_back(2.0F + 0.5F * static_cast<float>(i) - 0.25F * static_cast<float>(j));
  EXPECT_NEAR(sampled(values, 9, 8, 3.3, 4.8), 2 + 0.5 * 3.3 - 0.25 * 4.8, 1e-5);
  EXPECT_NEAR(sampled(values, 9, 8, 4.0, 3.0), 2 + 0.5 * 4.0 - 0.25 * 3.0, 1e-5);
}

TEST(LightSampling, FadesToNothingOutside) {
  const std::vector<float> values(64, 1.0F);
  EXPECT_NEAR(sampled(values, 8, 8, 3.5, 3.5), 1, 1e-6);
  EXPECT_LT(sampled(values, 8, 8, -0.6, 3.5), 0.5);
  EXPECT_EQ(sampled(values, 8, 8, -5, 3.5), 0);
  EXPECT_EQ(sampled(values, 8, 8, 3.5, 40), 0);
}

}  // namespace
}  // namespace wisp::flow::light_sampling_test
