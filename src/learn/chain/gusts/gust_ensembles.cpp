#include "learn/chain/gusts/gust_ensembles.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <string>

namespace wisp::chain {
namespace {

constexpr double kStill = 1e-3;  // m/s: wind below it is none
constexpr const char* kWinds[] = {"wind.x", "wind.y", "wind.z"};

void add(Triple& sum, const Triple& value, double factor) {
  for (std::size_t axis = 0; axis < 3; ++axis) sum[axis] += factor * value[axis];
}

void add_normal(std::array<Triple, 3>& sum, const Quad& q, double factor) {
  const Triple normal = in_world_axes(q, {0, 0, 1});
  for (std::size_t axis = 0; axis < 3; ++axis) add(sum[axis], normal, factor * normal[axis]);
}

// How far a piece of the windy recording has gone since the onset beyond its calm twin.
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
  const auto stated = numbers_attribute(windy, "clones");
  if (!stated) return stated.error();
  const auto clones = *stated && !(*stated)->empty() ? static_cast<std::size_t>(std::max(1.0, (*stated)->front())) : 1;
  const std::size_t pieces = blown->pieces.size();
  if (pieces != still->pieces.size() || pieces % clones != 0 || pieces / clones < 4) {
    return Error{windy.source + " and " + calm.source + ": have " + std::to_string(pieces) + " and " +
                 std::to_string(still->pieces.size()) + " episodes, expected as many of each, " +
                 std::to_string(clones) + " for each of at least 4 gusts"};
  }
  return GustPairs{std::move(*blown), std::move(*still), *wind, clones};
}

GustSpan span_of(const GustPairs& pairs, std::size_t gust, double after_seconds) {
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
  const auto end = last + 1 + static_cast<std::size_t>(std::lround(after_seconds * pairs.windy.rate_hz));
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

void FitSums::add(const Triple& found, const Triple& expected) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    error += std::pow(found[axis] - expected[axis], 2);
    size += expected[axis] * expected[axis];
  }
}

double FitSums::fit_percent() const { return 100 * (1 - std::sqrt(error / size)); }

double degrees_between(const Triple& a, const Triple& b) {
  const double across = a[0] * b[1] - a[1] * b[0], along = a[0] * b[0] + a[1] * b[1];
  return std::abs(std::atan2(across, along)) * 180 / std::acos(-1.0);
}

}  // namespace wisp::chain
