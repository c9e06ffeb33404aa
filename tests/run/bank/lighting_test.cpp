// What is seen while a flame catches: recorded shapes, and their crossing to the dynamics.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "paths.hpp"
#include "run/bank/mortal_flame.hpp"
#include "wisp/model/file.hpp"
#include "wisp/run/bank.hpp"
#include "wisp/run/extinction_facet.hpp"

namespace wisp::extinction_test {
namespace {

// The shipped flame, whose events were recorded, and the control points of a row of one, [point][x, y].
struct RecordedFlame {
  Model model = *read_model(WISP_SOURCE_DIR "/apps/web/public/models/flame.wisp");
  const ShapeComponents& shape = std::get<OutlineView>(model.view).shape;

  std::vector<double> outline(const FlameEvents& events, std::size_t row) const {
    std::vector<double> components(shape.count());
    for (std::size_t k = 0; k < components.size(); ++k) {
      components[k] = events.scale[k] * events.shapes[row * components.size() + k];
    }
    std::vector<double> points = control_points(shape, components);
    for (double& value : points) value *= events.sizes[row] / 255.0;
    return points;
  }
};

double apart(const std::vector<float>& shown, const std::vector<double>& recorded) {
  double most = 0;
  for (std::size_t i = 0; i < shown.size(); ++i) most = std::max(most, std::abs(shown[i] - recorded[i]));
  return most;
}

// Lit in calm air it is one of the recorded flames, row by row, and comes from its last row to the dynamics.
TEST(Lighting, WhatCatchesIsARecordedShape) {
  const RecordedFlame flame;
  Bank bank = bank_of(flame.model), calm = bank_of(flame.model);
  const InstanceId id = bank.spawn();
  calm.spawn();
  for (Bank* each : {&bank, &calm}) each->set_noise(0);
  bank.extinction()->extinguish(id);
  blow(bank, 0, 60);
  bank.extinction()->relight(id);
  const FlameEvents& events = flame.model.extinction->catching;
  std::vector<std::size_t> begins{0};
  begins.insert(begins.end(), events.ends.begin(), events.ends.end() - 1);
  for (std::size_t step = 0; step < 40; ++step) {
    blow(bank, 0, 1);
    std::erase_if(
        begins, [&](std::size_t begin) { return apart(outputs_of(bank), flame.outline(events, begin + step)) > 1e-5; });
  }
  EXPECT_EQ(begins.size(), 1U);
  std::vector<float> before = outputs_of(bank);
  for (int step = 40; step < 80; ++step) {
    blow(bank, 0, 1);
    EXPECT_LT(apart(outputs_of(bank), {before.begin(), before.end()}), 0.03) << step;
    before = outputs_of(bank);
  }
  blow(calm, 0, 80);
  EXPECT_EQ(outputs_of(bank), outputs_of(calm));
}

// The same in wind, which it answers at once, by an offset that fades: the mushroom does not jump to the dynamics.
TEST(Lighting, WhatCatchesInWindIsMovedByIt) {
  const RecordedFlame flame;
  Bank bank = bank_of(flame.model), blown = bank_of(flame.model);
  for (Bank* each : {&bank, &blown}) {
    const InstanceId id = each->spawn();
    each->set_noise(0);
    each->extinction()->extinguish(id);
    blow(*each, 0, 60);
    each->extinction()->relight(id);
    blow(*each, 0, 12);
  }
  EXPECT_EQ(outputs_of(bank), outputs_of(blown));
  blow(bank, 0, 16);
  for (int step = 0; step < 16; ++step) {
    const std::vector<float> before = outputs_of(blown);
    blow(blown, 0.6f, 1);
    EXPECT_LT(apart(outputs_of(blown), {before.begin(), before.end()}), 0.09) << step;  // 0.11 without the offset
  }
  Bank burning = bank_of(flame.model);
  burning.spawn();
  burning.set_noise(0);
  blow(burning, 0, 12);
  blow(burning, 0.6f, 16);
  EXPECT_EQ(outputs_of(blown), outputs_of(burning));
  EXPECT_NE(outputs_of(bank), outputs_of(burning));
}

// Lit while it dies, or put out while it catches, what is seen goes on from where it is.
TEST(Lighting, NothingJumps) {
  const RecordedFlame flame;
  Bank bank = bank_of(flame.model);
  const InstanceId id = bank.spawn();
  blow(bank, 0.5f, 30);
  std::vector<float> before = outputs_of(bank);
  for (int step = 0; step < 120; ++step) {
    if (step % 40 == 0) bank.extinction()->extinguish(id);
    if (step % 40 == 2) bank.extinction()->relight(id);
    blow(bank, 0, 1);
    const std::vector<float> now = outputs_of(bank);
    EXPECT_LT(apart(now, {before.begin(), before.end()}), 0.35) << step;
    before = now;
  }
}

}  // namespace
}  // namespace wisp::extinction_test
