#include "learn/chain/modes/mode_splines.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <map>

#include "learn/numeric/decompositions.hpp"
#include "model/bspline.hpp"

namespace wisp::chain {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kMaxStored = 32767;

// From the rows of a segment of so many steps to the control points: control points × rows. Ends go through the first
// and the last row, where segments join.
MatrixXd smoother(int steps, const ModeSplineOptions& options) {
  const auto knots = uniform_knots(options.control_points);
  const long rows = steps + 1, points = options.control_points, inner = points - 2;
  MatrixXd weights = MatrixXd::Zero(rows, points);
  for (long row = 0; row < rows; ++row) {
    const BasisWeights at = basis(knots, static_cast<double>(row) / steps);
    for (long k = 0; k < 4; ++k) weights(row, at.first + k) = at.weight[static_cast<std::size_t>(k)];
  }
  MatrixXd bends = MatrixXd::Zero(inner, points);
  for (long k = 0; k < inner; ++k) bends.block(k, k, 1, 3) << 1, -2, 1;
  const MatrixXd normal = weights.transpose() * weights + options.stiffness * bends.transpose() * bends;
  MatrixXd out = MatrixXd::Zero(points, rows);
  out(0, 0) = out(points - 1, rows - 1) = 1;
  MatrixXd right = weights.middleCols(1, inner).transpose();
  right.col(0) -= normal.block(1, 0, inner, 1);
  right.col(rows - 1) -= normal.block(1, points - 1, inner, 1);
  out.middleRows(1, inner) = symmetric_solutions(normal.block(1, 1, inner, inner), right);
  return out;
}

// Rows of one segment, rows × channels. Quaternions have the sign of `like`, a direction of four numbers.
MatrixXd rows_of_segment(const ChainModel& chain, std::size_t first, std::size_t count, const VectorXd& like) {
  const long channels = channel_count(chain.motion);
  MatrixXd rows(static_cast<long>(count), channels);
  const std::int16_t* number = chain.segments.rows.data() + first * static_cast<std::size_t>(channels);
  for (long row = 0; row < rows.rows(); ++row) {
    for (long channel = 0; channel < channels; ++channel) rows(row, channel) = *number++;
  }
  if (channels == 7 && rows.row(0).tail(4).dot(like) < 0) rows.rightCols(4) *= -1;
  return rows;
}

// The direction that quaternions with which segments begin have in common, whatever their sign.
VectorXd usual_orientation(const ChainModel& chain, const std::vector<std::uint32_t>& first, std::size_t begin,
                           std::size_t end) {
  if (chain.motion != ChainMotion::kPose) return VectorXd::Zero(4);
  MatrixXd moment = MatrixXd::Zero(4, 4);
  for (std::size_t segment = begin; segment < end; ++segment) {
    const std::int16_t* row = chain.segments.rows.data() + std::size_t{7} * first[segment] + 3;
    const Eigen::Vector4d q(row[0], row[1], row[2], row[3]);
    moment += q * q.transpose();
  }
  return symmetric_eigensystem(moment).vectors.col(3);
}

// Control points of all segments of one mode, one a row.
MatrixXd controls_of(const ChainModel& chain, const std::vector<std::uint32_t>& first, std::size_t begin,
                     std::size_t end, const ModeSplineOptions& options) {
  const VectorXd like = usual_orientation(chain, first, begin, end);
  const long channels = channel_count(chain.motion);
  std::map<int, MatrixXd> smoothers;
  MatrixXd controls(static_cast<long>(end - begin), options.control_points * channels);
  for (std::size_t segment = begin; segment < end; ++segment) {
    const int steps = chain.segments.steps[segment];
    const auto [found, fresh] = smoothers.try_emplace(steps);
    if (fresh) found->second = smoother(steps, options);
    const MatrixXd points =
        found->second * rows_of_segment(chain, first[segment], static_cast<std::size_t>(steps) + 1, like);
    for (long point = 0; point < points.rows(); ++point) {
      controls.row(static_cast<long>(segment - begin)).segment(point * channels, channels) = points.row(point);
    }
  }
  return controls;
}

// Adds one mode to the splines: its mean, its components, and the scores of its segments.
void add_mode(MatrixXd controls, ModeSplines& out) {
  const VectorXd mean = controls.colwise().mean();
  controls.rowwise() -= mean.transpose();
  const MatrixXd axes = symmetric_eigensystem(controls.transpose() * controls).vectors;
  for (double x : mean) out.mean.push_back(static_cast<float>(x));
  std::vector<VectorXd> scores;
  for (long k = 0; k < out.components; ++k) {
    const VectorXd axis = axes.col(axes.cols() - 1 - k);
    VectorXd score = controls * axis;
    const double most = std::max(score.cwiseAbs().maxCoeff(), 1e-6);
    for (double x : axis) out.component.push_back(static_cast<float>(x * most / kMaxStored));
    scores.push_back(score * (kMaxStored / most));
  }
  for (long segment = 0; segment < controls.rows(); ++segment) {
    for (const VectorXd& score : scores) {
      out.score.push_back(static_cast<std::int16_t>(std::lround(std::clamp(score(segment), -kMaxStored, kMaxStored))));
    }
  }
}

}  // namespace

void as_splines(ChainModel& chain, const ModeSplineOptions& options) {
  const auto first = segment_rows(chain.segments);
  const int channels = channel_count(chain.motion);
  ModeSplines splines;
  splines.control_points = options.control_points;
  splines.components = std::min(options.components, options.control_points * channels);
  for (std::size_t begin = 0; begin < chain.segments.size();) {
    std::size_t end = begin;
    while (end < chain.segments.size() && chain.segments.mode[end] == chain.segments.mode[begin]) ++end;
    add_mode(controls_of(chain, first, begin, end, options), splines);
    begin = end;
  }
  chain.segments.rows = rows_of(splines, chain.segments, channels);
  chain.splines = std::move(splines);
}

}  // namespace wisp::chain
