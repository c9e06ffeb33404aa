#pragma once
// What a learned outline says of itself: whether to use it, and how it was made.

#include <span>
#include <string_view>

#include "learn/outline/outline_fit.hpp"

namespace wisp {

/// Rows that a coefficient of an output wants, at least.
inline constexpr int kMinRowsACoefficient = 4;

/// Coefficients of the output that has most.
int max_coefficients(const ArxOrders& orders);

/// Whether the model may be used, with the first reason against it or a sentence in its favour.
Usable outline_verdict(const ArxSummary& fit, const OutlineSummary& summary);

/// What the model's file says of how it was made, but for a rule of extinction and the cost.
Training outline_training(std::span<const Recording> recordings, const OutlineRecipe& options,
                          const OutlineSummary& summary);

}  // namespace wisp
