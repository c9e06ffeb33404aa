#pragma once
// A small chain for tests: two modes, three segments, poses, histories of one and two modes.

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
  chain.contexts = {{{0}, {0.25, 0.75}}, {{1}, {0.5, 0.5}}, {{1, 0}, {0.125, 0.875}}};
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

/// The sample without long histories, whose segments say what follows them: after the first, mode 0 is five times as
/// likely as its history has it; after the second there is mode 1.
inline Model weighted_chain() {
  Model model = sample_chain();
  auto& chain = std::get<ChainModel>(model.dynamics);
  chain.contexts.pop_back();
  chain.segments.successor_weights = {65535, 13107, 1, 65535, 65535, 65535};
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

/// Two modes that are systems: one sinks steadily, the other swings and tumbles with noise.
inline Model system_chain(int degree = 1) {
  Model model = sample_chain();
  auto& chain = std::get<ChainModel>(model.dynamics);
  ChainSegments& segments = chain.segments;
  segments.mode = {0, 1};
  segments.steps = {8, 5};
  segments.rows.resize((9 + 6) * 7);
  segments.rates.resize(2 * 12);
  segments.breadth = 0;
  segments.follow.clear();
  const std::size_t terms = system_terms(degree);
  ModeSystems systems{degree, std::vector<ModeSystem>(2)};
  for (ModeSystem& mode : systems.modes) {
    mode.coefficient.assign(kSystemStates * terms, 0.0);
    mode.noise.assign(kSystemStates * kSystemStates, 0.0);
    for (std::size_t k = 0; k < kSystemStates; ++k) {
      mode.coefficient[k * terms + 1 + k] = 0.9;
      mode.lowest[k] = k < 3 ? -1.5 : -8;
      mode.highest[k] = -mode.lowest[k];
    }
    mode.steps = {4, 5, 5, 6, 6, 6, 7, 7, 8, 8, 9, 9, 10, 11, 12, 15};
    // Falls along what is down for it.
    for (std::size_t k = 0; k < 3; ++k) mode.coefficient[k * terms + 7 + k] = -0.08;
  }
  for (std::size_t k = 0; k < kSystemStates; ++k) systems.modes[1].noise[k * 7] = k < 3 ? 0.05 : 0.6;
  systems.modes[1].noise[6] = -0.02;
  if (degree == 2) systems.modes[1].coefficient[3 * terms + 20] = 0.4;
  chain.systems = systems;
  return model;
}

/// The sample that can be steered, its modes splines: each segment glides its own way, tilted its own way.
inline Model spline_chain() {
  Model model = steered_chain();
  auto& chain = std::get<ChainModel>(model.dynamics);
  ModeSplines splines{4, 2, {}, {}, {1000, -2000, -500, 3000, 0, 700}};
  for (int mode = 0; mode < 2; ++mode) {
    for (int k = 0; k < 4; ++k) {
      const auto at = static_cast<float>(k), side = static_cast<float>(mode + 1);
      for (float x : {2700 * at, 200 * side * at, -3300 * at, 30'000.0f, 1500 * side, 0.0f, 900 * at})
        splines.mean.push_back(x);
    }
    for (int component = 0; component < 2; ++component) {
      for (int k = 0; k < 4; ++k) {
        const float glide = component == 0 ? 0.25f * static_cast<float>(k) : 0.0f;
        const float tilt = component == 1 ? 1.5f : 0.0f;
        for (float x : {glide, 0.0f, -0.5f * glide, 0.0f, tilt, 0.5f * tilt, 0.0f}) splines.component.push_back(x);
      }
    }
  }
  chain.segments.rows = rows_of(splines, chain.segments, 7);
  chain.splines = splines;
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
  gust.ground = {{0.75, 0.0}, {0.25, 0.0}, {0.0, 0.0}};
  gust.vertical = {{0.5, 0.25}, {0.125, 0.125}, {0.0, 0.0}};
  std::get<ChainModel>(model.dynamics).gust = gust;
  for (const char* name : {"wind.x", "wind.y", "wind.z"}) model.inputs.push_back({name, "m/s", -3, 3});
  return model;
}

}  // namespace wisp
