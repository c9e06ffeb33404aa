#pragma once
// A small outline model for tests: four control points, one wind, every field in use.

#include "model/bspline.hpp"
#include "wisp/model/model.hpp"

namespace wisp {

inline Model sample_model() {
  constexpr int kOutputs = 8;
  Model model;
  model.name = "sample";
  model.rate_hz = 30;
  model.inputs = {{"wind", "m/s", -1.5, 1.5, InputShape::kEvenOdd}};
  ArxModel arx;
  arx.orders = {OrderMatrix(kOutputs, kOutputs), OrderMatrix(kOutputs, 6), OrderMatrix(kOutputs, 6, 3)};
  for (int i = 0; i < kOutputs; ++i) {
    model.outputs.push_back({"p" + std::to_string(i / 2) + (i % 2 ? ".y" : ".x"), "", -1.0 - i, 1.0 + i});
    arx.orders.na(i, i) = 2;
    arx.orders.na(i, i ^ 1) = 1;
    const bool x_row = i % 2 == 0;
    for (int k : {x_row ? 3 : 0, x_row ? 4 : 1}) arx.orders.nb(i, k) = 1;
    // Columns run over outputs in order, so the row's own lags come first in an x row and second in a y row.
    arx.theta.push_back(x_row ? std::vector<double>{-1.2, 0.5, 0.01, 0.3, -0.3}
                              : std::vector<double>{0.02, -0.9, 0.3, 0.1, 0.1});
    arx.std_error.push_back({0.01, 0.01, 0.02, 0.03, 0.03});
    arx.constant.push_back(0.001 * i);
    arx.output_mean.push_back(0.1 * i);
    arx.noise.sd.push_back(0.01 + 0.001 * i);
    arx.noise.sd_ci95.push_back({0.009, 0.02});
  }
  arx.input_mean = {0.25, 0.125, 0.5, 0, 0.25, 0.125};
  model.dynamics = arx;
  model.view = OutlineView{uniform_knots(4), 0.03, 200};
  model.training = {
      "wisp 0.1.0", {"clip.mp4"}, {{"order", "2"}}, {{"fit_percent", 61.5}}, {true, "fits held-out data"}};
  model.training.inputs = {{.scale = 2.5, .one_rms = 0.125}};
  model.training.residual_sd.assign(kOutputs, 0.25);
  model.training.underside = false;
  model.training.motion = MotionTraining{"zero:speed", 0.04, 0.1, 9};
  model.training.extinction = ExtinctionTraining{Origin::kLearned, 9, 8, 70, 69, 0.05};
  model.training.multiply_adds_per_frame = 192;
  model.training.operations_per_frame = 575;
  return model;
}

}  // namespace wisp
