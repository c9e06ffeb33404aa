#include "learn/chain/modes/mode_systems.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "learn/numeric/decompositions.hpp"

namespace wisp::chain {
namespace {

constexpr double kRidge = 1e-6;       // of the mean square of a term: terms may depend on each other
constexpr double kMinRidge = 1e-9;    // of that of all terms: some are never anything but 0
constexpr double kMaxOutside = 1e-3;  // share of rows beyond the range that velocities are held to, on either side
constexpr std::size_t kStates = kSystemStates;

using State = std::array<double, kStates>;

State state_at(const MotionPiece& piece, std::size_t row) {
  const Triple v = in_body_axes(piece.orientation[row], piece.velocity[row]);
  const Triple w = in_body_axes(piece.orientation[row], piece.spin[row]);
  return {v[0], v[1], v[2], w[0], w[1], w[2]};
}

Eigen::VectorXd terms_at(const MotionPiece& piece, std::size_t row, int degree) {
  const State state = state_at(piece, row);
  const Triple up = in_body_axes(piece.orientation[row], {0, 0, 1});
  std::array<double, kStates + 3> seen{};
  std::copy(state.begin(), state.end(), seen.begin());
  std::copy(up.begin(), up.end(), seen.begin() + kStates);
  Eigen::VectorXd terms(static_cast<Eigen::Index>(system_terms(degree)));
  Eigen::Index at = 0;
  terms[at++] = 1;
  for (double x : seen) terms[at++] = x;
  for (std::size_t i = 0; degree == 2 && i < seen.size(); ++i) {
    for (std::size_t j = i; j < seen.size(); ++j) terms[at++] = seen[i] * seen[j];
  }
  return terms;
}

// Rows of one mode from which the next row is also of it.
struct Rows {
  std::vector<std::pair<std::size_t, std::size_t>> at;  // piece, row
  std::vector<std::uint16_t> steps;                     // of its segments
};

std::vector<Rows> rows_of(const Motion& motion, std::span<const Segment> segments,
                          std::span<const std::uint16_t> cluster, int modes) {
  std::vector<Rows> rows(static_cast<std::size_t>(modes));
  for (std::size_t k = 0; k < segments.size(); ++k) {
    const Segment& one = segments[k];
    const std::size_t last = motion.pieces[one.piece].rows() - 1;
    const auto begin = static_cast<std::size_t>(std::lround(one.begin));
    const std::size_t end = std::min(last, begin + static_cast<std::size_t>(one.steps));
    for (std::size_t row = begin; row < end; ++row) rows[cluster[k]].at.emplace_back(one.piece, row);
    rows[cluster[k]].steps.push_back(static_cast<std::uint16_t>(one.steps));
  }
  return rows;
}

void take_range(std::vector<State>& states, ModeSystem& system) {
  const auto beyond = static_cast<std::size_t>(kMaxOutside * static_cast<double>(states.size()));
  for (std::size_t k = 0; k < kStates; ++k) {
    std::sort(states.begin(), states.end(), [&](const State& a, const State& b) { return a[k] < b[k]; });
    system.lowest[k] = states[beyond][k];
    system.highest[k] = states[states.size() - 1 - beyond][k];
  }
}

void take_durations(std::vector<std::uint16_t> steps, ModeSystem& system) {
  std::sort(steps.begin(), steps.end());
  for (std::size_t k = 0; k < kSystemDurations; ++k) {
    system.steps[k] = steps[(2 * k + 1) * steps.size() / (2 * kSystemDurations)];
  }
}

ModeSystem fit(const Motion& motion, const Rows& rows, const ModeSystemOptions& options) {
  const auto terms = static_cast<Eigen::Index>(system_terms(options.degree));
  Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(terms, terms), cross = Eigen::MatrixXd::Zero(terms, kStates);
  std::vector<State> states;
  for (const auto& [piece, row] : rows.at) {
    const Eigen::VectorXd seen = terms_at(motion.pieces[piece], row, options.degree);
    const State next = state_at(motion.pieces[piece], row + 1);
    gram.noalias() += seen * seen.transpose();
    for (std::size_t k = 0; k < kStates; ++k) cross.col(static_cast<Eigen::Index>(k)) += next[k] * seen;
    states.push_back(next);
  }
  const double usual = gram.trace() / static_cast<double>(terms);
  gram.diagonal() = (1 + kRidge) * gram.diagonal().array() + kMinRidge * usual;
  const Eigen::MatrixXd found = symmetric_solutions(gram, cross);
  ModeSystem system;
  for (Eigen::Index k = 0; k < found.cols(); ++k) {
    for (Eigen::Index i = 0; i < terms; ++i) system.coefficient.push_back(found(i, k));
  }
  if (options.noisy) {
    Eigen::Matrix<double, 6, 6> left = Eigen::Matrix<double, 6, 6>::Identity() * 1e-12;
    for (const auto& [piece, row] : rows.at) {
      const State next = state_at(motion.pieces[piece], row + 1);
      const Eigen::Matrix<double, 6, 1> error = Eigen::Map<const Eigen::Matrix<double, 6, 1>>(next.data()) -
                                                found.transpose() * terms_at(motion.pieces[piece], row, options.degree);
      left += error * error.transpose() / static_cast<double>(rows.at.size());
    }
    const Eigen::Matrix<double, 6, 6> lower = left.llt().matrixL();
    for (Eigen::Index k = 0; k < 6; ++k) {
      for (Eigen::Index i = 0; i < 6; ++i) system.noise.push_back(i <= k ? lower(k, i) : 0);
    }
  }
  take_range(states, system);
  take_durations(rows.steps, system);
  return system;
}

}  // namespace

Result<ModeSystems> fit_mode_systems(const Motion& motion, std::span<const Segment> segments,
                                     std::span<const std::uint16_t> cluster, int modes,
                                     const ModeSystemOptions& options) {
  if (!motion.has_orientation) {
    return Error{
        "a system of a mode turns as well as moves; these recordings have no orientation, realise modes by "
        "segments"};
  }
  ModeSystems systems{options.degree, {}};
  const auto rows = rows_of(motion, segments, cluster, modes);
  const std::size_t least = 4 * system_terms(options.degree);
  for (std::size_t mode = 0; mode < rows.size(); ++mode) {
    if (rows[mode].at.size() < least) {
      return Error{"mode " + std::to_string(mode) + " has " + std::to_string(rows[mode].at.size()) +
                   " rows, expected at least " + std::to_string(least) +
                   " to fit a system: record for longer, or choose fewer modes"};
    }
    systems.modes.push_back(fit(motion, rows[mode], options));
  }
  return systems;
}

}  // namespace wisp::chain
