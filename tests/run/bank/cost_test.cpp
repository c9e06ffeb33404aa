#include "wisp/run/cost.hpp"

#include <gtest/gtest.h>

#include "paths.hpp"
#include "run/flame_model.hpp"
#include "wisp/model/file.hpp"

namespace wisp::cost_test {
namespace {

Cost cost_of(const Model& model, int polyline_points = 0) {
  const auto cost = count_operations(model, polyline_points);
  EXPECT_TRUE(cost) << cost.error().message;
  return *cost;
}

TEST(Cost, AFlameOfEightPointsAndOrderFourTakesThePapers192MultiplyAdds) {
  EXPECT_EQ(cost_of(flame_model()).multiply_adds_per_frame, 192);
}

TEST(Cost, WindWithASignAndItsPowersTakes320) {
  EXPECT_EQ(cost_of(flame_model({.wind = InputShape::kEvenOdd})).multiply_adds_per_frame, 320);
}

TEST(Cost, CoefficientsThatAreZeroCostNothing) {
  Model model = flame_model();
  const Cost full = cost_of(model);
  std::get<ArxModel>(model.dynamics).theta[4][5] = 0;
  std::get<ArxModel>(model.dynamics).theta[9][2] = 0;
  const Cost sparse = cost_of(model);
  EXPECT_EQ(sparse.multiply_adds_per_frame, 190);
  EXPECT_EQ(sparse.dynamics_operations, full.dynamics_operations - 4);
}

// One output, one input: y(t) = 0.5 y(t−1) + u(t) + e(t).
Model smallest_model() {
  Model model;
  model.rate_hz = 10;
  model.inputs = {{"u", "", -1, 1, InputShape::kLinear}};
  model.outputs = {{"y", "", -2, 2}};
  ArxModel arx;
  arx.orders = {OrderMatrix(1, 1, 1), OrderMatrix(1, 1, 1), OrderMatrix(1, 1, 0)};
  arx.theta = {{-0.5, 1.0}};
  arx.constant = arx.output_mean = arx.input_mean = {0};
  arx.noise.sd = {0.1};
  model.dynamics = arx;
  return model;
}

TEST(Cost, IsWhatOneCountsByHand) {
  const Cost cost = cost_of(smallest_model());
  EXPECT_EQ(cost.multiply_adds_per_frame, 2);
  EXPECT_EQ(cost.dynamics_operations, 2 * 2 + 1);  // each coefficient: × +; clamped or not: or
  // Two deviates: + of ½ twice, − of 1, the logarithm's 6 × and 5 +, × + of its octave, √, the square of the angle, 3 ×
  // and 3 + of sine and cosine, × by the angle, × × by the length; the use of one: × +
  EXPECT_EQ(cost.noise_operations, (3 + 11 + 2 + 1 + 1 + 2 * 6 + 3) + 2);
  // Four words are made at a time: the counter's group, seven rounds of two products and four exclusive ors. The word
  // that is used: and, −, shift, and, +, shift, and, xor, shift.
  EXPECT_EQ(cost.random_operations, 1 + 7 * 6 + 9);
  EXPECT_EQ(cost.view_operations, 3);  // between two steps: − × +; its mean is 0
  EXPECT_EQ(cost.operations_per_frame,
            cost.dynamics_operations + cost.noise_operations + cost.random_operations + cost.view_operations);
}

TEST(Cost, ChannelsFarFromTheirUnitTakeAProductMore) {
  Model model = smallest_model();
  model.outputs[0].lowest = model.inputs[0].lowest = -1000;
  std::get<ArxModel>(model.dynamics).input_mean = {0.5};
  EXPECT_EQ(cost_of(model).view_operations, 3 + 2);
  EXPECT_EQ(cost_of(model).dynamics_operations, 2 + 2 * 2 + 1);  // input: − ×
}

// Of 32 points two are ends of the outline. The 7, 6, 6, 6 and 5 others in its five knot spans: the first of each but
// of the first span takes 6 operations, and each after it an addition; differences begin with 4 and 2 and go on by
// additions.
TEST(Cost, APolylineTakesFewerThanFiveOperationsACoordinate) {
  const Model model = flame_model();
  const int derivatives = 7 * 2 + 6 * 2 + 5 * 2;
  const int first = 6 + (4 + 5) + (2 + 4), other = 6 + 5 + (4 + 4) + (2 + 3);
  EXPECT_EQ(cost_of(model, 32).view_operations, cost_of(model).view_operations + 2 * (derivatives + first + 4 * other));
}

// Resampled residuals, the rule of extinction, and an outline that is looked at.
TEST(Cost, AFlameOfCoordinatesHasAllParts) {
  const Cost cost = cost_of(default_flame_model(), 32);
  EXPECT_EQ(cost.multiply_adds_per_frame, 192 - 6);  // the ends have no last tap of their wind
  for (std::int64_t part : {cost.dynamics_operations, cost.noise_operations, cost.random_operations,
                            cost.view_operations, cost.extinction_operations}) {
    EXPECT_GT(part, 0);
  }
  EXPECT_EQ(cost_of(coupled_flame_model(), 32).multiply_adds_per_frame, 16 * (14 * 2 + 2 * 8));
}

// Those that the page and the packages carry, a search and what goes out included.
TEST(Cost, AShippedFlameTakesAtMost1700OperationsInItsWorstFrame) {
  for (const char* name : {"flame", "flame-2", "flame-4", "flame-6"}) {
    const auto model = read_model(WISP_SOURCE_DIR "/apps/web/public/models/" + std::string(name) + ".wisp");
    ASSERT_TRUE(model) << model.error().message;
    const Cost cost = cost_of(*model, 32);
    EXPECT_GT(cost.worst_operations, cost.operations_per_frame);
    EXPECT_LE(cost.worst_operations, 1700) << name;
  }
}

TEST(Cost, RecordedShapesOfAReIgnitionAreCounted) {
  const auto model = read_model(WISP_SOURCE_DIR "/apps/web/public/models/flame.wisp");
  ASSERT_TRUE(model && !model->extinction->catching.scale.empty());
  Model bare = *model;
  bare.extinction->catching = {};
  EXPECT_GT(cost_of(*model).worst_operations, cost_of(bare).worst_operations);
}

TEST(Cost, AModelWithoutNoiseDrawsNoRandomNumbers) {
  Model model = flame_model();
  std::get<ArxModel>(model.dynamics).noise.sd.assign(16, 0.0);
  EXPECT_EQ(cost_of(model).random_operations, 0);
  EXPECT_EQ(cost_of(model).noise_operations, 0);
}

TEST(Cost, ABadModelHasNone) {
  Model model = flame_model();
  model.rate_hz = -1;
  EXPECT_FALSE(count_operations(model));
}

}  // namespace
}  // namespace wisp::cost_test
