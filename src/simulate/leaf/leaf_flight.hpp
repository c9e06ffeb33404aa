#pragma once
// The fall of one leaf: its equations of motion, written out in docs/explanation/leaf.md, solved by Runge-Kutta steps
// of fourth order. docs/studies/leaf.md compares step lengths.

#include <vector>

#include "simulate/leaf/leaf.hpp"
#include "simulate/leaf/leaf_wind.hpp"
#include "wisp/base/result.hpp"

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

namespace wisp {

/// A leaf in the air, advanced by advance(); equal calls give equal bits.
class LeafFlight {
 public:
  /// Starts a leaf in a state, at time 0; the wind is kept by reference and must outlive the flight. Steps are
  /// `longest_step` seconds at most, 1e-6 … 0.05, and in strong wind shorter in inverse proportion to its speed.
  /// Errors: leaf or step out of range, a state that is not finite, an attitude of norm 0.
  static Result<LeafFlight> begin(const Leaf& leaf, const LeafWind& wind, const LeafState& state,
                                  double longest_step = 1.0 / 60);

  /// Advances by `seconds`, divided into equal steps.
  /// Errors: the leaf's state is no longer finite.
  ///
  /// Precondition: seconds > 0.
  Result<void> advance(double seconds);

  const LeafState& state() const { return state_; }
  double seconds() const { return seconds_; }

  /// Returns the times of the stalls so far (zeros of the forward speed, linear between steps), in seconds.
  const std::vector<double>& stalls() const { return stalls_; }

 private:
  LeafState rate(const LeafState& s, double at) const;
  void step(double h);

  leaf::Constants constants_;
  const LeafWind* wind_ = nullptr;
  double longest_step_ = 0;
  LeafState state_;
  double seconds_ = 0;
  std::vector<double> stalls_;
};

}  // namespace wisp
