#pragma once
// Figures that have the same shape in the result of every command.

#include "terminal.hpp"
#include "wisp/model/model.hpp"

namespace wisp::cli {

Json json_of(const OrderMatrix& orders);
Json json_of(const Usable& usable);
Json json_of(std::span<const double> values);

/// `cost` {multiply_adds_per_frame, operations_per_frame}, counted by running the model.
/// Errors: the model cannot be run.
Result<Json> cost_of(const Model& model);

}  // namespace wisp::cli
