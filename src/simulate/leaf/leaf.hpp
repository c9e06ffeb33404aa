#pragma once
// A rigid leaf falling through air: a thin elliptic plate under quasi-steady aerodynamics, 13 numbers of state.
//
// Source: the thin plate of A. Andersen, U. Pesavento & Z. J. Wang, Unsteady aerodynamics of fluttering and tumbling
// plates, J. Fluid Mech. 541 (2005), carried over to three dimensions: added mass and inertia of an ellipsoid (H. Lamb,
// Hydrodynamics, 1932, § 114), lift by translation and by rotation, drag, and damping of rotation.
// docs/explanation/leaf.md has the equations.

#include <array>

#include "simulate/leaf/leaf_wind.hpp"
#include "wisp/base/result.hpp"
#include "wisp/simulate/leaf_drops.hpp"

namespace wisp {

/// Errors: a field outside its range.
Result<void> check(const Leaf& leaf);

/// Pose and motion of the leaf. The body's axes: x along the midrib, y across, z the leaf's upper side.
struct LeafState {
  std::array<double, 4> attitude{1, 0, 0, 0};  ///< unit quaternion, w first, leaf to world
  std::array<double, 3> position{};            ///< metres, z up
  std::array<double, 3> velocity{};            ///< of the middle, in the body's axes, m/s
  std::array<double, 3> spin{};                ///< in the body's axes, rad/s
};

/// Inertia of the leaf and of the air that it carries along, about the body's axes.
struct LeafInertia {
  double mass = 0;                       ///< kg
  std::array<double, 3> moment{};        ///< kg m²
  std::array<double, 3> added_mass{};    ///< kg
  std::array<double, 3> added_moment{};  ///< kg m²
};

/// Precondition: check(leaf) is good.
LeafInertia leaf_inertia(const Leaf& leaf);

/// Kinetic and potential energy of leaf and carried air, in joules, relative to z = 0. Never grows in still air.
double leaf_energy(const Leaf& leaf, const LeafState& state);

/// Velocity in the world's axes, m/s.
std::array<double, 3> leaf_world_velocity(const LeafState& state);

/// The leaf's upper side in the world's axes.
std::array<double, 3> leaf_normal(const LeafState& state);

}  // namespace wisp
