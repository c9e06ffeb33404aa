#include "learn/chain/gusts/gust_response.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string>

#include "learn/chain/gusts/gust_ensembles.hpp"
#include "learn/numeric/normal_equations.hpp"

namespace wisp::chain {
namespace {

constexpr int kRefinements = 12;

using Axis = GustResponse::Axis;
using Ensemble = GustEnsemble;

double lagged(const std::vector<Triple>& values, std::size_t row, std::size_t lag, std::size_t axis) {
  return lag > row ? 0.0 : values[row - lag][axis];
}

// The change of velocity that a response makes of a gust, by itself.
std::vector<double> simulated(const Ensemble& gust, std::size_t axis, const Axis& response) {
  std::vector<double> change(gust.wind.size());
  const std::size_t order = response.change.size();
  for (std::size_t row = 0; row < change.size(); ++row) {
    for (std::size_t k = 0; k < order; ++k) {
      if (row > k) change[row] += response.change[k] * change[row - k - 1];
      change[row] += response.wind[k] * lagged(gust.wind, row, k, axis);
      change[row] += response.press[k] * lagged(gust.press, row, k, axis);
    }
  }
  return change;
}

Axis axis_of(const std::vector<double>& theta) {
  const auto order = static_cast<long>(theta.size() / 3);
  const auto at = [&](long k) { return theta.begin() + k * order; };
  return {{at(0), at(1)}, {at(1), at(2)}, {at(2), at(3)}};
}

// Least squares of the equation error: where the refinement begins.
std::vector<double> first_guess(std::span<const Ensemble> gusts, std::span<const std::size_t> axes, int order) {
  NormalEquations equations(3 * static_cast<std::size_t>(order));
  std::vector<double> row(3 * static_cast<std::size_t>(order));
  for (const Ensemble& gust : gusts) {
    for (std::size_t axis : axes) {
      for (std::size_t t = 0; t < gust.change.size(); ++t) {
        for (std::size_t k = 0; k < static_cast<std::size_t>(order); ++k) {
          row[k] = lagged(gust.change, t, k + 1, axis);
          row[static_cast<std::size_t>(order) + k] = lagged(gust.wind, t, k, axis);
          row[2 * static_cast<std::size_t>(order) + k] = lagged(gust.press, t, k, axis);
        }
        equations.add(row, gust.change[t][axis]);
      }
    }
  }
  return equations.solved(1e-6);
}

double squared_error(std::span<const Ensemble> gusts, std::span<const std::size_t> axes,
                     const std::vector<double>& theta) {
  const Axis response = axis_of(theta);
  double sum = 0;
  for (const Ensemble& gust : gusts) {
    for (std::size_t axis : axes) {
      const auto change = simulated(gust, axis, response);
      for (std::size_t t = 0; t < change.size(); ++t) {
        sum += (change[t] - gust.change[t][axis]) * (change[t] - gust.change[t][axis]);
      }
    }
  }
  return sum;
}

// One step of Levenberg and Marquardt on the error of free simulation, slopes by differences.
std::vector<double> refined(std::span<const Ensemble> gusts, std::span<const std::size_t> axes,
                            const std::vector<double>& theta, double damping) {
  constexpr double kNudge = 1e-5;
  NormalEquations equations(theta.size());
  std::vector<double> row(theta.size());
  for (const Ensemble& gust : gusts) {
    for (std::size_t axis : axes) {
      const auto now = simulated(gust, axis, axis_of(theta));
      std::vector<std::vector<double>> nudged;
      for (std::size_t k = 0; k < theta.size(); ++k) {
        auto other = theta;
        other[k] += kNudge;
        nudged.push_back(simulated(gust, axis, axis_of(other)));
      }
      for (std::size_t t = 0; t < now.size(); ++t) {
        for (std::size_t k = 0; k < theta.size(); ++k) row[k] = (nudged[k][t] - now[t]) / kNudge;
        equations.add(row, gust.change[t][axis] - now[t]);
      }
    }
  }
  auto step = equations.solved(damping);
  for (std::size_t k = 0; k < step.size(); ++k) step[k] += theta[k];
  return step;
}

Axis fit_axis(std::span<const Ensemble> gusts, std::span<const std::size_t> axes, int order) {
  auto theta = first_guess(gusts, axes, order);
  // What grows can't be refined, and wind that was never seen tells nothing: then a body is carried along within a few
  // steps, as light ones are.
  double error = squared_error(gusts, axes, theta);
  const std::vector<double> plain = [&] {
    std::vector<double> start(theta.size(), 0.0);
    start[0] = 0.8;
    start[static_cast<std::size_t>(order)] = 0.2;
    return start;
  }();
  if (const double other = squared_error(gusts, axes, plain); !(error < other)) {
    theta = plain;
    error = other;
  }
  double damping = 1e-4;
  for (int round = 0; round < kRefinements; ++round) {
    const auto tried = refined(gusts, axes, theta, damping);
    const double found = squared_error(gusts, axes, tried);
    if (found < error) {
      theta = tried;
      error = found;
      damping /= 4;
    } else {
      damping *= 16;
    }
  }
  return axis_of(theta);
}

struct Judgement {
  FitSums velocity, displacement;
  std::vector<double> angles;
};

void judge(const Ensemble& gust, const GustResponse& response, double rate_hz, Judgement& out, GustFigures& figures) {
  std::array<std::vector<double>, 3> change;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    change[axis] = simulated(gust, axis, axis < 2 ? response.ground : response.vertical);
  }
  Triple place{};
  for (std::size_t t = 0; t < gust.change.size(); ++t) {
    Triple now{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      now[axis] = change[axis][t];
      // As the bank does it: a step's change of velocity moves the step after it.
      if (t > 0) place[axis] += now[axis] / rate_hz;
      figures.largest_change = std::max(figures.largest_change, std::abs(now[axis]));
    }
    out.velocity.add(now, gust.change[t]);
    out.displacement.add(place, gust.displacement[t]);
  }
  out.angles.push_back(degrees_between(gust.displacement.back(), place));
}

std::vector<Input> inputs_of(const std::array<const std::vector<double>*, 3>& wind) {
  double most = 0;
  for (const auto* channel : wind) {
    for (double sample : *channel) most = std::max(most, std::abs(sample));
  }
  std::vector<Input> inputs;
  // What blows along x could have blown along y.
  for (const char* name : {"wind.x", "wind.y", "wind.z"})
    inputs.push_back({name, "m/s", -most, most, InputShape::kLinear});
  return inputs;
}

}  // namespace

Result<GustFit> learn_gusts(const Recording& windy, const Recording& calm, const GustOptions& options) {
  if (options.order < 1 || options.order > kMostGustOrder) {
    return Error{"the order of the response to gusts is " + std::to_string(options.order) + ", expected 1 to 4"};
  }
  const auto pairs = gust_pairs(windy, calm);
  if (!pairs) return pairs.error();
  std::vector<Ensemble> ensembles;
  for (std::size_t k = 0; k < pairs->gusts(); ++k) {
    const GustSpan span = span_of(*pairs, k, options.after_seconds);
    if (span.rows() > 2) ensembles.push_back(ensemble_of(*pairs, k, span));
  }
  if (ensembles.size() < 4) return Error{windy.source + ": has fewer than 4 gusts of wind, expected more"};
  const auto learned = std::clamp<std::size_t>(
      static_cast<std::size_t>(static_cast<double>(ensembles.size()) * (1 - options.holdout)), 2, ensembles.size());
  const auto told = std::span<const Ensemble>(ensembles).first(learned);
  auto judged = std::span<const Ensemble>(ensembles).subspan(learned);
  if (judged.empty()) judged = told;

  GustFit fit;
  constexpr std::size_t kGround[] = {0, 1}, kVertical[] = {2};
  fit.response = {fit_axis(told, kGround, options.order), fit_axis(told, kVertical, options.order)};
  fit.inputs = inputs_of(pairs->wind);
  fit.figures.gusts_learned = told.size();
  fit.figures.gusts_judged = judged.size();
  Judgement found;
  for (const Ensemble& gust : judged) judge(gust, fit.response, pairs->windy.rate_hz, found, fit.figures);
  fit.figures.fit_percent = found.displacement.fit_percent();
  fit.figures.velocity_fit_percent = found.velocity.fit_percent();
  std::sort(found.angles.begin(), found.angles.end());
  fit.figures.direction_degrees = found.angles[found.angles.size() / 2];
  for (double angle : found.angles) {
    fit.figures.direction_degrees_mean += angle / static_cast<double>(found.angles.size());
  }
  return fit;
}

}  // namespace wisp::chain
