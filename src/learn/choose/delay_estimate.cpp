#include <algorithm>
#include <cmath>

#include "learn/choose/order_search.hpp"
#include "learn/choose/search_fit.hpp"
#include "learn/fit/arx_fit.hpp"
#include "learn/numeric/chi_squared.hpp"
#include "learn/rows/arx_rows.hpp"
#include "record/number_text.hpp"

namespace wisp {
namespace {

// Columns of all candidates: all lags of the outputs, and all lags that an input may have.
LagLayout all_lags(const Signals& signals, const DelayOptions& options, int most) {
  std::vector<LaggedChannel> used;
  for (int i = 0; i < signals.outputs; ++i) {
    for (int lag = 1; lag <= options.na; ++lag) used.push_back({i, lag});
  }
  for (int k = 0; k < signals.inputs; ++k) {
    for (int lag = 0; lag < most + options.nb; ++lag) used.push_back({signals.outputs + k, lag});
  }
  return LagLayout(signals.outputs, signals.inputs, used);
}

// Regressors of one output: input k with delay nk (without lags where nk is unset), the other inputs with all lags.
SharedRows with_delay(const LagLayout& layout, const DelayOptions& options, int output, int k, std::optional<int> nk) {
  SharedRows rows{{}, {output}};
  for (int p = 1; p < layout.size(); ++p) {
    const auto [channel, lag] = layout[p];
    const bool feedback = channel < layout.outputs() && lag > 0;
    const bool own = channel == layout.outputs() + k && nk && lag >= *nk && lag < *nk + options.nb;
    const bool other = channel >= layout.outputs() && channel != layout.outputs() + k;
    if (feedback || own || other) rows.columns.push_back(p);
  }
  if (options.offset == ArxOffset::kEstimate) rows.columns.push_back(0);
  return rows;
}

Result<void> check(const DelayOptions& options) {
  const auto within = [](int value) { return value >= 0 && value <= 4096; };
  if (within(options.most.value_or(0)) && within(options.na) && within(options.nb) && options.nb > 0) return {};
  return Error{"delays are looked for with most and na from 0 to 4096 and nb from 1 to 4096"};
}

// The delay with the least squared error, or a longer one, where leaving out the first lags of the best one does not
// raise the error significantly.
int chosen_delay(const std::vector<double>& squares, double rows, int nb) {
  constexpr double kByChance = 3.84;  // 95th percentile of chi-squared with one degree of freedom
  const auto best = static_cast<int>(std::min_element(squares.begin(), squares.end()) - squares.begin());
  int chosen = best;
  for (int nk = best + 1; nk < std::min(best + nb, static_cast<int>(squares.size())); ++nk) {
    if (squares[nk] <= squares[best] * (1 + kByChance / rows)) chosen = nk;
  }
  return chosen;
}

Result<Delays> delays_up_to(int most, const Signals& signals, const DelayOptions& options) {
  constexpr double kChance = 1e-3;  // probability of finding any delay between unrelated channels
  const LagLayout layout = all_lags(signals, options, most);
  SearchWindows windows(signals, layout, layout.history(), layout.history());
  const auto rows = static_cast<double>(windows.rows(layout.history()));
  if (rows <= layout.size()) {
    return Error{"too few rows (" + number_text(rows, 9) + ") to tell delays up to " + std::to_string(most) +
                 " samples; try shorter ones: --nk auto:N"};
  }
  Delays delays{OrderMatrix(signals.outputs, signals.inputs, 1), OrderMatrix(signals.outputs, signals.inputs), most};
  for (int i = 0; i < signals.outputs; ++i) {
    for (int k = 0; k < signals.inputs; ++k) {
      const auto square = [&](std::optional<int> nk) {
        return fit_candidate(windows, layout.history(), layout, {with_delay(layout, options, i, k, nk)})
            .residual_gram(i, i);
      };
      std::vector<double> squares;
      for (int nk = 0; nk <= most; ++nk) squares.push_back(square(nk));
      const double gain = rows * std::log(square({}) / *std::min_element(squares.begin(), squares.end()));
      const double chance = kChance / (most + 1) / signals.outputs / signals.inputs;
      if (!(gain > chi_squared_quantile(1 - chance, options.nb))) continue;
      delays.supported(i, k) = 1;
      delays.nk(i, k) = chosen_delay(squares, rows, options.nb);
    }
  }
  return delays;
}

// Whether longer delays should be tried: some input has no supported delay, or one near the end.
bool open_end(const Delays& delays) {
  const auto supported = delays.supported.values(), nk = delays.nk.values();
  for (std::size_t p = 0; p < nk.size(); ++p) {
    if (supported[p] == 0 || nk[p] > 3 * delays.most / 4) return true;
  }
  return false;
}

}  // namespace

Result<Delays> estimate_delays(std::span<const Recording> recordings, const ChannelChoice& channels,
                               const DelayOptions& options) {
  constexpr int kFirst = 20, kLast = 640, kRowsALag = 4, kRowsACoefficient = 10;
  if (auto ok = check(options); !ok) return ok.error();
  const auto signals = gather_signals(recordings, channels, options.offset);
  if (!signals) return signals.error();
  std::size_t rows = 0;
  for (const Recording& one : recordings) rows += one.rows();
  // A doubling needs kRowsALag rows per lag, and kRowsACoefficient more per further input, all of whose lags enter.
  auto delays = delays_up_to(options.most.value_or(kFirst), *signals, options);
  while (delays && !options.most && open_end(*delays) && 2 * delays->most * std::max(1, signals->inputs) <= kLast &&
         rows >= static_cast<std::size_t>(2 * delays->most) *
                     static_cast<std::size_t>(kRowsALag + kRowsACoefficient * (signals->inputs - 1))) {
    delays = delays_up_to(2 * delays->most, *signals, options);
  }
  if (!delays) return delays;
  const auto supported = delays->supported.values();
  if (!supported.empty() && std::count(supported.begin(), supported.end(), 1) == 0) {
    return Error{"no delay is supported: at none of 0 to " + std::to_string(delays->most) +
                 " samples an input lowers the outputs' error beyond chance; are these the inputs, and do they move?"};
  }
  return delays;
}

}  // namespace wisp
