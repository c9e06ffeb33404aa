#include "simulate/leaf/leaf.hpp"

#include <cmath>
#include <numbers>

#include "simulate/option_range.hpp"

namespace wisp {
namespace {

using std::numbers::pi;

// Lamb's integrals of an ellipsoid in the limit of zero thickness, divided by the thickness, along the long and the
// short axis. With λ = b² tan²θ they become integrals of smooth functions over a quarter of their period, where
// equidistant sums converge faster than any power of the step.
struct LambIntegrals {
  double long_axis = 0;
  double short_axis = 0;
};

LambIntegrals lamb_integrals(double a, double b) {
  constexpr int kSteps = 1024;
  LambIntegrals sum;
  for (int k = 0; k < kSteps; ++k) {
    const double angle = (k + 0.5) / kSteps * pi / 2;
    const double cos2 = std::cos(angle) * std::cos(angle);
    const double across = std::sqrt(a * a * cos2 + b * b * (1 - cos2));
    sum.long_axis += cos2 / (across * across * across);
    sum.short_axis += cos2 / across;
  }
  const double step = pi / 2 / kSteps;
  return {2 * a * b * step * sum.long_axis, 2 * a / b * step * sum.short_axis};
}

}  // namespace

Result<void> check(const Leaf& leaf) {
  return flow::check_ranges("leaf", {
                                        {"length in metres", leaf.length, 0.001, 1},
                                        {"width in metres", leaf.width, 0.001, leaf.length},
                                        {"areal density in kg/m²", leaf.areal_density, 0.001, 10},
                                        {"air density in kg/m³", leaf.air_density, 0.01, 100},
                                        {"gravity in m/s²", leaf.gravity, 0, 100},
                                        {"rotational lift", leaf.air.rotational_lift, 0, 10},
                                        {"translational lift", leaf.air.translational_lift, 0, 10},
                                        {"drag broadside", leaf.air.drag_broadside, 0, 20},
                                        {"drag edgewise", leaf.air.drag_edgewise, 0, leaf.air.drag_broadside},
                                        {"damping by speed", leaf.air.damping_by_speed, 0, 20},
                                        {"damping by spin", leaf.air.damping_by_spin, 0, 100},
                                        {"spin drag", leaf.air.spin_drag, 0, 20},
                                    });
}

LeafInertia leaf_inertia(const Leaf& leaf) {
  const double a = leaf.length / 2, b = leaf.width / 2;
  LeafInertia inertia;
  inertia.mass = leaf.areal_density * pi * a * b;
  const double quarter = inertia.mass / 4;
  inertia.moment = {quarter * b * b, quarter * a * a, quarter * (a * a + b * b)};
  // A plate without thickness has added mass only broadside, and added inertia only about the axes in its plane.
  const LambIntegrals lamb = lamb_integrals(a, b);
  const double air = 8 * pi / 3 * leaf.air_density * a * b;
  inertia.added_mass = {0, 0, air / (lamb.long_axis + lamb.short_axis)};
  inertia.added_moment = {air * b * b / 5 / (lamb.long_axis + 2 * lamb.short_axis),
                          air * a * a / 5 / (lamb.short_axis + 2 * lamb.long_axis), 0};
  return inertia;
}

double leaf_energy(const Leaf& leaf, const LeafState& state) {
  const LeafInertia inertia = leaf_inertia(leaf);
  double energy = inertia.mass * leaf.gravity * state.position[2];
  for (std::size_t k = 0; k < 3; ++k) {
    energy += (inertia.mass + inertia.added_mass[k]) * state.velocity[k] * state.velocity[k] / 2;
    energy += (inertia.moment[k] + inertia.added_moment[k]) * state.spin[k] * state.spin[k] / 2;
  }
  return energy;
}

std::array<double, 3> leaf_world_velocity(const LeafState& state) {
  return leaf::rotation_of(state.attitude)(state.velocity);
}

std::array<double, 3> leaf_normal(const LeafState& state) { return leaf::rotation_of(state.attitude)({0, 0, 1}); }

}  // namespace wisp
