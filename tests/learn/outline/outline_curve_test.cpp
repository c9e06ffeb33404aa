// Outlines whose answer to the wind is not proportional to what the sensor says.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "learn/outline/made_outline.hpp"
#include "learn/outline/outline_fit.hpp"
#include "learn/outline/outline_judgement.hpp"
#include "wisp/run/cost.hpp"

namespace wisp::outline_curve_test {
namespace {

using testing::HasSubstr;

constexpr made::OutlineRecipe kWindy{.points = 6, .rows = 2400, .shock = 0.003, .wind = true, .both_sides = true};

// A sensor that hears the square root of the wind: what it says must be squared.
Recording heard_by_its_root(made::OutlineRecipe recipe, std::uint64_t seed) {
  recipe.seed = seed;
  Recording recording = made::outline_recording(recipe);
  for (double& u : recording.channels[*find_channel(recording, "wind")].samples) {
    u = std::copysign(std::sqrt(std::abs(u)), u);
  }
  return recording;
}

OutlineFit learned(const Recording& recording, std::optional<int> knots) {
  OutlineRecipe options;
  options.light = true;
  options.input_curve = knots;
  auto fit = fit_outline({&recording, 1}, options);
  EXPECT_TRUE(fit) << fit.error().message;
  return *std::move(fit);
}

double simulated_tip(const OutlineFit& fit, const Recording& unseen) {
  const auto found = judge_outline(fit.model, unseen, {.fidelity = false});
  EXPECT_TRUE(found) << found.error().message;
  return found->figures.tip_fit_percent.back();
}

TEST(OutlineCurve, IsKeptWhereTheAnswerBends) {
  const Recording recording = heard_by_its_root(kWindy, 1), unseen = heard_by_its_root(kWindy, 2);
  const OutlineFit plain = learned(recording, 0), bent = learned(recording, {});
  EXPECT_GT(bent.summary.curve_choice.knots, 0) << bent.summary.curve_choice.reason;
  EXPECT_EQ(bent.model.inputs[0].shape, InputShape::kSplitSignCurve);
  EXPECT_EQ(bent.model.inputs[0].curve, bent.summary.curves[0].curve);
  const auto& curve = bent.model.inputs[0].curve;
  for (std::size_t k = 1; k + 1 < curve.at.size(); ++k) {
    // The square through both ends.
    EXPECT_NEAR(curve.value[k], curve.at[k] * curve.at[k] / curve.at.back(), 0.1) << k;
  }
  EXPECT_GT(simulated_tip(bent, unseen), simulated_tip(plain, unseen) + 5);
  const auto bent_cost = count_operations(bent.model), plain_cost = count_operations(plain.model);
  ASSERT_TRUE(bent_cost && plain_cost);
  EXPECT_EQ(bent_cost->multiply_adds_per_frame, plain_cost->multiply_adds_per_frame);
  const std::int64_t more = 3;  // the side from which nothing blows is not bent
  EXPECT_EQ(bent_cost->dynamics_operations, plain_cost->dynamics_operations + more);
}

TEST(OutlineCurve, IsNotKeptWhereItIsProportional) {
  const Recording recording = made::outline_recording(kWindy);
  const OutlineFit plain = learned(recording, 0), judged = learned(recording, {});
  EXPECT_EQ(judged.summary.curve_choice.knots, 0) << judged.summary.curve_choice.reason;
  EXPECT_EQ(judged.model.inputs[0].shape, InputShape::kSplitSign);
  EXPECT_EQ(std::get<ArxModel>(judged.model.dynamics).theta, std::get<ArxModel>(plain.model.dynamics).theta);
}

TEST(OutlineCurve, OptionsOutOfRangeAreRefused) {
  const Recording recording = made::outline_recording(kWindy);
  OutlineRecipe options;
  options.input_curve = 2;
  EXPECT_THAT(fit_outline({&recording, 1}, options).error().message,
              HasSubstr("is 2, expected 0 (no curve) or 3 to 16"));
}

}  // namespace
}  // namespace wisp::outline_curve_test
