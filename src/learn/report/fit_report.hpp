#pragma once
// Reports on an ARX model, on the quality of a fit and on an order search.

#include <span>
#include <string>
#include <vector>

#include "learn/choose/focus.hpp"
#include "learn/choose/order_search.hpp"
#include "learn/fit/arx_fit.hpp"
#include "learn/judge/residual_tests.hpp"
#include "wisp/base/report.hpp"

namespace wisp::arx {

/// Adds for programs `A`, `B`, `std_error`, `poles`, `zeros` [output][input] (lists of [real, imaginary] in the z
/// plane) and `static_gain` [output][input], with `prefix` before their ids. Poles are null where the companion matrix
/// has more than 256 rows, and zeros where it has more than 48.
void describe(const ArxModel& model, const std::string& prefix, ReportSection& section);

/// Adds for people: one section per output with its coefficients and standard errors, and one with the poles as time
/// constants and damped resonances; nothing for models with many of them.
void tell(const ArxModel& model, const Model& of, Report& report);

/// Adds for people the poles alone.
void tell_poles(const ArxModel& model, double rate_hz, Report& report);

/// Adds coefficients with standard errors, then every figure of the summary, warnings and verdict. `model` is the fit's
/// model with its channel names.
void add_fit(const ArxFit& fit, const Model& model, Report& report);

/// Adds all candidates, the best with its runners-up by the criterion, and the best of each output alone.
void add_search(const OrderSearch& search, const std::vector<std::string>& outputs, OrderCriterion by, Report& report);

/// Whether the model was refined for free simulation, with the held-out free runs that decided it. Where one choice
/// holds for all outputs, the section says so.
ReportSection focus_section(const FocusOutcome& focused, const std::vector<std::string>& outputs);

/// Adds `whiteness_p` and `independence_p` of all outputs, with their series.
void add_tests(const ResidualTests& tests, const ChannelChoice& channels, Report& report);

/// Adds correlations of residuals over lags as series `residual.I.white` and `residual.I.K`, and their bounds under
/// chance as the same ids followed by `.bound`.
void add_test_series(const ResidualTests& tests, const ChannelChoice& channels, ReportSection& section);

}  // namespace wisp::arx
