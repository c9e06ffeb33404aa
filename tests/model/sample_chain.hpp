#pragma once
// A small chain for tests: two modes, three segments, poses, a history of two modes.

#include <cmath>

#include "wisp/model/model.hpp"

namespace wisp {

/// Segment k of the sample turns about z by this much a step, radians.
inline double sample_turn(std::size_t segment) { return 0.02 * static_cast<double>(segment + 1); }

/// A chain whose segments glide along x while turning about z, and sink. `motion` may leave orientation out.
inline Model sample_chain(ChainMotion motion = ChainMotion::kPose) {
  ChainModel chain;
  chain.motion = motion;
  chain.modes = 2;
  ChainSegments& segments = chain.segments;
  segments.mode = {0, 0, 1};
  segments.steps = {8, 5, 12};
  segments.row_scale = {1e-5};
  segments.rate_scale = {1e-4};
  const bool pose = motion == ChainMotion::kPose;
  if (pose) {
    segments.row_scale.push_back(1.0 / 32767);
    segments.rate_scale.push_back(1e-3);
  }
  const auto put = [](std::vector<std::int16_t>& out, double value) {
    out.push_back(static_cast<std::int16_t>(std::lround(value)));
  };
  for (std::size_t k = 0; k < segments.size(); ++k) {
    for (int step = 0; step <= segments.steps[k]; ++step) {
      for (double place : {0.01 * step, 0.001 * step * (1.0 + static_cast<double>(k)), -0.0125 * step})
        put(segments.rows, place / segments.row_scale[0]);
      if (!pose) continue;
      const double half = 0.5 * sample_turn(k) * step, tilt = 0.1 * static_cast<double>(k);
      for (double q : {std::cos(half) * std::cos(tilt), std::cos(half) * std::sin(tilt),
                       std::sin(half) * std::sin(tilt), std::sin(half) * std::cos(tilt)})
        put(segments.rows, q / segments.row_scale[1]);
    }
    for (int end = 0; end < 2; ++end) {
      for (double rate : {0.6, 0.06 * (1.0 + static_cast<double>(k)), -0.75})
        put(segments.rates, rate / segments.rate_scale[0]);
      if (!pose) continue;
      for (double rate : {0.0, 0.0, 60 * sample_turn(k)}) put(segments.rates, rate / segments.rate_scale[1]);
    }
  }
  segments.breadth = 2;
  segments.follow = {1, 0, 2, 2, 0, 1, 2, 2, 0, 1, 2, 2};
  chain.initial = {0.75, 0.25};
  chain.history = 2;
  chain.probabilities = {0.25, 0.75, 0.5, 0.5, 0.25, 0.75, 0.5, 0.5, 0.125, 0.875, 0.5, 0.5};
  Model model;
  model.name = "sample chain";
  model.rate_hz = 60;
  for (const char* name : {"pos.x", "pos.y", "pos.z"}) model.outputs.push_back({name, "m", -1, 1});
  if (pose) {
    for (const char* name : {"q.w", "q.x", "q.y", "q.z"}) model.outputs.push_back({name, "", -1, 1});
    model.view = PoseView{0.0365, 0.0245};
  } else {
    model.view = PositionView{0.02};
  }
  model.dynamics = chain;
  model.training = {"wisp 0.1.0", {"drops.csv"}, {{"event", "zero:forward_speed"}}, {{"segments", 3}}, {true, "yes"}};
  return model;
}

/// The sample, whose segments begin at heights of their own.
inline Model bounded_chain(ChainMotion motion = ChainMotion::kPose) {
  Model model = sample_chain(motion);
  ChainSegments& segments = std::get<ChainModel>(model.dynamics).segments;
  segments.height = {20000, 19000, 18500};
  segments.height_scale = 1e-4;
  return model;
}

/// The sample, which can be steered.
inline Model steered_chain() {
  Model model = sample_chain();
  std::get<ChainModel>(model.dynamics).drift = ChainDrift{.lead = {0, 0, 0, 200, 10, 0, -150, 40, 0},
                                                          .lead_scale = 1e-3,
                                                          .drift = {0, 0, -0.75},
                                                          .spread_ground = 0.05,
                                                          .spread_height = 0.01,
                                                          .memory_seconds = 0.4};
  return model;
}

/// The sample whose joins are left as they are.
inline Model unblended() {
  Model model = sample_chain();
  std::get<ChainModel>(model.dynamics).blend_steps = 0;
  return model;
}

/// The sample that can be steered, carried along by the wind within a few steps.
inline Model windy_chain() {
  Model model = steered_chain();
  GustResponse gust;
  gust.ground = {0.75, 0.25, 0};
  gust.vertical = {0.75, 0.25, 0};
  std::get<ChainModel>(model.dynamics).gust = gust;
  for (const char* name : {"wind.x", "wind.y", "wind.z"}) model.inputs.push_back({name, "m/s", -3, 3});
  return model;
}

}  // namespace wisp
