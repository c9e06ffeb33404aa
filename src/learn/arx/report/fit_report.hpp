#pragma once
// What an ARX model is, how good a fit is, what a search found, as reports.

#include <span>
#include <string>
#include <vector>

#include "learn/arx/fit/arx_fit.hpp"
#include "learn/arx/judge/residual_tests.hpp"
#include "learn/arx/search/order_search.hpp"
#include "learn/choose/focus.hpp"
#include "wisp/base/report.hpp"

namespace wisp::arx {

/// For programs `A`, `B`, `std_error`, `poles`, `zeros` [output][input] (lists of [real, imaginary] in the z plane) and
/// `static_gain` [output][input], their ids after `prefix`. Poles are null where the companion matrix has more than
/// 256 rows, and zeros where it has more than 48.
void describe(const ArxModel& model, const std::string& prefix, ReportSection& section);

/// For people: a section an output with its coefficients and their standard errors, and one of the poles as time
/// constants and as resonances with their damping; nothing where they are many.
void tell(const ArxModel& model, const Model& of, Report& report);

/// For people: the poles alone.
void tell_poles(const ArxModel& model, double rate_hz, Report& report);

/// Coefficients with standard errors first, then every figure of the summary, warnings and verdict. `model` is the
/// fit's, with the names of its channels.
void add_fit(const ArxFit& fit, const Model& model, Report& report);

/// All candidates, the best with its runners-up by the criterion, and the best of every output on its own.
void add_search(const OrderSearch& search, const std::vector<std::string>& outputs, OrderCriterion by, Report& report);

/// Whether the model was refined for free simulation, and how held-out free runs judged that. One choice for all
/// outputs is named so.
ReportSection focus_section(const FocusOutcome& focused, const std::vector<std::string>& outputs);

/// `whiteness_p` and `independence_p` of all outputs, with their series.
void add_tests(const ResidualTests& tests, const ChannelChoice& channels, Report& report);

/// Correlations of residuals over lags, with what chance allows: series `residual.I.white` and `residual.I.K`, their
/// bounds the same with `.bound` after it.
void add_test_series(const ResidualTests& tests, const ChannelChoice& channels, ReportSection& section);

}  // namespace wisp::arx
