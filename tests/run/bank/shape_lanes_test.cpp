// Outlines of components: what a bank shows is what the model says in double precision.

#include "run/bank/shape_lanes.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "wisp/model/file.hpp"
#include "wisp/run/bank.hpp"
#include "wisp/run/extinction_facet.hpp"

namespace wisp::shape_lanes_test {
namespace {

// Five control points moved by three components, each an integrator of its own shock, blown out by any wind.
Model shaped_model(bool mortal = false) {
  Model model;
  model.name = "shaped";
  model.rate_hz = 60;
  model.inputs = {{"wind", "", -2, 2, InputShape::kEvenOdd}};
  for (int p = 0; p < 5; ++p) {
    for (const char* axis : {".x", ".y"}) model.outputs.push_back({"p" + std::to_string(p) + axis, "", -1, 2});
  }
  OutlineView view{{0, 0, 0, 0, 0.5, 1, 1, 1, 1}};
  view.shape = {2, 1, {0.2, 0, 0.15, 0.6, 1, 0, 0, 0.01, 0.02, -0.01}, {}, {}, {{-4, 4}, {-3, 5}, {-4, 4}}};
  for (int k = 0; k < 5 * 3; ++k) view.shape.basis.push_back(k % 4 == 3 ? 0 : 0.01 * (k % 7) - 0.02);
  for (double rest : view.shape.rest) view.shape.coordinates.push_back({rest - 0.08, rest + 0.08});
  model.view = view;
  ArxModel arx;
  arx.orders = {OrderMatrix(3, 3, 1), OrderMatrix(3, 6, 1), OrderMatrix(3, 6)};
  for (int i = 0; i < 3; ++i) {
    std::vector<double> row(9, 0.05);
    row[i] = -0.8;
    arx.theta.push_back(row);
  }
  arx.constant = arx.output_mean = {0, 0, 0};
  arx.input_mean.assign(6, 0.0);
  arx.noise.sd = {0.5, 0.6, 0.7};
  model.dynamics = arx;
  if (mortal) model.extinction = Extinction{.level = 0.5, .seconds = 0.1};
  return model;
}

// The same dynamics, their components read as they are.
Model components_of(const Model& shaped) {
  Model model = shaped;
  model.view = PlainView{};
  model.outputs.clear();
  for (const ValueRange& range : std::get<OutlineView>(shaped.view).shape.components) {
    model.outputs.push_back({"c" + std::to_string(model.outputs.size()), "", range.lowest, range.highest});
  }
  return model;
}

TEST(ShapeLanes, ABankShowsTheShapeOfItsComponents) {
  const Model model = shaped_model();
  ASSERT_TRUE(check(model)) << check(model).error().message;
  auto shaped = Bank::create(model, {.capacity = 3}), plain = Bank::create(components_of(model), {.capacity = 3});
  ASSERT_TRUE(shaped && plain);
  std::vector<InstanceId> ids;
  for (int k = 0; k < 3; ++k) ids.push_back(shaped->spawn()), plain->spawn();
  std::vector<float> points(10), components(3);
  double farthest = 0;
  for (int frame = 0; frame < 200; ++frame) {
    const float wind = frame % 40 < 20 ? 0.5f : -0.2f;
    for (auto* bank : {&*shaped, &*plain}) {
      bank->set_common_inputs({&wind, 1});
      bank->advance(std::chrono::nanoseconds(21'000'000));
    }
    shaped->outputs(ids[1], points);
    plain->outputs(ids[1], components);
    const auto wanted = control_points(std::get<OutlineView>(model.view).shape,
                                       std::vector<double>(components.begin(), components.end()));
    for (std::size_t k = 0; k < 10; ++k) EXPECT_NEAR(points[k], wanted[k], 1e-6);
    farthest = std::max(farthest, static_cast<double>(points[4]));
  }
  EXPECT_GT(farthest, 0.02);
}

TEST(ShapeLanes, ManyStepsOfOneComponentGiveControlPoints) {
  Model model = shaped_model();
  ShapeComponents& shape = std::get<OutlineView>(model.view).shape;
  shape.symmetric = 1, shape.antisymmetric = 0, shape.basis.resize(5), shape.components = {{-4, 4}};
  ArxModel arx;
  arx.orders = {OrderMatrix(1, 1, 1), OrderMatrix(1, 6, 1), OrderMatrix(1, 6)};
  arx.theta = {{-0.8, 0.05, 0.05, 0.05, 0.05, 0.05, 0.05}};
  arx.constant = arx.output_mean = {0};
  arx.input_mean.assign(6, 0.0);
  arx.noise.sd = {0.5};
  model.dynamics = arx;
  auto many = Bank::create(model), single = Bank::create(model);
  ASSERT_TRUE(many && single);
  many->spawn(), single->spawn();
  std::vector<float> all(40), one(10);
  many->step(4, {}, all);
  for (std::size_t t = 0; t < 4; ++t) {
    single->step();
    single->outputs(single->at(0), one);
    for (std::size_t k = 0; k < 10; ++k) EXPECT_EQ(all[10 * t + k], one[k]) << t;
  }
}

TEST(ShapeLanes, WhatGoesOutShrinksAsItWasAndIsRestored) {
  const Model model = shaped_model(true);
  auto bank = Bank::create(model, {});
  ASSERT_TRUE(bank);
  const InstanceId id = bank->spawn();
  std::vector<float> points(10), after(10);
  const float wind = 1.5f;
  bank->step();
  bank->outputs(id, points);
  bank->set_common_inputs({&wind, 1});
  for (int frame = 0; frame < 9; ++frame) bank->step();
  std::vector<std::byte> bytes(bank->save_bytes());
  bank->save(bytes);
  auto other = Bank::create(model, {});
  ASSERT_TRUE(other->restore(bytes));
  for (int frame = 0; frame < 60; ++frame) bank->step(), other->step();
  bank->outputs(id, points);
  other->outputs(id, after);
  EXPECT_EQ(points, after);
  EXPECT_FALSE(bank->extinction()->state_of(id)->lit);
  for (float value : points) EXPECT_EQ(value, 0);
}

}  // namespace
}  // namespace wisp::shape_lanes_test
