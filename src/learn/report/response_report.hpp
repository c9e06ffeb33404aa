#pragma once
// Poles, zeros, step and frequency responses as series to plot and as lists.

#include <span>

#include "learn/rows/arx_design.hpp"
#include "wisp/base/report.hpp"
#include "wisp/model/arx.hpp"

namespace wisp::arx {

/// A model whose responses are computed. `covariance` is ArxFit's; empty: no confidence bands.
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
