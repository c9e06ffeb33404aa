#pragma once
// The leaf under SUNDIALS' CVODE: backward differentiation, dense Newton iteration, attitude projected to length 1,
// stalls found as roots.

#include <cstdint>
#include <memory>
#include <vector>

#include "simulate/leaf/leaf_stepper.hpp"
#include "simulate/leaf/leaf_wind.hpp"
#include "wisp/base/result.hpp"

namespace wisp::leaf {

class StiffIntegrator {
 public:
  /// The wind is kept by reference. Errors: CVODE has no memory.
  static Result<StiffIntegrator> begin(const Constants<double>& constants, const LeafWind& wind,
                                       const State<double>& state, double seconds, double tolerance);

  StiffIntegrator(StiffIntegrator&&) noexcept;
  ~StiffIntegrator();

  /// Integrates to a later time and returns the state there; stalls on the way are appended to `stalls`.
  /// Errors: CVODE gives up; the message is its own.
  Result<State<double>> advance_to(double seconds, std::vector<double>& stalls);

  /// Evaluations of the equations, those for Jacobians included.
  std::int64_t evaluations() const;

 private:
  struct Solver;
  explicit StiffIntegrator(std::unique_ptr<Solver> solver);
  std::unique_ptr<Solver> solver_;
};

}  // namespace wisp::leaf
