#include <algorithm>

#include "learn/arx/fit/arx_check.hpp"
#include "learn/arx/rows/arx_rows.hpp"
#include "learn/arx/search/order_search.hpp"
#include "learn/arx/search/search_fit.hpp"
#include "learn/arx/search/search_windows.hpp"

namespace wisp {
namespace {

// The columns of every candidate: all lags of all outputs, all lags that any input may have.
LagLayout all_lags(const Signals& signals, const DelayOptions& options) {
  std::vector<LaggedChannel> used;
  for (int i = 0; i < signals.outputs; ++i) {
    for (int lag = 1; lag <= options.na; ++lag) used.push_back({i, lag});
  }
  for (int k = 0; k < signals.inputs; ++k) {
    for (int lag = 0; lag < options.most + options.nb; ++lag) used.push_back({signals.outputs + k, lag});
  }
  return LagLayout(signals.outputs, signals.inputs, used);
}

// Regressors of one output where input k has the delay nk and the others all their lags.
CandidateRows with_delay(const LagLayout& layout, const DelayOptions& options, int output, int k, int nk) {
  CandidateRows rows{{}, {output}};
  for (int p = 1; p < layout.size(); ++p) {
    const auto [channel, lag] = layout[p];
    const bool feedback = channel < layout.outputs() && lag > 0;
    const bool own = channel == layout.outputs() + k && lag >= nk && lag < nk + options.nb;
    const bool other = channel >= layout.outputs() && channel != layout.outputs() + k;
    if (feedback || own || other) rows.columns.push_back(p);
  }
  if (options.offset == ArxOffset::kEstimate) rows.columns.push_back(0);
  return rows;
}

Result<void> check(const DelayOptions& options) {
  const auto within = [](int value) { return value >= 0 && value <= 4096; };
  if (within(options.most) && within(options.na) && within(options.nb) && options.nb > 0) return {};
  return Error{"delays are looked for with most and na from 0 to 4096 and nb from 1 to 4096"};
}

// The least squared error; but where the lags of a longer delay, which leave out the first of the best one's, do as
// well as chance lets them, the first lag is not needed.
int chosen_delay(const std::vector<double>& squares, double rows, int nb) {
  constexpr double kByChance = 3.84;  // 95 % of chi-squared with one degree of freedom
  const auto best = static_cast<int>(std::min_element(squares.begin(), squares.end()) - squares.begin());
  int chosen = best;
  for (int nk = best + 1; nk < std::min(best + nb, static_cast<int>(squares.size())); ++nk) {
    if (squares[nk] <= squares[best] * (1 + kByChance / rows)) chosen = nk;
  }
  return chosen;
}

}  // namespace

Result<OrderMatrix> estimate_delays(std::span<const Recording> recordings, const ChannelChoice& channels,
                                    const DelayOptions& options) {
  if (auto ok = check(options); !ok) return ok.error();
  const auto signals = gather_signals(recordings, channels, options.offset);
  if (!signals) return signals.error();
  const LagLayout layout = all_lags(*signals, options);
  SearchWindows windows(*signals, layout, layout.history(), layout.history());
  if (windows.rows(layout.history()) <= static_cast<std::size_t>(layout.size())) {
    return Error{"too few rows (" + std::to_string(windows.rows(layout.history())) + ") to tell delays up to " +
                 std::to_string(options.most) + " samples; try shorter ones"};
  }
  const double rows = static_cast<double>(windows.rows(layout.history()));
  OrderMatrix delays(signals->outputs, signals->inputs);
  for (int i = 0; i < signals->outputs; ++i) {
    for (int k = 0; k < signals->inputs; ++k) {
      std::vector<double> squares;
      for (int nk = 0; nk <= options.most; ++nk) {
        const CandidateFit fit =
            fit_candidate(windows, layout.history(), layout, {with_delay(layout, options, i, k, nk)});
        squares.push_back(fit.residual_gram(i, i));
      }
      delays(i, k) = chosen_delay(squares, rows, options.nb);
    }
  }
  return delays;
}

}  // namespace wisp
