#pragma once
// A rigid leaf falling through air: a thin elliptic plate under quasi-steady aerodynamics, 13 numbers of state.
//
// Source: the thin plate of A. Andersen, U. Pesavento & Z. J. Wang, Unsteady aerodynamics of fluttering and tumbling
// plates, J. Fluid Mech. 541 (2005), carried over to three dimensions: added mass and inertia of an ellipsoid (H. Lamb,
// Hydrodynamics, 1932, § 114), lift by translation and by rotation, drag, and damping of rotation.
// docs/explanation/leaf.md has the equations.

#include <array>

#include "wisp/base/result.hpp"
#include "wisp/simulate/leaf_wind.hpp"

namespace wisp {

/// A fitted set of coefficients of the air's forces, without dimension where nothing else is said.
struct LeafAir {
  double rotational_lift = 0.33;     ///< C_R, 0 … 10
  double translational_lift = 2.66;  ///< C_T, 0 … 10
  double drag_broadside = 3.09;      ///< C_D90, 0 … 20
  double drag_edgewise = 0.20;       ///< C_D0, 0 … 20
  double damping_by_speed = 0.57;    ///< μ, of rotation in a stream, 0 … 20
  double damping_by_spin = 5.7;      ///< C_r, of rotation in still air, 0 … 100
  double spin_drag = 0.05;           ///< C_3, of rotation in the leaf's own plane, 0 … 20
};

/// Fitted to discs let go vertically and, apart from that, horizontally: the default.
LeafAir leaf_air_joint();
/// Fitted to discs let go vertically only.
LeafAir leaf_air_vertical();

/// The leaf and the air it falls in. The default is the leaf of the training recordings.
struct Leaf {
  double length = 0.073;        ///< full axis along the midrib (body x), metres, 0.001 … 1
  double width = 0.049;         ///< full axis across it (body y), metres, 0.001 … length
  double areal_density = 0.07;  ///< kg/m², 0.001 … 10; 0.07 is office paper and many a dry leaf
  double air_density = 1.2;     ///< kg/m³, 0.01 … 100
  double gravity = 9.81;        ///< m/s², 0 … 100
  LeafAir air{};
};

/// Errors: a field outside its range.
Result<void> check(const Leaf& leaf);

/// Where the leaf is and how it moves. The body's axes: x along the midrib, y across, z the leaf's upper side.
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

/// How a state changes, in a state's own layout: attitude per second, position per second, and so on.
using LeafRate = LeafState;

/// The equations of motion. The attitude need not be a unit quaternion: its direction counts.
///
/// Precondition: check(leaf) is good.
LeafRate leaf_rate(const Leaf& leaf, const LeafState& state, const WindSample& wind);

/// Energy of leaf and carried air, in joules: of motion, and of height above z = 0. Never grows in still air.
double leaf_energy(const Leaf& leaf, const LeafState& state);

/// Velocity in the world's axes, m/s.
std::array<double, 3> leaf_world_velocity(const LeafState& state);

/// The leaf's upper side in the world's axes.
std::array<double, 3> leaf_normal(const LeafState& state);

/// A stall is a zero of this: the speed along the short axis, in the leaf's plane, m/s.
double leaf_forward_speed(const LeafState& state);

}  // namespace wisp
