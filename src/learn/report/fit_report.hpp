#pragma once
// Reports on an ARX model, on the quality of a fit, on an order search, and on responses as series to plot and lists.

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

/// Adds for people: one section per output with its coefficients and standard errors (above 60 coefficients only their
/// number), and one with the poles as time constants and damped resonances (none above 12 states).
void tell(const ArxModel& model, const Model& of, Report& report);

/// Adds for people the poles alone; none above 12 states.
void tell_poles(const ArxModel& model, double rate_hz, Report& report);

/// Adds coefficients with standard errors, all figures, warnings and verdict. `model`: the fit's, with channel names.
void add_fit(const ArxFit& fit, const Model& model, Report& report);

/// Adds all candidates, the best with its runners-up by the criterion, and the best of each output alone.
void add_search(const OrderSearch& search, const std::vector<std::string>& outputs, OrderCriterion by, Report& report);

/// Section that says whether the model was refined for free simulation, with the held-out free runs that decided it.
/// One choice for all outputs is one row named "all".
ReportSection focus_section(const FocusOutcome& focused, const std::vector<std::string>& outputs);

/// Adds `whiteness_p` and `independence_p` of all outputs, with their series.
void add_tests(const ResidualTests& tests, const ChannelChoice& channels, Report& report);

/// Adds correlations of residuals over lags as series `residual.I.white` and `residual.I.K`, and their bounds under
/// chance as series with `.bound` after these ids.
void add_test_series(const ResidualTests& tests, const ChannelChoice& channels, ReportSection& section);

/// A model whose responses are computed. `covariance`: of the coefficients; empty: no confidence bands.
struct Responding {
  const ArxModel& model;
  const ChannelChoice& channels;
  double rate_hz = 1;
  std::span<const double> covariance{};
};

/// Adds the series `poles`: x is the real part, y the imaginary part.
void add_poles(const ArxModel& model, Report& report);

/// Adds, besides the poles, series for output I and input K: `poles.I.K` and `zeros.I.K` without pairs that cancel;
/// `step.I.K` over seconds, `amplitude.I.K` and `phase.I.K` (degrees) over Hz; with a covariance also the ends of their
/// 95 % bands, under the same ids with `.low` and `.high`. If `listed`, also the lists of `responses`: `seconds` and
/// `step` [output][input] {`value`, `sd`}; `hz` and `frequency` [output][input] {`amplitude`, `amplitude_sd`, `phase`,
/// `phase_sd`}, phases in radians.
void add_responses(const Responding& responding, bool listed, Report& report);

}  // namespace wisp::arx
