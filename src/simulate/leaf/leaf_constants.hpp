#pragma once
// Precomputed constants of a leaf.

#include "simulate/leaf/leaf.hpp"
#include "simulate/leaf/leaf_equations.hpp"

namespace wisp::leaf {

/// Precondition: check(leaf) is good.
Constants<double> constants_of(const Leaf& leaf);

inline State<double> state_of(const LeafState& s) {
  return {quaternion_of(s.attitude), vec_of(s.position), vec_of(s.velocity), vec_of(s.spin)};
}

inline LeafState plain(const State<double>& s) {
  return {{s.attitude.w, s.attitude.x, s.attitude.y, s.attitude.z},
          array_of(s.position),
          array_of(s.velocity),
          array_of(s.spin)};
}

inline Air<double> air_of(const WindSample& wind) { return {vec_of(wind.velocity), vec_of(wind.change)}; }

}  // namespace wisp::leaf
