#pragma once
// Noise that gives a model of independent control points the flicker of a whole outline.
//
// Least squares leaves, for every control point, a residual. Its standard deviation is what the paper feeds back as
// noise (section 3.4.1), drawn apart for every channel; but an outline whose points are shaken apart wobbles and folds
// over itself. Here shocks are shared: e = M v with v of a few standard normal numbers. And M is chosen not from the
// residuals' own covariance but such that the covariance of the whole outline at rest is that of the recording, in so
// far as the points' dynamics allow it: with dynamics F_i, F_j of two points, their stationary covariance
// P_ij = Σ H_i(t) Q_ij H_j(t)ᵀ, H the impulse responses, is linear in the covariance Q_ij of their shocks (the discrete
// Lyapunov equation: L. Ljung, System Identification (2nd ed.), section 4.3; T. Kailath, Linear Systems, section 2.6),
// so Q_ij follows from the P_ij that is wanted. The result is made positive semi-definite and of low rank, and its rows
// are scaled until every channel's variance is the wanted one exactly.

#include <Eigen/Core>
#include <span>
#include <vector>

#include "wisp/model/arx.hpp"

namespace wisp {

using Covariance = Eigen::MatrixXd;

/// The stationary covariance of a model's deviations under shocks of covariance `shocks`, ny × ny.
///
/// Precondition: the model is stable.
Covariance stationary_covariance(const ArxModel& model, const Covariance& shocks);

/// The covariance of shocks, not always positive semi-definite, under which the stationary covariance is `wanted`.
///
/// Precondition: the model is stable; `wanted` is symmetric, ny × ny; blocks of outputs that feed each other are small
/// (two outputs of a point): the cost goes as the sixth power of a block's size.
Covariance shocks_for(const ArxModel& model, const Covariance& wanted);

/// M, ny × rank or narrower, with M Mᵀ as near to `shocks` as that rank allows when every channel counts alike.
///
/// Precondition: rank >= 1.
Eigen::MatrixXd shared_factor(const Covariance& shocks, int rank);

/// Scales the rows of M so that the stationary variances under shocks M Mᵀ are those of `wanted`.
/// Returns whether they are, within 1 %; a channel that cannot be reached is left near.
bool scale_to_variance(const ArxModel& model, const Covariance& wanted, Eigen::MatrixXd& factor);

}  // namespace wisp
