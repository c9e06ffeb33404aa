#pragma once
// Figures that have the same shape in the result of every command.

#include "terminal.hpp"
#include "wisp/learn/arx_fit.hpp"
#include "wisp/model/model.hpp"

namespace wisp::cli {

Json json_of(const OrderMatrix& orders);
Json json_of(const Usable& usable);
Json json_of(std::span<const double> values);

/// `stable` {radius, changed, estimated_radius, loss_factor, moved_std_errors}.
Json json_of(const ArxStability& stability);

/// A[i][j] and B[i][j] of coefficients laid out as ArxModel::theta.
struct Coefficients {
  Json a;
  Json b;
};
Coefficients json_of(const ArxOrders& orders, const std::vector<std::vector<double>>& rows);

/// {k: …}, by number of steps.
Json by_steps(const std::vector<int>& steps, const std::vector<double>& values);

/// The mean over control points of figures that are one a number of steps and control point.
std::vector<double> mean_per_step(const std::vector<std::vector<double>>& per_step);

/// `cost` {multiply_adds_per_frame, operations_per_frame}, counted by running the model.
/// Errors: the model cannot be run.
Result<Json> cost_of(const Model& model);

}  // namespace wisp::cli
