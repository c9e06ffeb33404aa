#pragma once
// A model of every kind of dynamics, noise and view.

#include <vector>

#include "model/sample_chain.hpp"
#include "model/sample_model.hpp"
#include "model/sample_switched.hpp"
#include "run/flame_model.hpp"

namespace wisp::fuzz {

inline const std::vector<Model>& kinds() {
  static const std::vector<Model> all = [] {
    Model gaussian = flame_model({.points = 4, .wind = InputShape::kEvenOdd});
    gaussian.extinction.emplace();
    return std::vector<Model>{gaussian,
                              default_flame_model(),
                              coupled_flame_model(),
                              flame_model({.points = 5, .resampled_rows = 60}),
                              sample_model(),
                              sample_switched(),
                              sample_chain(ChainMotion::kPosition),
                              steered_chain(),
                              unblended(),
                              windy_chain(),
                              bounded_chain()};
  }();
  return all;
}

}  // namespace wisp::fuzz
