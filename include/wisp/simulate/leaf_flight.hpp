#pragma once
// One leaf on its way down, by a stiff integrator or by the cheapest fixed step that gives the same statistics.
//
// Falls are chaotic: two methods give two paths, and the same statistics. docs/studies/leaf.md has both methods' side
// by side.

#include <cstdint>
#include <memory>
#include <vector>

#include "wisp/base/result.hpp"
#include "wisp/simulate/leaf.hpp"

namespace wisp {

/// How the equations are integrated.
enum class LeafMethod {
  kClassical,  ///< four evaluations a step, fourth order: the cheapest whose statistics agree at 1/60 s a step
  kRalston,    ///< three evaluations a step, third order: 0.7 % fewer stalls at 1/60 s
  kMidpoint,   ///< two evaluations a step, second order: falls 4 % too fast at 1/60 s
  kStiff,      ///< backward differentiation of variable order and step, with an error bound, by SUNDIALS' CVODE
};

struct LeafStepping {
  LeafMethod method = LeafMethod::kClassical;
  double longest_step = 1.0 / 60;  ///< seconds, 1e-6 … 0.05: of the fixed steps; the fastest decay is about 100/s
  double tolerance = 1e-8;         ///< relative, 1e-12 … 1e-3: of the stiff method
};

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

  /// Moves on; a fixed step divides `seconds` evenly.
  /// Errors: the integrator gives up, or the leaf's state is no longer finite.
  ///
  /// Precondition: seconds > 0.
  Result<void> advance(double seconds);

  const LeafState& state() const;
  double seconds() const;

  /// When it stalled so far: zeros of the forward speed, in seconds. The stiff method finds them to its tolerance, the
  /// others in a straight line between steps.
  const std::vector<double>& stalls() const;

  /// Evaluations of the equations so far.
  std::int64_t evaluations() const;

 private:
  struct Course;
  explicit LeafFlight(std::unique_ptr<Course> course);
  std::unique_ptr<Course> course_;
};

}  // namespace wisp
