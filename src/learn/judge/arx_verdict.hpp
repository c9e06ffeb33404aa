#pragma once
// Verdict whether a stable, determined ARX model is usable: how well it predicts or simulates, from how many rows, and
// which property of the recordings is the cause where it fails.

#include <functional>
#include <span>

#include "learn/fit/arx_fit.hpp"
#include "learn/judge/residual_tests.hpp"
#include "wisp/learn/advice.hpp"

namespace wisp::arx {

/// Mean squared difference of adjacent samples of every output; NaN where there are none.
std::vector<double> persistence_errors(std::span<const Recording> recordings, const ChannelChoice& channels);

/// Evidence for a verdict besides the fit's summary.
struct VerdictEvidence {
  const ChannelChoice& channels;
  const ArxOrders& orders;
  std::vector<double> persistence{};               ///< mean squared change per output; empty where unknown
  const ResidualTests* least_squares{};            ///< tests of least-squares residuals; null: none
  std::vector<double> held_out{};                  ///< held_out_fits(); empty: the fits of the training rows are judged
  std::vector<int> integrators{};                  ///< as in ArxOptions::integrators
  std::vector<Remark> redundant{};                 ///< redundant_channels() of the inputs
  std::function<std::vector<Remark>()> remarks{};  ///< computes remarks on the recordings; called only to find a cause
  std::function<std::vector<Remark>()> doubts{};   ///< remarks of feedback_of() and coincidence(); called last
};

/// Marks a usable summary as not usable where a criterion fails, with the reason; for bad simulation it names the first
/// remark that explains it, with its remedy. If the model stays usable, adds its free simulation's fit to the reason.
void judge_use(const VerdictEvidence& evidence, ArxSummary& summary);

}  // namespace wisp::arx
