#pragma once
// Whether an ARX model may be used, beyond that it is stable and determined: what it predicts or simulates, from how
// much, and what in the recordings is the cause where it does not.

#include <functional>
#include <span>

#include "learn/arx/fit/arx_fit.hpp"
#include "learn/arx/judge/residual_tests.hpp"
#include "learn/arx/rows/arx_design.hpp"
#include "wisp/learn/advice.hpp"

namespace wisp::arx {

/// The least fit of free simulation of an output over held-out rows, in percent, that a model with inputs is usable
/// with.
inline constexpr double kMinSimulationFit = 40;

/// The least share of the squared error of the better of the last sample and the mean by which a model without inputs
/// must be better, in percent.
inline constexpr double kMinSkill = 5;

/// The fewest rows for every coefficient of an output.
inline constexpr double kMinRowsACoefficient = 10;

/// The most standard errors by which a repair of its stability may move a coefficient.
inline constexpr double kMaxMoved = 10;

/// A residual that correlates at least so with the input of its own sample: the input acts without delay.
inline constexpr double kSameSample = 0.25;

/// The most percent of fit that the stored model, in single precision, may lose against the estimate.
inline constexpr double kMaxLostInPlay = 1;

/// Mean squared change of every output from one sample to the next; NaN where there is none.
std::vector<double> persistence_errors(std::span<const Recording> recordings, const ChannelChoice& channels);

/// What a verdict looks at beside the fit's summary.
struct VerdictEvidence {
  const ChannelChoice& channels;
  const ArxOrders& orders;
  std::vector<double> persistence{};               ///< per output, or empty where unknown
  const ResidualTests* least_squares{};            ///< residuals of least squares, or none
  std::vector<double> held_out{};                  ///< as held_out_fits(); empty: the rows learned from are judged
  std::vector<int> integrators{};                  ///< as ArxOptions::integrators
  std::vector<Remark> redundant{};                 ///< as redundant_channels() of the inputs
  std::function<std::vector<Remark>()> remarks{};  ///< on the recordings, asked where a cause is sought
};

/// Turns a summary that is usable so far into one that is not, with the reason, where one of the limits above is not
/// kept. A model that simulates badly is told of with the first remark that explains it and the cure of that. What is
/// usable stays so with the figure that says how well.
void judge_use(const VerdictEvidence& evidence, ArxSummary& summary);

}  // namespace wisp::arx
