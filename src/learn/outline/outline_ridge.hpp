#pragma once
// Regularisation of outlines whose control points hear each other.
//
// Neighbouring control points move nearly alike, so that least squares tells their coefficients apart by noise, and the
// estimate is unstable or simulates badly. A ridge (A. E. Hoerl and R. W. Kennard, Technometrics 12 (1970)) keeps the
// coefficients small; how strong it is, held-out data say.

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "learn/arx/fit/arx_fit.hpp"
#include "learn/outline/outline_preparation.hpp"
#include "wisp/base/result.hpp"
#include "wisp/model/arx.hpp"

namespace wisp {

/// A ridge that was tried.
struct RidgeCandidate {
  double ridge = 0;     ///< ArxOptions::ridge
  double error = 0;     ///< on held-out data: mean norm of the control points' error, model units
  bool stable = false;  ///< the estimate was stable as it came
};

/// Which ridge, and why.
struct RidgeChoice {
  std::vector<RidgeCandidate> candidates;  ///< empty: none was tried
  double ridge = 0;  ///< of the least error among stable estimates; among all where none is stable
  std::string reason;
};

/// Estimates a model with a ridge.
using RidgeFit = std::function<Result<ArxFit>(double ridge)>;

/// Tries ridges of nothing to a tenth of the regressors' energy. Errors are of free simulation where inputs drive the
/// outline, and else half a second ahead.
/// Errors: as `fit`.
Result<RidgeChoice> choose_ridge(const RidgeFit& fit, std::span<const Recording> held_out,
                                 const PreparedOutlines& prepared, const ArxOrders& orders);

}  // namespace wisp
