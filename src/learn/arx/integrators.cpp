// Source: D. Dickey and W. Fuller, "Distribution of the estimators for autoregressive time series with a unit root",
// JASA 74 (1979): critical value of the squared t statistic with an estimated constant.

#include <algorithm>
#include <cmath>

#include "learn/arx/learn_arx.hpp"
#include "learn/judge/judged_fit.hpp"
#include "learn/rows/arx_design.hpp"

namespace wisp::arx {
namespace {

constexpr double kDickeyFuller = 8.2;  // 2.86², the critical value at 5 %
constexpr double kExact = 99.9;        // percent: above this one-step fit, rounding errors would decide the test
constexpr double kGain = 2;            // percentage points: required gain of the free-run fit

bool remembers_itself_only(const OrderMatrix& na, int output) {
  for (int j = 0; j < na.rows(); ++j) {
    if (j != output && (na(output, j) > 0 || na(j, output) > 0)) return false;
  }
  return na(output, output) > 0;
}

}  // namespace

std::vector<int> find_integrators(std::span<const Recording> recordings, const ChannelChoice& channels,
                                  const ArxOptions& options, const ArxFit& plain) {
  const int outputs = options.orders.outputs();
  std::vector<int> found(std::size_t(outputs), 0);
  if (channels.inputs.empty() || plain.summary.free_run_fit_percent.empty()) return {};
  ArxOptions tried = options;
  tried.offset = ArxOffset::kEstimate;
  tried.stabilise = tried.covariance = tried.judge_free_run = false;
  const auto free = fit_arx(recordings, channels, tried);
  if (!free) return {};
  std::vector<double> before = free->summary.loss, best = plain.summary.free_run_fit_percent;
  std::vector<bool> open(std::size_t(outputs), true);
  for (int count = 1; count <= 2; ++count) {
    tried.integrators.assign(std::size_t(outputs), 0);
    for (int i = 0; i < outputs; ++i) {
      const auto at = std::size_t(i);
      open[at] = open[at] && remembers_itself_only(options.orders.na, i) && options.orders.na(i, i) >= count;
      if (open[at]) tried.integrators[at] = count;
    }
    if (std::find(open.begin(), open.end(), true) == open.end()) break;
    const auto held = fit_arx(recordings, channels, tried);
    if (!held) break;
    for (std::size_t i = 0; i < open.size(); ++i) {
      if (!open[i]) continue;
      const double statistic = double(held->summary.rows) * std::log(held->summary.loss[i] / before[i]);
      open[i] = statistic <= kDickeyFuller || held->summary.fit_percent[i] > kExact;
      before[i] = held->summary.loss[i];
    }
    // Compares free simulations of stabilised models, as they are played. Stabilisation moves estimated poles near 1
    // inwards and may so lose an integrator; poles fixed below 1 stay.
    ArxOptions played = options;
    const auto kept = fit_integrators(recordings, channels, tried.integrators, played);
    for (std::size_t i = 0; kept && i < open.size(); ++i) {
      const double fits = kept->summary.free_run_fit_percent[i];
      if (!open[i] || !(fits > best[i] + kGain)) continue;
      best[i] = fits;
      found[i] = count;
    }
  }
  if (std::all_of(found.begin(), found.end(), [](int count) { return count == 0; })) return {};
  return found;
}

Result<ArxFit> fit_integrators(std::span<const Recording> recordings, const ChannelChoice& channels,
                               const std::vector<int>& integrators, ArxOptions& options) {
  options.integrators = integrators;
  options.offset = ArxOffset::kEstimate;
  // Single precision holds the coefficients 2p and p² of two poles at p = 1 − 2⁻¹² exactly.
  for (const double distance : {1e-5, 1e-4, 0x1p-12}) {
    options.integrator_pole = 1 - distance;
    auto fit = fit_arx(recordings, channels, options);
    if (!fit || !fit->summary.stable.changed) return fit;
  }
  options.integrator_pole = 1 - 1e-3;
  return fit_arx(recordings, channels, options);
}

int integrators_in(std::span<const Recording> recordings, const std::vector<std::string>& inputs,
                   const std::string& output) {
  const ChannelChoice channels{inputs, {output}};
  const ArxOptions options{.orders = make_orders({.outputs = 1, .inputs = int(inputs.size())})};
  const auto plain = fit_arx(recordings, channels, options);
  if (!plain) return 0;
  const auto found = find_integrators(recordings, channels, options, *plain);
  return found.empty() ? 0 : found.front();
}

}  // namespace wisp::arx
