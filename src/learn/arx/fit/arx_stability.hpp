#pragma once
// An unstable estimate, re-estimated under the constraint that it is stable.

#include <Eigen/Core>
#include <vector>

#include "wisp/model/arx.hpp"

namespace wisp {

/// The quadratic loss of one output row around its estimate: loss = (θ − θ̂)ᵀ inverse⁻¹ (θ − θ̂) · weight. θ is laid out
/// and scaled as in the model; a constant, where it was estimated, is a last entry of the inverse.
struct RowCurvature {
  Eigen::MatrixXd inverse;
  double weight = 1;
};

/// Changes the coefficients so that no pole's radius is above `max_radius`, with as little loss as it can: A moves on
/// the constraint, and B and the constant follow with what is best for that A; where outputs that feed each other have
/// more than 100 poles, all of theirs are scaled inwards alike. Returns the change in loss.
///
/// Preconditions: 0 < max_radius < 1; one curvature an output row, positive semidefinite.
double make_stable(ArxModel& model, const std::vector<RowCurvature>& curvature, double max_radius);

/// Multiplies every pole with `factor`: a coefficient at lag l with factor to the power of l.
void scale_poles(ArxModel& model, double factor);

}  // namespace wisp
