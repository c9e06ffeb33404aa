#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <string>
#include <utility>

#include "learn/chain/segments/modes.hpp"
#include "learn/numeric/clustering.hpp"
#include "learn/numeric/decompositions.hpp"
#include "model/bspline.hpp"
#include "wisp/model/chain.hpp"
#include "wisp/run/random.hpp"

namespace wisp::chain {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kControlPoints = 8;
constexpr long kComponents = 12;
constexpr double kStiffness = 1e-3;  // weight of the control points' second differences against the misfit

// Least-squares matrix from rows to control points for a segment of `steps` steps: control points × rows. The spline
// interpolates the first and last row, where segments join.
MatrixXd smoother(int steps) {
  const auto knots = uniform_knots(kControlPoints);
  const long rows = steps + 1, points = kControlPoints, inner = points - 2;
  MatrixXd weights = MatrixXd::Zero(rows, points);
  for (long row = 0; row < rows; ++row) {
    const BasisWeights at = basis(knots, static_cast<double>(row) / steps);
    for (long k = 0; k < 4; ++k) weights(row, at.first + k) = at.weight[static_cast<std::size_t>(k)];
  }
  MatrixXd bends = MatrixXd::Zero(inner, points);
  for (long k = 0; k < inner; ++k) bends.block(k, k, 1, 3) << 1, -2, 1;
  const MatrixXd normal = weights.transpose() * weights + kStiffness * bends.transpose() * bends;
  MatrixXd out = MatrixXd::Zero(points, rows);
  out(0, 0) = out(points - 1, rows - 1) = 1;
  MatrixXd right = weights.middleCols(1, inner).transpose();
  right.col(0) -= normal.block(1, 0, inner, 1);
  right.col(rows - 1) -= normal.block(1, points - 1, inner, 1);
  out.middleRows(1, inner) = symmetric_solutions(normal.block(1, 1, inner, inner), right);
  return out;
}

MatrixXd numbers_of(const MotionPiece& piece) {
  const bool pose = !piece.orientation.empty();
  MatrixXd rows(static_cast<long>(piece.rows()), pose ? 7 : 3);
  for (std::size_t row = 0; row < piece.rows(); ++row) {
    const auto r = static_cast<long>(row);
    for (long k = 0; k < 3; ++k) rows(r, k) = piece.position[row][static_cast<std::size_t>(k)];
    for (long k = 0; pose && k < 4; ++k) rows(r, 3 + k) = piece.orientation[row][static_cast<std::size_t>(k)];
  }
  return rows;
}

void put_numbers(const MatrixXd& rows, MotionPiece& piece) {
  for (std::size_t row = 0; row < piece.rows(); ++row) {
    const auto r = static_cast<long>(row);
    for (long k = 0; k < 3; ++k) piece.position[row][static_cast<std::size_t>(k)] = rows(r, k);
    if (piece.orientation.empty()) continue;
    const Eigen::Vector4d q = rows.row(r).tail(4).transpose().normalized();
    for (long k = 0; k < 4; ++k) piece.orientation[row][static_cast<std::size_t>(k)] = q(k);
  }
}

// Negates quaternions where needed, so that all pieces of a mode begin in one hemisphere (q and −q are one rotation).
void align_signs(std::span<MotionPiece* const> pieces) {
  if (pieces.empty() || pieces.front()->orientation.empty()) return;
  Eigen::Matrix4d square = Eigen::Matrix4d::Zero();
  for (const MotionPiece* piece : pieces) {
    const Eigen::Map<const Eigen::Vector4d> q(piece->orientation.front().data());
    square += q * q.transpose();
  }
  const VectorXd usual = symmetric_eigensystem(square).vectors.col(3);
  for (MotionPiece* piece : pieces) {
    if (Eigen::Map<const Eigen::Vector4d>(piece->orientation.front().data()).dot(usual) >= 0) continue;
    for (Quad& q : piece->orientation) {
      for (double& x : q) x = -x;
    }
  }
}

// Replaces each piece of one mode by a spline, projected on the mode's kComponents largest principal components.
void smooth_mode(std::span<MotionPiece* const> pieces, std::map<int, MatrixXd>& smoothers) {
  if (pieces.empty()) return;
  align_signs(pieces);
  const long channels = pieces.front()->orientation.empty() ? 3 : 7;
  MatrixXd controls(static_cast<long>(pieces.size()), kControlPoints * channels);
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    const int steps = static_cast<int>(pieces[k]->rows()) - 1;
    const auto [found, fresh] = smoothers.try_emplace(steps);
    if (fresh) found->second = smoother(steps);
    const MatrixXd points = found->second * numbers_of(*pieces[k]);
    for (long point = 0; point < kControlPoints; ++point) {
      controls.row(static_cast<long>(k)).segment(point * channels, channels) = points.row(point);
    }
  }
  const Eigen::RowVectorXd mean = controls.colwise().mean();
  controls.rowwise() -= mean;
  const MatrixXd axes = symmetric_eigensystem(controls.transpose() * controls).vectors.rightCols(kComponents);
  const MatrixXd kept = (controls * axes * axes.transpose()).rowwise() + mean;
  const auto knots = uniform_knots(kControlPoints);
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    MatrixXd points(kControlPoints, channels);
    for (long point = 0; point < kControlPoints; ++point) {
      points.row(point) = kept.row(static_cast<long>(k)).segment(point * channels, channels);
    }
    MatrixXd rows(static_cast<long>(pieces[k]->rows()), channels);
    for (long row = 0; row < rows.rows(); ++row) {
      const BasisWeights at = basis(knots, static_cast<double>(row) / static_cast<double>(rows.rows() - 1));
      const Eigen::Map<const Eigen::RowVector4d> weight(at.weight.data());
      rows.row(row) = weight * points.middleRows(at.first, 4);
    }
    put_numbers(rows, *pieces[k]);
  }
}

constexpr double kRidge = 1e-6;     // share of a term's mean square: regularises collinear terms
constexpr double kMinRidge = 1e-9;  // share of all terms' mean square: regularises terms that are always 0
constexpr int kStates = 6;          // velocity and angular velocity in body axes

using State = Eigen::Matrix<double, kStates, 1>;

State state_at(const MotionPiece& piece, std::size_t row) {
  const Triple v = in_body_axes(piece.orientation[row], piece.velocity[row]);
  const Triple w = in_body_axes(piece.orientation[row], piece.spin[row]);
  return State{v[0], v[1], v[2], w[0], w[1], w[2]};
}

// Terms: 1, the velocities, "up" in body axes and, for degree 2, their products.
VectorXd terms_of(const State& state, const Quad& orientation, int degree) {
  const Triple up = in_body_axes(orientation, {0, 0, 1});
  Eigen::Matrix<double, kStates + 3, 1> seen;
  seen << state, up[0], up[1], up[2];
  VectorXd terms(degree == 1 ? 10 : 55);
  terms.head(10) << 1, seen;
  long at = 10;
  for (long i = 0; degree == 2 && i < seen.size(); ++i) {
    for (long j = i; j < seen.size(); ++j) terms[at++] = seen[i] * seen[j];
  }
  return terms;
}

// z(t + 1) = coefficient · terms(z(t)) + noise · e(t), clamped to the observed range of states.
struct System {
  MatrixXd coefficient;  // states × terms
  Eigen::Matrix<double, kStates, kStates> noise = Eigen::Matrix<double, kStates, kStates>::Zero();
  State lowest = State::Constant(std::numeric_limits<double>::max());
  State highest = State::Constant(std::numeric_limits<double>::lowest());
};

Result<System> fitted_system(std::span<const MotionPiece* const> pieces, int mode, int degree) {
  const long terms = degree == 1 ? 10 : 55;
  MatrixXd gram = MatrixXd::Zero(terms, terms), cross = MatrixXd::Zero(terms, kStates);
  Eigen::Matrix<double, kStates, kStates> square = Eigen::Matrix<double, kStates, kStates>::Zero();
  System system;
  long rows = 0;
  for (const MotionPiece* piece : pieces) {
    for (std::size_t row = 0; row + 1 < piece->rows(); ++row, ++rows) {
      const VectorXd seen = terms_of(state_at(*piece, row), piece->orientation[row], degree);
      const State next = state_at(*piece, row + 1);
      gram.noalias() += seen * seen.transpose();
      cross.noalias() += seen * next.transpose();
      square += next * next.transpose();
      system.lowest = system.lowest.cwiseMin(next);
      system.highest = system.highest.cwiseMax(next);
    }
  }
  if (rows < 4 * terms) {
    return Error{"mode " + std::to_string(mode) + " has " + std::to_string(rows) + " rows, expected at least " +
                 std::to_string(4 * terms) + " to fit a system: record for longer, or choose fewer modes"};
  }
  MatrixXd ridged = gram;
  ridged.diagonal() = (1 + kRidge) * gram.diagonal().array() + kMinRidge * gram.trace() / static_cast<double>(terms);
  const MatrixXd found = symmetric_solutions(ridged, cross);
  system.coefficient = found.transpose();
  if (degree == 1) {
    Eigen::Matrix<double, kStates, kStates> left =
        square - found.transpose() * cross - cross.transpose() * found + found.transpose() * gram * found;
    left = left / static_cast<double>(rows) + 1e-12 * Eigen::Matrix<double, kStates, kStates>::Identity();
    system.noise = left.llt().matrixL();
  }
  return system;
}

// Simulates a system from a piece's first row for the piece's duration.
void play(const System& system, int degree, double rate_hz, std::mt19937& words, MotionPiece& piece) {
  State state = state_at(piece, 0);
  for (std::size_t row = 1; row < piece.rows(); ++row) {
    State shock;
    for (long k = 0; k < kStates; k += 2) {
      const auto pair = normal_pair(static_cast<std::uint32_t>(words()));
      shock[k] = pair[0];
      shock[k + 1] = pair[1];
    }
    const Quad& before = piece.orientation[row - 1];
    state = system.coefficient * terms_of(state, before, degree) + system.noise * shock;
    state = state.cwiseMax(system.lowest).cwiseMin(system.highest);
    // Rotates by the new angular velocity over the step, then moves by the mean of the old and new velocity.
    const Triple turn = in_world_axes(before, {state[3], state[4], state[5]});
    Quad q = before;
    const double half = 0.5 / rate_hz;
    q[0] -= half * (turn[0] * before[1] + turn[1] * before[2] + turn[2] * before[3]);
    q[1] += half * (turn[0] * before[0] + turn[1] * before[3] - turn[2] * before[2]);
    q[2] += half * (turn[1] * before[0] + turn[2] * before[1] - turn[0] * before[3]);
    q[3] += half * (turn[2] * before[0] + turn[0] * before[2] - turn[1] * before[1]);
    const double length = Eigen::Map<const Eigen::Vector4d>(q.data()).norm();
    for (double& x : q) x /= length;
    piece.orientation[row] = q;
    piece.spin[row] = in_world_axes(q, {state[3], state[4], state[5]});
    piece.velocity[row] = in_world_axes(q, {state[0], state[1], state[2]});
    for (std::size_t k = 0; k < 3; ++k) {
      piece.position[row][k] =
          piece.position[row - 1][k] + half * (piece.velocity[row - 1][k] + piece.velocity[row][k]);
    }
  }
}

// Copies every segment to a separate piece of motion.
RealisedSegments cut_apart(const SortedSegments& from, bool heading_free) {
  RealisedSegments out{
      {from.motion.has_orientation, from.motion.rate_hz, {}, {}}, {}, {from.mode.begin(), from.mode.end()}, from.modes};
  for (const Segment& one : from.segments) {
    out.motion.pieces.push_back(cut_out(from.motion, one, heading_free));
    out.segments.push_back({out.motion.pieces.size() - 1, 0, static_cast<double>(one.steps), one.steps});
  }
  return out;
}

std::vector<std::vector<MotionPiece*>> by_mode(RealisedSegments& made) {
  std::vector<std::vector<MotionPiece*>> pieces(static_cast<std::size_t>(made.modes));
  for (std::size_t k = 0; k < made.mode.size(); ++k) pieces[made.mode[k]].push_back(&made.motion.pieces[k]);
  return pieces;
}

// ---- Modes split into chains ----

constexpr std::size_t kKinds = 2;  // number of clusters per mode and half

// Splits every segment into halves. A half's group is mode × 2, plus 1 for the second half.
std::pair<std::vector<Segment>, std::vector<std::size_t>> halves_of(const SortedSegments& from) {
  std::vector<Segment> segments;
  std::vector<std::size_t> group;
  for (std::size_t k = 0; k < from.segments.size(); ++k) {
    Segment first = from.segments[k];
    group.push_back(std::size_t{from.mode[k]} * 2);
    if (first.steps > 1) {
      Segment second = first;
      first.begin = std::round(first.begin);
      first.steps /= 2;
      first.end = second.begin = first.begin + first.steps;
      second.steps -= first.steps;
      second.end = second.begin + second.steps;
      segments.push_back(first);
      first = second;
      group.push_back(group.back() + 1);
    }
    segments.push_back(first);
  }
  return {std::move(segments), std::move(group)};
}

}  // namespace

RealisedSegments spline_segments(const SortedSegments& from, bool heading_free) {
  RealisedSegments made = cut_apart(from, heading_free);
  std::map<int, MatrixXd> smoothers;
  for (const auto& pieces : by_mode(made)) smooth_mode(pieces, smoothers);
  return made;
}

Result<RealisedSegments> system_segments(const SortedSegments& from, int degree, std::uint64_t seed) {
  if (!from.motion.has_orientation) {
    return Error{
        "a system of a mode turns as well as moves; these recordings have no orientation, realise modes by segments"};
  }
  RealisedSegments made = cut_apart(from, false);
  std::mt19937 words(static_cast<std::uint32_t>(seed));
  const auto pieces = by_mode(made);
  for (int mode = 0; mode < from.modes; ++mode) {
    const auto& own = pieces[static_cast<std::size_t>(mode)];
    const std::vector<const MotionPiece*> seen(own.begin(), own.end());
    const auto system = fitted_system(seen, mode, degree);
    if (!system) return system.error();
    for (MotionPiece* piece : own) play(*system, degree, from.motion.rate_hz, words, *piece);
  }
  return made;
}

Result<RealisedSegments> half_segments(const SortedSegments& from, bool heading_free, std::uint64_t seed) {
  auto [segments, group] = halves_of(from);
  const FeatureTable table = segment_features(from.motion, segments, heading_free);
  RealisedSegments out{from.motion, std::move(segments), std::vector<std::uint16_t>(group.size()), 0};
  for (std::size_t which = 0; which < static_cast<std::size_t>(from.modes) * 2; ++which) {
    std::vector<std::size_t> members;
    std::vector<double> values;
    for (std::size_t k = 0; k < group.size(); ++k) {
      if (group[k] != which) continue;
      members.push_back(k);
      const auto row = table.values.begin() + static_cast<long>(k * table.features);
      values.insert(values.end(), row, row + static_cast<long>(table.features));
    }
    if (members.empty()) continue;
    const auto kinds = static_cast<int>(std::min(kKinds, members.size()));
    const auto found = k_means(values, table.features, {.clusters = kinds, .seed = seed});
    if (!found) return found.error();
    for (std::size_t k = 0; k < members.size(); ++k) {
      out.mode[members[k]] = static_cast<std::uint16_t>(out.modes + found->cluster[k]);
    }
    out.modes += kinds;
  }
  if (static_cast<std::size_t>(out.modes) <= kMaxModes) return out;
  return Error{"chains of " + std::to_string(from.modes) + " modes of their own make " + std::to_string(out.modes) +
               " kinds of segment, expected at most " + std::to_string(kMaxModes) + ": choose fewer modes"};
}

}  // namespace wisp::chain
