#pragma once
// What a triangular factor knows, and its bytes.

#include <cstddef>
#include <span>
#include <vector>

#include "learn/arx/fit/triangular_factor.hpp"
#include "wisp/base/result.hpp"

namespace wisp {

Result<void> check_factor_options(const FactorOptions& options);

/// Errors: the parts are of different models; which of channels, orders, first sample or rate differs.
Result<void> check_same_model(const FactorState& state, const FactorState& other);

std::vector<std::byte> factor_bytes(const FactorState& state);

/// Errors: as TriangularFactor::from_bytes.
Result<FactorState> factor_from_bytes(std::span<const std::byte> bytes);

}  // namespace wisp
