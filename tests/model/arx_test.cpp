#include "wisp/model/arx.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "model/sample_model.hpp"

namespace wisp::arx_test {
namespace {

ArxModel scalar(std::vector<double> a) {
  ArxModel model;
  model.orders = {OrderMatrix(1, 1, static_cast<int>(a.size())), OrderMatrix(1, 0), OrderMatrix(1, 0)};
  model.theta = {std::move(a)};
  model.constant = model.output_mean = model.noise.sd = {0};
  return model;
}

TEST(ArxModel, TheRadiusIsThatOfTheLargestPole) {
  // (1 − 0.5 q⁻¹)(1 + 0.75 q⁻¹): poles 0.5 and −0.75, exact in single precision.
  EXPECT_NEAR(spectral_radius(scalar({0.25, -0.375})), 0.75, 1e-10);
  // A complex pair of radius √0.8125.
  EXPECT_NEAR(spectral_radius(scalar({-1.5, 0.8125})), std::sqrt(0.8125), 1e-10);
  // A double pole moves by the square root of a perturbation; rounding in the first squarings, some 1e-12 of the norm
  // there, is such a perturbation.
  EXPECT_NEAR(spectral_radius(scalar({-1.0, 0.25})), 0.5, 1e-5);
  EXPECT_EQ(spectral_radius(scalar({})), 0);
  EXPECT_EQ(spectral_radius(scalar({0, 0, 0})), 0);
  EXPECT_NEAR(spectral_radius(scalar({-2.5})), 2.5, 1e-10);
}

TEST(ArxModel, TheRadiusIsTakenAfterRoundingToSinglePrecision) {
  EXPECT_GE(spectral_radius(scalar({-(1.0 - 1e-9)})), 1.0 - 1e-12);
}

TEST(ArxModel, ACoefficientBeyondSinglePrecisionIsUnstable) { EXPECT_GE(spectral_radius(scalar({1e39})), 1); }

TEST(ArxModel, CoupledOutputsAreOneSystem) {
  // y1(t) = 0.9 y2(t−1), y2(t) = 0.9 y1(t−1): eigenvalues ±0.9, though no output feeds itself.
  ArxModel model;
  model.orders = {OrderMatrix(2, 2), OrderMatrix(2, 0), OrderMatrix(2, 0)};
  model.orders.na(0, 1) = model.orders.na(1, 0) = 1;
  model.theta = {{-0.9}, {-0.9}};
  EXPECT_NEAR(spectral_radius(model), 0.9, 1e-7);
}

TEST(ArxModel, OneWithoutOutputsIsRefused) { EXPECT_FALSE(check(ArxModel{})); }

TEST(ArxModel, CoupledOutputsWithMorePastThanAComputerHoldsAreRefused) {
  ArxModel model;
  model.orders = {OrderMatrix(64, 64), OrderMatrix(64, 0), OrderMatrix(64, 0)};
  for (int i = 0; i < 64; ++i) model.orders.na(i, 0) = 1;
  model.orders.na(0, 0) = 4096;
  EXPECT_EQ(check(model).error().message,
            "64 coupled outputs are computed from 262144 past values, expected at most 1024");
}

TEST(ArxModel, CoefficientsAreFoundByOutputAndInput) {
  const ArxModel model = std::get<ArxModel>(sample_model().dynamics);
  EXPECT_EQ(model.a(1, 0).size(), 1u);
  EXPECT_EQ(model.a(1, 1)[1], 0.3);
  EXPECT_EQ(model.a(0, 1)[0], 0.01);
  EXPECT_EQ(model.b(0, 4)[0], -0.3);
  EXPECT_TRUE(model.b(0, 1).empty());
  EXPECT_EQ(model.orders.history(), 3);
  EXPECT_EQ(model.orders.row_size(0), 5);
}

}  // namespace
}  // namespace wisp::arx_test
