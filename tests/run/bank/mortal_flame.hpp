#pragma once
// A flame that can be blown out, and calls that tests of its life share.

#include <gtest/gtest.h>

#include <vector>

#include "run/flame_model.hpp"
#include "wisp/run/bank.hpp"
#include "wisp/run/extinction_facet.hpp"

namespace wisp::extinction_test {

// A flame at 100 steps a second that a wind of 2 blows out in 20 steps, of 4 in 20 / 3, and that recovers in 40.
inline Model mortal_flame(double haste = 2) {
  Model model = flame_model({.wind = InputShape::kEvenOdd});
  model.rate_hz = 100;
  model.extinction = Extinction{.input = 0, .level = 2, .seconds = 0.2, .haste = haste, .recovery = 0.4};
  // It is gone in ten steps, and catches in forty; each in one of two ways, which differ by a hundredth.
  const auto add = [](FlameEvents& events, int steps, int from, int slope, int more) {
    for (int k = 0; k < steps; ++k) events.sizes.push_back(static_cast<std::uint8_t>(from + slope * k + more));
    events.ends.push_back(static_cast<std::uint32_t>(events.sizes.size()));
  };
  for (int more : {0, 2}) add(model.extinction->dying, 10, 230, -25, more);
  for (int more : {0, 2}) add(model.extinction->catching, 40, 6, 6, more);
  return model;
}

inline Bank bank_of(const Model& model, int capacity = 1) {
  auto bank = Bank::create(model, {.capacity = capacity, .seed = 3});
  EXPECT_TRUE(bank) << bank.error().message;
  return std::move(bank).value();
}

inline void blow(Bank& bank, float wind, int steps) {
  bank.set_common_inputs(std::span(&wind, 1));
  for (int k = 0; k < steps; ++k) bank.step();
}

inline std::vector<float> outputs_of(const Bank& bank) {
  std::vector<float> values(static_cast<std::size_t>(bank.slots()) * bank.output_count());
  bank.outputs(values);
  return values;
}

}  // namespace wisp::extinction_test
