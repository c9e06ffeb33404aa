#pragma once
// The fall of one leaf, by a stiff integrator or by fixed steps with the same statistics.
//
// Falls are chaotic: two methods give two paths, and the same statistics. docs/studies/leaf.md has both methods' side
// by side.

#include <cstdint>
#include <memory>
#include <vector>

#include "simulate/leaf/leaf.hpp"
#include "wisp/base/result.hpp"

namespace wisp {

/// A leaf in the air. Moves in time by advance(); the same calls give the same bits.
class LeafFlight {
 public:
  /// A leaf at a state and time; the wind is kept by reference and must outlive the flight.
  /// Errors: leaf or stepping out of range, a state that is not finite, an attitude of length 0.
  static Result<LeafFlight> begin(const Leaf& leaf, const LeafWind& wind, const LeafState& state,
                                  const LeafStepping& stepping = {}, double seconds = 0);

  LeafFlight(LeafFlight&&) noexcept;
  LeafFlight& operator=(LeafFlight&&) noexcept;
  ~LeafFlight();

  /// Advances by `seconds`, divided evenly into fixed steps.
  /// Errors: the integrator gives up, or the leaf's state is no longer finite.
  ///
  /// Precondition: seconds > 0.
  Result<void> advance(double seconds);

  const LeafState& state() const;
  double seconds() const;

  /// Times of the stalls so far (zeros of the forward speed), in seconds. The stiff method finds them to its tolerance,
  /// the others in a straight line between steps.
  const std::vector<double>& stalls() const;

  /// Evaluations of the equations so far.
  std::int64_t evaluations() const;

 private:
  struct Course;
  explicit LeafFlight(std::unique_ptr<Course> course);
  std::unique_ptr<Course> course_;
};

}  // namespace wisp
