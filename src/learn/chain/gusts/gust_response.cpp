#include "learn/chain/gusts/gust_play.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

namespace wisp::chain {
namespace {

constexpr double kStill = 1e-3;        // m/s: weaker wind counts as calm
constexpr double kAfterSeconds = 0.3;  // time after the gust that is included in learning and judging
constexpr const char* kWinds[] = {"wind.x", "wind.y", "wind.z"};

void add(Triple& sum, const Triple& value, double factor) {
  for (std::size_t axis = 0; axis < 3; ++axis) sum[axis] += factor * value[axis];
}

void add_normal(std::array<Triple, 3>& sum, const Quad& q, double factor) {
  const Triple normal = in_world_axes(q, {0, 0, 1});
  for (std::size_t axis = 0; axis < 3; ++axis) add(sum[axis], normal, factor * normal[axis]);
}

// Displacement of a windy piece relative to its calm twin since the onset.
Triple displacement_of(const MotionPiece& blown, const MotionPiece& still, std::size_t onset, std::size_t row) {
  Triple out{};
  add(out, blown.position[row], 1);
  add(out, blown.position[onset], -1);
  add(out, still.position[row], -1);
  add(out, still.position[onset], 1);
  return out;
}

double error_of_mean(const std::vector<Triple>& ends, const Triple& mean) {
  if (ends.size() < 2) return 0;
  double square = 0;
  for (const Triple& end : ends) square += std::pow(end[0] - mean[0], 2) + std::pow(end[1] - mean[1], 2);
  const auto count = static_cast<double>(ends.size());
  return std::sqrt(square / (count - 1) / count);
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

// Index of the episode with a row, and the row's index in it.
std::pair<std::size_t, std::size_t> place_in(std::span<const Episode> all, std::size_t row) {
  std::size_t k = 0;
  while (all[k].end <= row) ++k;
  return {k, row - all[k].begin};
}

constexpr int kRefinements = 24;
constexpr double kNudge = 1e-5;
// In a steady wind, a body carried by the air ends up moving with the air. A response without that constraint is used
// only where its squared error over the gusts is below this share of the constrained response's.
constexpr double kMuchBetter = 0.8;

using Axis = GustResponse::Axis;
using Ensemble = GustEnsemble;

std::vector<Triple> simulated(const Ensemble& gust, const GustResponse& response) {
  std::vector<Triple> change(gust.wind.size());
  for (std::size_t row = 0; row < change.size(); ++row) {
    const Triple before = row > 0 ? change[row - 1] : Triple{};
    Triple through = gust.wind[row];
    for (std::size_t axis = 0; axis < 3; ++axis) through[axis] -= before[axis];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const Axis& of = axis < 2 ? response.ground : response.vertical;
      change[row][axis] =
          of.change * before[axis] + of.wind * gust.wind[row][axis] + of.press * dot(gust.normal[row][axis], through);
    }
  }
  return change;
}

// Parameters of the search: for each Axis of GustResponse its fields change, press and, unless `carried`, wind. With
// `carried`, a steady wind carries the body along: wind = 1 − change.
struct Unknowns {
  bool carried;

  std::size_t size() const { return carried ? 4 : 6; }

  GustResponse response(const std::vector<double>& theta) const {
    GustResponse out;
    auto next = theta.begin();
    for (Axis* axis : {&out.ground, &out.vertical}) {
      axis->change = *next++;
      axis->press = *next++;
      axis->wind = carried ? 1 - axis->change : *next++;
    }
    return out;
  }

  // Initial parameters: a light body, carried along within a few steps.
  std::vector<double> begun() const {
    return carried ? std::vector<double>{0.8, 0, 0.8, 0} : std::vector<double>{0.8, 0, 0.2, 0.8, 0, 0.2};
  }
};

double squared_error(std::span<const Ensemble> gusts, const GustResponse& response) {
  double sum = 0;
  for (const Ensemble& gust : gusts) {
    const auto change = simulated(gust, response);
    for (std::size_t t = 0; t < change.size(); ++t) {
      for (std::size_t axis = 0; axis < 3; ++axis) sum += std::pow(change[t][axis] - gust.change[t][axis], 2);
    }
  }
  return sum;
}

// One Levenberg–Marquardt step on the error of free simulation, with derivatives by finite differences.
std::vector<double> refined(std::span<const Ensemble> gusts, const Unknowns& unknowns, const std::vector<double>& theta,
                            double damping) {
  const auto size = static_cast<Eigen::Index>(theta.size());
  Eigen::MatrixXd squares = Eigen::MatrixXd::Zero(size, size);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(size), row(size);
  for (const Ensemble& gust : gusts) {
    const auto now = simulated(gust, unknowns.response(theta));
    std::vector<std::vector<Triple>> nudged;
    for (std::size_t k = 0; k < theta.size(); ++k) {
      auto other = theta;
      other[k] += kNudge;
      nudged.push_back(simulated(gust, unknowns.response(other)));
    }
    for (std::size_t t = 0; t < now.size(); ++t) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        for (Eigen::Index k = 0; k < size; ++k) {
          row[k] = (nudged[static_cast<std::size_t>(k)][t][axis] - now[t][axis]) / kNudge;
        }
        squares += row * row.transpose();
        right += (gust.change[t][axis] - now[t][axis]) * row;
      }
    }
  }
  // A parameter that does not affect any row remains unchanged.
  for (double& own : squares.diagonal()) own += own == 0 ? 1 : damping * own;
  const Eigen::VectorXd step = squares.ldlt().solve(right);
  auto out = theta;
  for (std::size_t k = 0; k < out.size(); ++k) out[k] += step[static_cast<Eigen::Index>(k)];
  return out;
}

struct Found {
  GustResponse response;
  double error = 0;
};

Found fitted(std::span<const Ensemble> gusts, const Unknowns& unknowns) {
  auto theta = unknowns.begun();
  double error = squared_error(gusts, unknowns.response(theta)), damping = 1e-4;
  for (int round = 0; round < kRefinements; ++round) {
    const auto tried = refined(gusts, unknowns, theta, damping);
    const double found = squared_error(gusts, unknowns.response(tried));
    if (found < error) {
      theta = tried;
      error = found;
      damping /= 4;
    } else {
      damping *= 16;
    }
  }
  return {unknowns.response(theta), error};
}

GustResponse fitted(std::span<const Ensemble> gusts) {
  Found carried = fitted(gusts, Unknowns{true}), free = fitted(gusts, Unknowns{false});
  return free.error < kMuchBetter * carried.error ? free.response : carried.response;
}

std::vector<Input> inputs_of(const std::array<const std::vector<double>*, 3>& wind) {
  double most = 0;
  for (const auto* channel : wind) {
    for (double sample : *channel) most = std::max(most, std::abs(sample));
  }
  std::vector<Input> inputs;
  // One range for all axes: the direction of the recorded gusts is arbitrary.
  for (const char* name : {"wind.x", "wind.y", "wind.z"})
    inputs.push_back({name, "m/s", -most, most, InputShape::kLinear});
  return inputs;
}

}  // namespace

Triple GustPairs::wind_at(std::size_t piece, std::size_t row) const {
  const std::size_t at = windy.pieces[piece].first_row + row;
  return {(*wind[0])[at], (*wind[1])[at], (*wind[2])[at]};
}

Result<GustPairs> gust_pairs(const Recording& windy, const Recording& calm) {
  const auto wind = wind_channels(windy);
  if (!wind) return wind.error();
  auto blown = motion_of(std::span(&windy, 1)), still = motion_of(std::span(&calm, 1));
  if (!blown) return blown.error();
  if (!still) return still.error();
  if (!same_rate(blown->rate_hz, still->rate_hz))
    return Error{calm.source + ": has another rate than " + windy.source + ", expected its twin at one rate"};
  const auto stated = numbers_attribute(windy, "clones");
  if (!stated) return stated.error();
  const auto clones = *stated && !(*stated)->empty() ? static_cast<std::size_t>(std::max(1.0, (*stated)->front())) : 1;
  const std::size_t pieces = blown->pieces.size();
  if (pieces != still->pieces.size() || pieces % clones != 0 || pieces / clones < 4) {
    return Error{windy.source + " and " + calm.source + ": have " + std::to_string(pieces) + " and " +
                 std::to_string(still->pieces.size()) + " episodes, expected as many of each, " +
                 std::to_string(clones) + " for each of at least 4 gusts"};
  }
  const auto in_windy = episodes(windy), in_calm = episodes(calm);
  for (std::size_t k = 0; k < pieces; ++k) {
    if (place_in(in_windy, blown->pieces[k].first_row) == place_in(in_calm, still->pieces[k].first_row)) continue;
    return Error{row_name(windy, blown->pieces[k].first_row) + ": a stretch begins here that has no twin in " +
                 calm.source + ": fill in the missing rows of both"};
  }
  return GustPairs{std::move(*blown), std::move(*still), *wind, clones, windy.source};
}

GustSpan span_of(const GustPairs& pairs, std::size_t gust) {
  const std::size_t first = gust * pairs.clones;
  std::size_t rows = pairs.windy.pieces[first].rows();
  for (std::size_t k = first; k < first + pairs.clones; ++k) {
    rows = std::min({rows, pairs.windy.pieces[k].rows(), pairs.calm.pieces[k].rows()});
  }
  std::size_t onset = rows, last = 0;
  for (std::size_t k = first; k < first + pairs.clones; ++k) {
    for (std::size_t row = 0; row < rows; ++row) {
      if (length_of(pairs.wind_at(k, row)) < kStill) continue;
      onset = std::min(onset, row);
      last = std::max(last, row);
    }
  }
  const auto end = last + 1 + static_cast<std::size_t>(std::lround(kAfterSeconds * pairs.windy.rate_hz));
  return {onset, std::max(onset, std::min(rows, end))};
}

GustEnsemble ensemble_of(const GustPairs& pairs, std::size_t gust, const GustSpan& span, std::size_t first,
                         std::size_t stride) {
  GustEnsemble mean;
  std::vector<std::size_t> pieces;
  for (std::size_t k = first; k < pairs.clones; k += stride) pieces.push_back(gust * pairs.clones + k);
  const double share = 1.0 / static_cast<double>(pieces.size());
  std::vector<Triple> ends;
  for (std::size_t row = span.onset; row < span.end; ++row) {
    Triple change{}, displacement{}, wind{};
    std::array<Triple, 3> normal{};
    ends.clear();
    for (std::size_t k : pieces) {
      const MotionPiece &blown = pairs.windy.pieces[k], &still = pairs.calm.pieces[k];
      add(change, blown.velocity[row], share);
      add(change, still.velocity[row], -share);
      ends.push_back(displacement_of(blown, still, span.onset, row));
      add(displacement, ends.back(), share);
      add(wind, pairs.wind_at(k, row), share);
      if (pairs.calm.has_orientation) add_normal(normal, still.orientation[row], share);
    }
    mean.change.push_back(change);
    mean.displacement.push_back(displacement);
    mean.wind.push_back(wind);
    mean.normal.push_back(normal);
  }
  if (!ends.empty()) mean.displacement_error = error_of_mean(ends, mean.displacement.back());
  return mean;
}

Result<GustFit> learn_gusts(const GustPairs& pairs, std::size_t gusts) {
  std::vector<Ensemble> ensembles;
  for (std::size_t k = 0; k < gusts; ++k) {
    const GustSpan span = span_of(pairs, k);
    if (span.rows() > 2) ensembles.push_back(ensemble_of(pairs, k, span));
  }
  if (ensembles.size() < 2)
    return Error{pairs.source + ": has fewer than 2 gusts of wind to learn from, expected more"};
  return GustFit{fitted(ensembles), inputs_of(pairs.wind)};
}

}  // namespace wisp::chain
