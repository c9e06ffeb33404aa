#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "learn/choose/order_search.hpp"
#include "learn/choose/search_fit.hpp"
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

// Squared errors of every output (column) in regressions on all outputs' lags, the other inputs' lags and `nb` lags of
// input k, from each delay (row) on. The last row is of regressions without input k.
Eigen::MatrixXd squares_of(SearchWindows& windows, const LagLayout& layout, const DelayOptions& options, int k) {
  std::vector<int> base, tail;
  if (options.offset == ArxOffset::kEstimate) base.push_back(0);
  for (int p = 1; p < layout.size(); ++p) {
    const auto [channel, lag] = layout[p];
    if (channel >= layout.outputs() || lag > 0) (channel == layout.outputs() + k ? tail : base).push_back(p);
  }
  const auto delays = static_cast<Eigen::Index>(tail.size()) - options.nb + 1;
  for (int i = 0; i < layout.outputs(); ++i) tail.push_back(layout.target(i));
  const Eigen::MatrixXd left = left_by(windows, layout.history(), base, tail);
  const Eigen::MatrixXd outputs = left.rightCols(layout.outputs());
  Eigen::MatrixXd squares(delays + 1, layout.outputs());
  for (Eigen::Index nk = 0; nk < delays; ++nk) {
    const Eigen::MatrixXd lags = left.middleCols(nk, options.nb);
    squares.row(nk) = (outputs - lags * lags.colPivHouseholderQr().solve(outputs)).colwise().squaredNorm();
  }
  squares.row(delays) = outputs.colwise().squaredNorm();
  return squares;
}

Result<void> check(const DelayOptions& options) {
  const auto within = [](int value) { return value >= 0 && value <= 4096; };
  if (within(options.most.value_or(0)) && within(options.na) && within(options.nb) && options.nb > 0) return {};
  return Error{"delays are looked for with most and na from 0 to 4096 and nb from 1 to 4096"};
}

// The delay with the least squared error, or a longer one, where leaving out the first lags of the best one does not
// raise the error significantly.
int chosen_delay(const Eigen::VectorXd& squares, double rows, int nb) {
  constexpr double kByChance = 3.84;  // 95th percentile of chi-squared with one degree of freedom
  Eigen::Index best = 0;
  squares.minCoeff(&best);
  auto chosen = best;
  for (auto nk = best + 1; nk < std::min<Eigen::Index>(best + nb, squares.size()); ++nk) {
    if (squares[nk] <= squares[best] * (1 + kByChance / rows)) chosen = nk;
  }
  return static_cast<int>(chosen);
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
  for (int k = 0; k < signals.inputs; ++k) {
    const Eigen::MatrixXd squares = squares_of(windows, layout, options, k);
    for (int i = 0; i < signals.outputs; ++i) {
      const Eigen::VectorXd at = squares.col(i).head(most + 1);
      const double gain = rows * std::log(squares(most + 1, i) / at.minCoeff());
      const double chance = kChance / (most + 1) / signals.outputs / signals.inputs;
      if (!(gain > chi_squared_quantile(1 - chance, options.nb))) continue;
      delays.supported(i, k) = 1;
      delays.nk(i, k) = chosen_delay(at, rows, options.nb);
    }
  }
  return delays;
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
  auto delays = delays_up_to(options.most.value_or(kFirst), *signals, options);
  // Ends where two doublings in a row change no delay and all delays are supported: a short delay may be supported by
  // chance, or because the input resembles its own past. A doubling needs kRowsALag rows per lag, and kRowsACoefficient
  // more per lag of each further input, since all lags of the other inputs enter.
  for (int most = 2 * kFirst, unchanged = 0;
       delays && !options.most && most * std::max(1, signals->inputs) <= kLast &&
       rows >= static_cast<std::size_t>(most) *
                   static_cast<std::size_t>(kRowsALag + kRowsACoefficient * (signals->inputs - 1));
       most *= 2) {
    auto longer = delays_up_to(most, *signals, options);
    if (!longer) break;
    const auto supported = longer->supported.values();
    const bool same = longer->nk == delays->nk && std::count(supported.begin(), supported.end(), 0) == 0;
    if (same && ++unchanged == 2) break;
    if (!same) delays = std::move(longer), unchanged = 0;
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
