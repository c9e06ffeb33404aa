#pragma once
// Search for orders and delays: every candidate of a grid is fitted and judged from one set of products.
//
// Source: L. Ljung, System Identification (2nd ed.), sections 16.4 (criteria, cross-validation) and 10.1 (all
// candidates from one covariance matrix). A candidate costs a small Cholesky factorisation, however long the recordings
// are.

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "learn/fit/arx_fit.hpp"
#include "wisp/base/progress.hpp"
#include "wisp/base/result.hpp"
#include "wisp/model/arx.hpp"
#include "wisp/record/recording.hpp"

namespace wisp {

/// Candidates, and the criterion that judges them.
struct SearchOptions {
  OrderRange na{1, 10};
  OrderRange nb{1, 10};
  OrderRange nk{0, 3};
  Coupling coupling = Coupling::kFull;
  OrderCriterion by = OrderCriterion::kFpe;
  int steps = 1;                        ///< for validation: steps ahead, or kFreeRun for free simulation
  ArxOffset offset = ArxOffset::kMean;  ///< kMean: validation recordings are centred on their own means
};

/// A candidate and its figures. Fits are as estimated, without stabilisation.
struct OrderCandidate : Criteria {
  ArxOrders orders;
  int na = 0;  ///< orders and delay of the grid point
  int nb = 0;
  int nk = 0;
  std::size_t rows = 0;                 ///< number of rows in the estimation
  std::vector<double> loss;             ///< V per output, its unit²
  std::vector<double> loss_validation;  ///< mean squared error per output; empty without validation recordings
  bool determined = true;               ///< false: the data do not determine all of its coefficients
};

/// All candidates, in the grid's order (nk outermost, then na, then nb), and the best.
struct OrderSearch {
  std::vector<OrderCandidate> candidates;
  std::size_t best = 0;                  ///< index of the best by the criterion over all outputs together
  std::vector<std::size_t> best_of_row;  ///< index of the best by the criterion for each output row alone
};

/// Fits and judges all candidates. A row with a missing sample in the longest history is skipped for all candidates.
/// Memory grows with the longest lag, not with the number of candidates. `validation` may be empty unless the criterion
/// is kValidation. Errors: as fit_arx; a constant channel; more than a million candidates; ranges or steps out of
/// bounds; too few rows for a candidate or its validation; kStopped.
Result<OrderSearch> search_orders(std::span<const Recording> estimation, std::span<const Recording> validation,
                                  const ChannelChoice& channels, const SearchOptions& options = {},
                                  const Progress& progress = {});

/// Indices of the best candidates by a criterion over all outputs together, at most `count`, best first.
std::vector<std::size_t> best_candidates(const OrderSearch& search, OrderCriterion by, std::size_t count);

struct DelayOptions {
  std::optional<int> most{};  ///< largest delay tried, in samples, 0 to 4096; unset: 20, doubled as rows allow, up to
                              ///< 640 / inputs, until two doublings in a row change no delay and all are supported
  int na = 2;                 ///< lags of the outputs in each candidate
  int nb = 2;                 ///< lags of the input, beginning at the delay
  ArxOffset offset = ArxOffset::kMean;
};

/// Estimated delays, and whether they are significant.
struct Delays {
  OrderMatrix nk;  ///< outputs × inputs; 1 where no delay is supported
  OrderMatrix
      supported;  ///< 1 where the lags lower the squared error beyond chance (1 in 1,000 over all delays), else 0
  int most = 0;   ///< largest delay tried
};

/// Delays of every input to every output. An input's delay is the one with the least squared error, or a longer one
/// that leaves out only lags that are not significant (95 %). Other inputs enter with all lags up to the largest, so
/// their delays do not matter. Errors: as fit_arx; options out of range; no delay is supported.
Result<Delays> estimate_delays(std::span<const Recording> recordings, const ChannelChoice& channels,
                               const DelayOptions& options = {});

}  // namespace wisp
