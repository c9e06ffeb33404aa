#pragma once
// The fall of one leaf, by Runge-Kutta steps of fourth order. docs/studies/leaf.md compares lengths of the step.

#include <memory>
#include <vector>

#include "simulate/leaf/leaf.hpp"
#include "wisp/base/result.hpp"

namespace wisp {

/// A leaf in the air. Moves in time by advance(); the same calls give the same bits.
class LeafFlight {
 public:
  /// A leaf at a state, at time 0; the wind is kept by reference and must outlive the flight. Steps are `longest_step`
  /// seconds at most, 1e-6 … 0.05, and in strong wind shorter in proportion to its speed.
  /// Errors: leaf or step out of range, a state that is not finite, an attitude of length 0.
  static Result<LeafFlight> begin(const Leaf& leaf, const LeafWind& wind, const LeafState& state,
                                  double longest_step = 1.0 / 60);

  LeafFlight(LeafFlight&&) noexcept;
  LeafFlight& operator=(LeafFlight&&) noexcept;
  ~LeafFlight();

  /// Advances by `seconds`, divided evenly into fixed steps.
  /// Errors: the leaf's state is no longer finite.
  ///
  /// Precondition: seconds > 0.
  Result<void> advance(double seconds);

  const LeafState& state() const;
  double seconds() const;

  /// Times of the stalls so far (zeros of the forward speed, linear between steps), in seconds.
  const std::vector<double>& stalls() const;

 private:
  struct Course;
  explicit LeafFlight(std::unique_ptr<Course> course);
  std::unique_ptr<Course> course_;
};

}  // namespace wisp
