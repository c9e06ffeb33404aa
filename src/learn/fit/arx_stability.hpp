#pragma once
// Poles of a model, and stabilisation of an unstable estimate.

#include <Eigen/Core>
#include <vector>

#include "wisp/model/arx.hpp"

namespace wisp {

/// Companion matrix of a set of outputs without coupling to other outputs: its eigenvalues are their poles.
Eigen::MatrixXd companion_of(const ArxModel& model, const std::vector<int>& outputs);

/// Where a group of coupled outputs has a pole beyond `max_radius`, scales all poles of the group by one factor, so
/// that the largest radius becomes share · max_radius. B and the constant move to their optimum for that A. `inverse`,
/// per output row: (XᵀX)⁻¹ of its regressors, laid out and scaled as in the model, with an estimated constant last.
///
/// Chosen on public data: least squares on the boundary of the stable set has the lower one-step loss but the larger
/// simulation error on unseen rows (docs/studies/identification.md).
///
/// Preconditions: 0 < max_radius < 1; one inverse per output row, positive semidefinite.
void make_stable(ArxModel& model, const std::vector<Eigen::MatrixXd>& inverse, double max_radius, double share = 1);

}  // namespace wisp
