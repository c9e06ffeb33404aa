#pragma once
// Where the estimation of modes starts: rows sorted into modes by models that are local in the space of regressors, or
// in time.

#include <cstdint>
#include <vector>

#include "learn/switched/switched_rows.hpp"

namespace wisp {

/// A first mode for every row, by clustering local models. Precondition: modes >= 1, neighbours >= 1.
std::vector<int> clustered_start(const SwitchedRows& rows, Switching switching, int modes, int neighbours,
                                 std::uint64_t seed);

/// By as many local models as there are modes, at places drawn by chance: each row has the one that fits it best.
std::vector<int> drawn_start(const SwitchedRows& rows, Switching switching, int modes, int neighbours,
                             std::uint64_t seed);

/// Least squares of weighted rows, theta as in ScaledModes.
Eigen::MatrixXd weighted_theta(const SwitchedRows& rows, const Eigen::VectorXd& weights);

}  // namespace wisp
