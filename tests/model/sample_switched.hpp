#pragma once
// Small switched models for tests: two outputs that feed each other, one input, three modes.

#include "wisp/model/model.hpp"

namespace wisp {

inline Model sample_switched() {
  SwitchedArxModel switched;
  switched.orders = {OrderMatrix(2, 2, 1), OrderMatrix(2, 1, 2), OrderMatrix(2, 1)};
  switched.orders.na(0, 0) = 2;
  switched.orders.nk(1, 0) = 1;
  switched.output_mean = {0.25, -0.5};
  switched.input_mean = {0.125};
  const double own[] = {-0.5, 0.25, 0.7};
  for (double a : own) {
    switched.modes.push_back({{{a, 0.1, 0.05, 0.3, a}, {0.05, -a, 0.2, -0.1}},
                              {{0.01, 0.02, 0.03, 0.01, 0.02}, {0.01, 0.02, 0.01, 0.02}},
                              {0.1 * a, -0.2},
                              {0.05, 0, 0.01 * a, 0.04}});
  }
  switched.initial = {0, 0.5, 0.5};
  switched.transitions = {0.9, 0.1, 0, 0, 0.8, 0.2, 0.125, 0, 0.875};
  Model model;
  model.name = "sample switched";
  model.rate_hz = 20;
  model.inputs = {{"u", "m/s", -1, 2, InputShape::kLinear}};
  model.outputs = {{"y1", "m", -2, 3}, {"y2", "", -1, 0.5}};
  model.dynamics = std::move(switched);
  model.training = {"wisp 0.1.0", {"tank.csv"}, {{"modes", "3"}}, {{"held_out", 1.5}}, {true, "made up"}};
  return model;
}

/// An ARX model without shared shocks as a switched one of a single mode.
inline SwitchedArxModel switched_of(const ArxModel& model) {
  const std::size_t ny = model.noise.sd.size();
  std::vector<double> shock(ny * ny, 0.0);
  for (std::size_t i = 0; i < ny; ++i) shock[i * ny + i] = model.noise.sd[i];
  return {
      model.orders, model.output_mean, model.input_mean, {{model.theta, model.std_error, model.constant, shock}}, {1},
      {1}};
}

}  // namespace wisp
