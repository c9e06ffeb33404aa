#pragma once
// A rigid leaf falling through air: a thin elliptic plate under quasi-steady aerodynamics, 13 state variables.
//
// Source: the thin plate of A. Andersen, U. Pesavento & Z. J. Wang, Unsteady aerodynamics of fluttering and tumbling
// plates, J. Fluid Mech. 541 (2005), extended to three dimensions: added mass and inertia of an ellipsoid (H. Lamb,
// Hydrodynamics, 1932, § 114), lift by translation and by rotation, drag, and damping of rotation.
// docs/explanation/leaf.md has the equations.

#include <array>

#include "wisp/base/result.hpp"
#include "wisp/simulate/leaf_drops.hpp"

namespace wisp {

/// Errors: a field outside its range.
Result<void> check(const Leaf& leaf);

/// Pose and motion of the leaf. Body axes: x along the midrib, y across, z the leaf's upper side.
struct LeafState {
  std::array<double, 4> attitude{1, 0, 0, 0};  ///< unit quaternion, w first, leaf to world
  std::array<double, 3> position{};            ///< metres, z up
  std::array<double, 3> velocity{};            ///< velocity of the centre, in body axes, m/s
  std::array<double, 3> spin{};                ///< angular velocity in body axes, rad/s
};

/// Inertia of the leaf and added inertia of the air, about the body axes.
struct LeafInertia {
  double mass = 0;                       ///< kg
  std::array<double, 3> moment{};        ///< kg m²
  std::array<double, 3> added_mass{};    ///< kg
  std::array<double, 3> added_moment{};  ///< kg m²
};

/// Precondition: check(leaf) succeeds.
LeafInertia leaf_inertia(const Leaf& leaf);

/// Returns the energy of leaf and added mass, kinetic and potential above z = 0, joules. Never grows in still air.
double leaf_energy(const Leaf& leaf, const LeafState& state);

/// Returns the velocity in world axes, m/s.
std::array<double, 3> leaf_world_velocity(const LeafState& state);

/// Returns the normal of the leaf's upper side in world axes.
std::array<double, 3> leaf_normal(const LeafState& state);

}  // namespace wisp
