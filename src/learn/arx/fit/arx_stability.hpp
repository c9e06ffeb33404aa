#pragma once
// The poles of a model, and an unstable estimate made stable.

#include <Eigen/Core>
#include <vector>

#include "wisp/model/arx.hpp"

namespace wisp {

/// The companion matrix of outputs that feed no others and are fed by none: its eigenvalues are their poles.
Eigen::MatrixXd companion_of(const ArxModel& model, const std::vector<int>& outputs);

/// Scales the poles of outputs that feed each other inwards alike, where one of them is beyond `max_radius`, so that it
/// comes to `share` of that; B and the constant follow with what is best for that A. `inverse`, an output row: (XᵀX)⁻¹
/// of its regressors, laid out and scaled as in the model; a constant, where it was estimated, is a last entry.
///
/// Chosen on public data: least squares on the boundary of the stable set loses less one step ahead and simulates
/// unseen rows worse (docs/studies/identification.md).
///
/// Preconditions: 0 < max_radius < 1; one inverse an output row, positive semidefinite.
void make_stable(ArxModel& model, const std::vector<Eigen::MatrixXd>& inverse, double max_radius, double share = 1);

}  // namespace wisp
