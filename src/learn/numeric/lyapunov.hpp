#pragma once
// Whether switching among stable modes can make them diverge: the search for a common quadratic Lyapunov function.
//
// Source: S. Boyd & L. El Ghaoui, Method of centers for minimizing generalized eigenvalues, Linear Algebra and its
// Applications 188–189 (1993); D. Liberzon, Switching in Systems and Control (2003), section 2.1. The search minimises
// the rate γ² for which AₖᵀPAₖ ≤ γ²P in every mode; at γ < 1 no order of the modes makes the model diverge. Where it
// ends above 1 there may still be another reason for stability: a quadratic function is sufficient, not necessary.

#include <optional>
#include <vector>

#include "wisp/model/switched.hpp"

namespace wisp {

inline constexpr int kMaxSearchedStates = 16;  ///< of a block; beyond, the search's unknowns become too many

/// A symmetric positive definite P, states × states, row-major, with AₖᵀPAₖ < P for all of the block's matrices.
/// Nothing where the search finds none, or where the block is larger than kMaxSearchedStates.
std::optional<std::vector<double>> find_common_lyapunov(const StateBlock& block);

/// One for every block of the model; empty where one of them has none.
std::vector<std::vector<double>> find_common_lyapunov(const SwitchedArxModel& model);

}  // namespace wisp
