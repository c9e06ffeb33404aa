#include "wisp/learn/gust_response.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string>

#include "learn/normal_equations.hpp"
#include "wisp/learn/motion.hpp"

namespace wisp {
namespace {

constexpr double kStill = 1e-3;  // m/s: wind below it is none
constexpr int kRefinements = 12;
constexpr const char* kWinds[] = {"wind.x", "wind.y", "wind.z"};

// Means over the clones of one gust, from its onset on.
struct Ensemble {
  std::vector<Triple> change;        // of velocity
  std::vector<Triple> displacement;  // since the onset
  std::vector<Triple> wind;
  std::vector<Triple> press;
};

using Axis = GustResponse::Axis;

struct Pairs {
  const Motion& windy;
  const Motion& calm;
  std::array<const std::vector<double>*, 3> wind;
  double rate_hz;
};

Triple wind_at(const Pairs& pairs, std::size_t piece, std::size_t row) {
  const std::size_t at = pairs.windy.pieces[piece].first_row + row;
  return {(*pairs.wind[0])[at], (*pairs.wind[1])[at], (*pairs.wind[2])[at]};
}

double size_of(const Triple& v) { return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }

void add(Triple& sum, const Triple& value, double factor) {
  for (std::size_t axis = 0; axis < 3; ++axis) sum[axis] += factor * value[axis];
}

// The wind's part that is square to a flat body.
Triple press_of(const Quad& q, const Triple& wind) {
  const Triple normal = in_world_axes(q, {0, 0, 1});
  const double part = normal[0] * wind[0] + normal[1] * wind[1] + normal[2] * wind[2];
  return {normal[0] * part, normal[1] * part, normal[2] * part};
}

// Rows [onset, end) of a gust: from the first wind of any clone to the last, and a while after.
std::pair<std::size_t, std::size_t> span_of(const Pairs& pairs, std::size_t first, std::size_t clones, double after) {
  std::size_t rows = pairs.windy.pieces[first].rows();
  for (std::size_t k = first; k < first + clones; ++k) {
    rows = std::min({rows, pairs.windy.pieces[k].rows(), pairs.calm.pieces[k].rows()});
  }
  std::size_t onset = rows, last = 0;
  for (std::size_t k = first; k < first + clones; ++k) {
    for (std::size_t row = 0; row < rows; ++row) {
      if (size_of(wind_at(pairs, k, row)) < kStill) continue;
      onset = std::min(onset, row);
      last = std::max(last, row);
    }
  }
  const auto end = last + 1 + static_cast<std::size_t>(std::lround(after * pairs.rate_hz));
  return {onset, std::min(rows, end)};
}

Ensemble ensemble_of(const Pairs& pairs, std::size_t first, std::size_t clones, double after) {
  const auto [onset, end] = span_of(pairs, first, clones, after);
  Ensemble mean;
  const double share = 1.0 / static_cast<double>(clones);
  for (std::size_t row = onset; row < end; ++row) {
    Triple change{}, displacement{}, wind{}, press{};
    for (std::size_t k = first; k < first + clones; ++k) {
      const MotionPiece &blown = pairs.windy.pieces[k], &still = pairs.calm.pieces[k];
      add(change, blown.velocity[row], share);
      add(change, still.velocity[row], -share);
      add(displacement, blown.position[row], share);
      add(displacement, still.position[row], -share);
      add(displacement, blown.position[onset], -share);
      add(displacement, still.position[onset], share);
      const Triple now = wind_at(pairs, k, row);
      add(wind, now, share);
      if (pairs.calm.has_orientation) add(press, press_of(still.orientation[row], now), share);
    }
    mean.change.push_back(change);
    mean.displacement.push_back(displacement);
    mean.wind.push_back(wind);
    mean.press.push_back(press);
  }
  return mean;
}

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

struct Sums {
  double error = 0;
  double size = 0;
  double fit() const { return 100 * (1 - std::sqrt(error / size)); }
};

void judge(const Ensemble& gust, const GustResponse& response, double rate_hz, Sums& velocity, Sums& displacement,
           std::vector<double>& angles, GustFigures& figures) {
  std::array<std::vector<double>, 3> change;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    change[axis] = simulated(gust, axis, axis < 2 ? response.ground : response.vertical);
  }
  Triple place{};
  for (std::size_t t = 0; t < gust.change.size(); ++t) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      // As the bank does it: a step's change of velocity moves the step after it.
      if (t > 0) place[axis] += change[axis][t] / rate_hz;
      velocity.error += std::pow(change[axis][t] - gust.change[t][axis], 2);
      velocity.size += std::pow(gust.change[t][axis], 2);
      displacement.error += std::pow(place[axis] - gust.displacement[t][axis], 2);
      displacement.size += std::pow(gust.displacement[t][axis], 2);
      figures.largest_change = std::max(figures.largest_change, std::abs(change[axis][t]));
    }
  }
  const Triple& end = gust.displacement.back();
  const double across = end[0] * place[1] - end[1] * place[0], along = end[0] * place[0] + end[1] * place[1];
  angles.push_back(std::abs(std::atan2(across, along)) * 180 / std::acos(-1.0));
}

Result<std::array<const std::vector<double>*, 3>> wind_channels(const Recording& windy) {
  std::array<const std::vector<double>*, 3> wind{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto channel = find_channel(windy, kWinds[axis]);
    if (!channel) {
      return Error{windy.source + ": has no channel " + kWinds[axis] + ", expected the wind where the leaf is"};
    }
    wind[axis] = &windy.channels[*channel].samples;
  }
  return wind;
}

std::vector<Input> inputs_of(const std::array<const std::vector<double>*, 3>& wind) {
  double most = 0;
  for (const auto* channel : wind) {
    for (double sample : *channel) most = std::max(most, std::abs(sample));
  }
  std::vector<Input> inputs;
  // What blows along x could have blown along y.
  for (const char* name : kWinds) inputs.push_back({name, "m/s", -most, most, InputShape::kLinear});
  return inputs;
}

}  // namespace

Result<GustFit> learn_gusts(const Recording& windy, const Recording& calm, const GustOptions& options) {
  if (options.order < 1 || options.order > kMostGustOrder) {
    return Error{"the order of the response to gusts is " + std::to_string(options.order) + ", expected 1 to 4"};
  }
  const auto wind = wind_channels(windy);
  if (!wind) return wind.error();
  const auto blown = motion_of(std::span(&windy, 1)), still = motion_of(std::span(&calm, 1));
  if (!blown) return blown.error();
  if (!still) return still.error();
  const auto stated = numbers_attribute(windy, "clones");
  if (!stated) return stated.error();
  const auto clones = *stated && !(*stated)->empty() ? static_cast<std::size_t>(std::max(1.0, (*stated)->front())) : 1;
  const std::size_t gusts = blown->pieces.size() / clones;
  if (blown->pieces.size() != still->pieces.size() || blown->pieces.size() % clones != 0 || gusts < 4) {
    return Error{windy.source + " and " + calm.source + ": have " + std::to_string(blown->pieces.size()) + " and " +
                 std::to_string(still->pieces.size()) + " episodes, expected as many of each, " +
                 std::to_string(clones) + " for each of at least 4 gusts"};
  }
  const Pairs pairs{*blown, *still, *wind, blown->rate_hz};
  std::vector<Ensemble> ensembles;
  for (std::size_t k = 0; k < gusts; ++k) {
    Ensemble ensemble = ensemble_of(pairs, k * clones, clones, options.after_seconds);
    if (ensemble.change.size() > 2) ensembles.push_back(std::move(ensemble));
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
  fit.inputs = inputs_of(*wind);
  fit.figures.gusts_learned = told.size();
  fit.figures.gusts_judged = judged.size();
  Sums velocity, displacement;
  std::vector<double> angles;
  for (const Ensemble& gust : judged) {
    judge(gust, fit.response, pairs.rate_hz, velocity, displacement, angles, fit.figures);
  }
  fit.figures.fit_percent = displacement.fit();
  fit.figures.velocity_fit_percent = velocity.fit();
  std::sort(angles.begin(), angles.end());
  fit.figures.direction_degrees = angles[angles.size() / 2];
  for (double angle : angles) fit.figures.direction_degrees_mean += angle / static_cast<double>(angles.size());
  return fit;
}

}  // namespace wisp
