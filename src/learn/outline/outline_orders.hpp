#pragma once
// Orders of an outline's equations: from options, or searched.

#include "learn/outline/outline_fit.hpp"
#include "learn/outline/outline_preparation.hpp"
#include "wisp/base/result.hpp"
#include "wisp/model/arx.hpp"

namespace wisp {

/// The order matrices of an outline's control points: as many lags of outputs as of inputs, and twice as many of an
/// input whose powers are regressors too.
///
/// Precondition: order >= 1, delay >= 0.
ArxOrders outline_orders(int order, int delay, OutlineCoupling coupling, const PreparedOutlines& prepared);

/// Chooses the order, the delay or both where the options leave them open, and says why; otherwise says what was given.
/// `learned` are the recordings to estimate from, mirror images included, `held_out` those to judge on (may be empty).
/// Errors: too few rows for the lowest order.
Result<OutlineChoice> choose_orders(std::span<const Recording> learned, std::span<const Recording> held_out,
                                    const PreparedOutlines& prepared, const OutlineRecipe& options);

}  // namespace wisp
