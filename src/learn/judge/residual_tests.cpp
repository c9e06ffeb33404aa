#include "learn/judge/residual_tests.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "base/statistics.hpp"
#include "learn/fit/arx_errors.hpp"
#include "learn/numeric/chi_squared.hpp"
#include "learn/numeric/constants.hpp"
#include "learn/numeric/decompositions.hpp"

namespace wisp {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Residuals and inputs of one gap-free stretch, one column per series.
struct Stretch {
  MatrixXd residual;
  MatrixXd input;
};

std::vector<Stretch> stretches_of(const ArxModel& model, const Signals& signals) {
  std::vector<Stretch> all;
  ErrorFilter filter(model, signals);
  for (const RowRun& run : plan_rows(signals, layout_of(model.orders), model.orders.history()).runs) {
    const auto rows = static_cast<Index>(run.end - run.begin);
    Stretch& stretch = all.emplace_back();
    stretch.residual.resize(rows, signals.outputs);
    filter.errors(run, stretch.residual);
    stretch.input.resize(rows, signals.inputs);
    for (int k = 0; k < signals.inputs; ++k) {
      const double* samples = signals.samples[run.recording][signals.outputs + k].data() + run.begin;
      const Eigen::Map<const VectorXd> input(samples, rows);
      // A sample that no coefficient uses may be missing: the operating point takes its place.
      stretch.input.col(k) = input.array().isNaN().select(signals.offset[signals.outputs + k], input);
    }
  }
  return all;
}

// Subtracts from a series its mean over all rows: both tests use deviations from the means.
void centre(std::vector<Stretch>& stretches, MatrixXd Stretch::*series) {
  Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero((stretches.front().*series).cols());
  Index rows = 0;
  for (const Stretch& stretch : stretches) {
    sum += (stretch.*series).colwise().sum();
    rows += (stretch.*series).rows();
  }
  for (Stretch& stretch : stretches) (stretch.*series).rowwise() -= sum / static_cast<double>(rows);
}

// Mean of a(t) b(t − lag) over all rows, lags first … last.
template <class A, class B>
VectorXd products(const std::vector<Stretch>& stretches, double rows, int first, int last, A a, B b) {
  VectorXd sums = VectorXd::Zero(last - first + 1);
  for (const Stretch& stretch : stretches) {
    const auto left = a(stretch);
    const auto right = b(stretch);
    for (int lag = first; lag <= last; ++lag) {
      const Index overlap = left.size() - std::abs(lag);
      if (overlap <= 0) continue;
      sums[lag - first] +=
          lag >= 0 ? left.tail(overlap).dot(right.head(overlap)) : left.head(overlap).dot(right.tail(overlap));
    }
  }
  return sums / rows;
}

Whiteness whiteness_of(const VectorXd& auto_covariance, double rows, double taken) {
  Whiteness test;
  test.bound = kNormal95 / std::sqrt(rows);
  const auto lags = auto_covariance.size() - 1;
  for (Index lag = 1; lag <= lags; ++lag) {
    const double r = auto_covariance[0] > 0 ? auto_covariance[lag] / auto_covariance[0] : 0.0;
    test.correlation.push_back(r);
    test.statistic += rows * (rows + 2) * r * r / (rows - static_cast<double>(lag));
  }
  test.p = chi_squared_tail(test.statistic, std::max(1.0, static_cast<double>(lags) - taken));
  return test;
}

double variance_of(const Signals& signals, int channel) {
  std::vector<double> all;
  for (const auto& one : signals.samples) all.insert(all.end(), one[channel].begin(), one[channel].end());
  return std::pow(deviation(present(std::move(all))), 2);
}

// Degrees of freedom that the fit takes from an output's autocorrelations. Each lag of output j takes the share of j's
// variance that the residual causes: 1 without inputs, small where an input drives j.
double taken_by_fit(const ArxModel& model, const Signals& signals, int output, double residual_variance) {
  constexpr int kSteps = 400;
  VectorXd driven = VectorXd::Zero(signals.outputs);
  for (const MatrixXd& step : noise_response(model, kSteps)) driven += residual_variance * step.col(output).cwiseAbs2();
  double taken = 0;
  for (int j = 0; j < signals.outputs; ++j) {
    const double variance = variance_of(signals, j);
    if (variance > 0) taken += model.orders.na(output, j) * std::min(1.0, driven[j] / variance);
  }
  return taken;
}

// Covariance of mean products of residual and input over lags: Σ_k R_ε(k) R_u(k + distance) / n.
VectorXd product_covariance(const VectorXd& residual, const VectorXd& input, Index distances, double rows) {
  VectorXd out = VectorXd::Zero(distances);
  const Index lags = residual.size() - 1;
  for (Index distance = 0; distance < distances; ++distance) {
    for (Index k = -lags; k <= lags; ++k) {
      const Index at = std::abs(k + distance);
      if (at < input.size()) out[distance] += residual[std::abs(k)] * input[at];
    }
  }
  return out / rows;
}

struct Pairing {
  const ArxModel& model;
  const ResidualTestOptions& options;
  double rows;
};

Independence independence_of(const Pairing& pairing, const VectorXd& cross, const VectorXd& residual,
                             const VectorXd& input, int output, int k) {
  const int lags = pairing.options.lags;
  const int delay = pairing.model.orders.nk(output, k);
  Independence test;
  const double scale = std::sqrt(residual[0] * input[0]);
  for (int lag = -lags; lag <= lags; ++lag) test.correlation.push_back(scale > 0 ? cross[lag + lags] / scale : 0.0);
  if (!(scale > 0)) return test;
  const Index count = lags + 1;
  const VectorXd spread = product_covariance(residual, input, count, pairing.rows);
  test.bound = kNormal95 * std::sqrt(spread[0]) / scale;
  MatrixXd covariance(count, count);
  for (Index r = 0; r < count; ++r) {
    for (Index c = 0; c < count; ++c) covariance(r, c) = spread[std::abs(r - c)];
  }
  const VectorXd tested = cross.segment(lags + delay, count);
  const RankedSolution weighed = ranked_solution(covariance, tested);
  test.statistic = tested.dot(weighed.x);
  const double taken = pairing.options.learned_from_it ? pairing.model.orders.nb(output, k) : 0;
  test.p = chi_squared_tail(test.statistic, std::max(1.0, static_cast<double>(weighed.rank) - taken));
  return test;
}

Result<void> check(const ResidualTestOptions& options, std::size_t rows) {
  if (options.lags < 1 || options.lags > 10000) {
    return Error{std::to_string(options.lags) + " lags were requested, expected 1 to 10000"};
  }
  if (rows < 4 * static_cast<std::size_t>(options.lags)) {
    return Error{std::to_string(rows) + " rows are too few to test residuals over " + std::to_string(options.lags) +
                 " lags; test fewer lags or give a longer recording"};
  }
  return {};
}

}  // namespace

Result<ResidualTests> test_residuals(const ArxModel& model, std::span<const Recording> recordings,
                                     const ChannelChoice& channels, const ResidualTestOptions& options) {
  const auto signals = signals_of_model(model, recordings, channels);
  if (!signals) return signals.error();
  std::vector<Stretch> stretches = stretches_of(model, *signals);
  ResidualTests tests;
  for (const Stretch& stretch : stretches) tests.rows += static_cast<std::size_t>(stretch.residual.rows());
  if (auto ok = check(options, tests.rows); !ok) return ok.error();
  centre(stretches, &Stretch::residual);
  centre(stretches, &Stretch::input);

  const double rows = static_cast<double>(tests.rows);
  const Pairing pairing{model, options, rows};
  for (int i = 0; i < signals->outputs; ++i) {
    const auto residual = [i](const Stretch& stretch) { return stretch.residual.col(i); };
    const VectorXd own = products(stretches, rows, 0, options.lags, residual, residual);
    const double taken = options.learned_from_it ? taken_by_fit(model, *signals, i, own[0]) : 0;
    tests.whiteness.push_back(whiteness_of(own, rows, taken));
    auto& row = tests.independence.emplace_back();
    for (int k = 0; k < signals->inputs; ++k) {
      const auto input = [k](const Stretch& stretch) { return stretch.input.col(k); };
      const VectorXd its = products(stretches, rows, 0, 2 * options.lags, input, input);
      const int furthest = options.lags + model.orders.nk(i, k);
      const VectorXd cross = products(stretches, rows, -options.lags, furthest, residual, input);
      row.push_back(independence_of(pairing, cross, own, its, i, k));
    }
  }
  return tests;
}

}  // namespace wisp
