#pragma once
// The leaf's equations of motion, written out in docs/explanation/leaf.md.

#include "simulate/leaf/leaf.hpp"
#include "simulate/leaf/leaf_vector.hpp"

namespace wisp::leaf {

/// Constants of a leaf, with products precomputed.
struct Constants {
  Vec carried{};       // added mass
  Vec inverse_mass{};  // 1 / (m + added mass)
  Vec moment{};        // including the added one
  Vec inverse_moment{};
  double mass = 0;
  double weight = 0;                 // m g
  double lift = 0;                   // ρ S C_T
  double drag = 0, drag_normal = 0;  // ½ ρ S C_D0 and ½ ρ S (C_D90 − C_D0)
  double swirl_x = 0, swirl_y = 0;   // coefficient of rotational lift about each axis
  Vec damping_spin{}, damping_speed{};
};

/// Precondition: check(leaf) succeeds.
Constants constants_of(const Leaf& leaf);

/// Returns the time derivative of a state, in the same layout. The attitude may have any nonzero norm.
LeafState rate_of(const Constants& c, const LeafState& s, const WindSample& wind);

}  // namespace wisp::leaf
