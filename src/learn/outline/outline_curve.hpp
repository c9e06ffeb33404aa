#pragma once
// Input nonlinearities of an outline (Hammerstein curves): which are kept, and recordings with them applied.

#include <span>
#include <vector>

#include "learn/outline/outline_fit.hpp"
#include "learn/outline/outline_preparation.hpp"
#include "wisp/base/result.hpp"

namespace wisp {

/// Whether inputs pass a nonlinearity, and of how many knots: as given, or as held-out free runs over the prepared
/// recordings say, learned with their mirror images where the model learns from them.
/// Errors: as choose_input_curves().
Result<CurveChoice> choose_outline_curves(const PreparedOutlines& prepared, bool mirror, const ArxOrders& orders,
                                          std::optional<int> knots);

/// The curves of prepared recordings, one an input.
/// Errors: as fit_input_curves().
Result<std::vector<CurveEstimate>> outline_curves(std::span<const Recording> recordings,
                                                  const PreparedOutlines& prepared, const ArxOrders& orders, int knots);

/// Prepared recordings, or parts of them, with their inputs passed through the curves.
std::vector<Recording> bent_outlines(std::span<const Recording> recordings, const PreparedOutlines& prepared,
                                     std::span<const CurveEstimate> curves);

/// The same of all that was prepared; its inputs have the curves then.
PreparedOutlines bent_preparation(PreparedOutlines prepared, std::span<const CurveEstimate> curves);

}  // namespace wisp
