#pragma once
// Expectation–maximisation of modes and of what decides between them.

#include <vector>

#include "learn/switched/switched_rows.hpp"

namespace wisp {

struct RefinedModes {
  ScaledModes modes;
  Eigen::MatrixXd weights;    ///< rows × modes: how much of each row belongs to each mode
  double log_likelihood = 0;  ///< of all rows together
};

/// What bounds a mode's residuals from below: a hundredth of the single model's, per output, squared.
Eigen::VectorXd min_variance(const SwitchedRows& rows);

/// Improves a first sorting of the rows until the likelihood grows no more, for at most `rounds` rounds.
RefinedModes refine(const SwitchedRows& rows, Switching switching, const std::vector<int>& first, int modes,
                    const Eigen::VectorXd& least, int rounds);

/// The same from where an earlier call ended.
RefinedModes refine_further(const SwitchedRows& rows, const RefinedModes& from, const Eigen::VectorXd& least,
                            int rounds);

/// Lower factor of the covariance of weighted residuals, its variances at least `least`.
Eigen::MatrixXd residual_factor(const Eigen::MatrixXd& residual, const Eigen::VectorXd& weights,
                                const Eigen::VectorXd& least);

}  // namespace wisp
