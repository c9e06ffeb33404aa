#pragma once
// A switched fit as a report.

#include "learn/switched/switched_fit.hpp"
#include "wisp/base/report.hpp"

namespace wisp::switched {

/// Coefficients of every mode with standard errors first, then the numbers of modes that were tried, how often each
/// acts, in what they differ, and how good the fit is; warnings and verdict.
void add_fit(const SwitchedFit& fit, const Model& model, Report& report);

}  // namespace wisp::switched
