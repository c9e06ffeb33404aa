#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "wisp/draw/flame.hpp"
#include "wisp/model/model.hpp"

namespace wisp::shape_test {
namespace {

// An outline model whose control points lie there, in the middle of their ranges.
Model outline_of(const std::vector<std::array<double, 2>>& points) {
  Model model;
  model.view = OutlineView{};
  for (const auto& point : points) {
    for (const double value : point) model.outputs.push_back({"p", "", value - 0.1, value + 0.1});
  }
  return model;
}

const std::vector<std::array<double, 2>> kFlame{{-0.1, 0},   {-0.2, 0.3}, {-0.15, 0.7}, {0, 1.1},
                                                {0.15, 0.7}, {0.2, 0.3},  {0.1, 0}};
const std::vector<std::array<double, 2>> kFlag{{0, 0.1},    {0.3, 0.1},  {0.7, 0.1}, {1, 0},
                                               {0.7, -0.1}, {0.3, -0.1}, {0, -0.1}};
const std::vector<std::array<double, 2>> kBox{{-0.3, 0}, {-0.3, 1}, {-0.3, 1}, {0, 1}, {0.3, 1}, {0.3, 1}, {0.3, 0}};

TEST(Shape, WhatStandsAndTapersIsAFlame) {
  EXPECT_TRUE(is_flame(outline_of(kFlame)));
  EXPECT_FALSE(is_flame(outline_of(kFlag)));
  EXPECT_FALSE(is_flame(outline_of(kBox)));
}

TEST(Shape, WhatCanGoOutIsAFlame) {
  Model model = outline_of(kBox);
  model.extinction = Extinction{};
  EXPECT_TRUE(is_flame(model));
}

TEST(CandleStyle, IsTheFilmsOwnWaxAndWidth) {
  Model model = outline_of(kFlame);
  EXPECT_EQ(candle_style(model).candle_width, FlameStyle{}.candle_width);
  model.training.figures = {
      {"fit.1", 90}, {"candle.width", 1.2}, {"candle.red", 160}, {"candle.green", 30}, {"candle.blue", 20}};
  const FlameStyle red = candle_style(model);
  EXPECT_FLOAT_EQ(red.candle_width, 1.2F);
  EXPECT_EQ(red.wax.red, 240);
  EXPECT_LT(red.wax.green, 70);
  EXPECT_LT(red.wax.blue, 70);
  model.training.figures.pop_back();  // a file that was cut
  EXPECT_EQ(candle_style(model).candle_width, FlameStyle{}.candle_width);
}

TEST(Shape, ThereIsNoCandleUnderAPlainShape) {
  Image image(200, 200);
  const std::vector<Point> square{{-0.2F, 0}, {-0.2F, 0.5F}, {0.2F, 0.5F}, {0.2F, 0}};
  const Flame shape{square, {.base = {100, 150}, .pixels_per_unit = 100}};
  draw_shapes(image, {&shape, 1});
  const auto at = [&](int x, int y) { return image.at(x, y); };
  EXPECT_NE(at(100, 125), at(10, 10));
  EXPECT_EQ(at(100, 170), at(10, 10));
  EXPECT_EQ(at(150, 125), at(10, 10));
}

}  // namespace
}  // namespace wisp::shape_test
