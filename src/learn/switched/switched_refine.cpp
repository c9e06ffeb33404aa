#include "learn/switched/switched_refine.hpp"

#include <Eigen/Cholesky>
#include <cmath>

#include "learn/numeric/decompositions.hpp"
#include "learn/switched/switched_start.hpp"

namespace wisp {
namespace {

using Eigen::ArrayXXd;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kSmallResidual = 0.01;  // of the single model's, see the header of switched_fit
constexpr double kGain = 1e-6;           // a round that gains less per row is the last
constexpr double kRegionRidge = 1e-2;  // of the regions' weights, squared: they would grow for ever where rows separate
constexpr double kUnseenSteps = 0.1;   // added to each count of transitions: none is impossible

// Each row's ln probability of the modes by a softmax of the regions' functions.
MatrixXd log_share(const MatrixXd& regions, const SwitchedRows& rows) {
  MatrixXd score = rows.phi * regions.transpose();
  for (Index t = 0; t < score.rows(); ++t) {
    const double most = score.row(t).maxCoeff();
    score.row(t).array() -= most + std::log((score.row(t).array() - most).exp().sum());
  }
  return score;
}

double region_objective(const MatrixXd& regions, const SwitchedRows& rows, const MatrixXd& weights) {
  return weights.cwiseProduct(log_share(regions, rows)).sum() - 0.5 * kRegionRidge * regions.squaredNorm();
}

// One Newton step of multinomial logistic regression towards the weights.
MatrixXd improve_regions(const MatrixXd& regions, const SwitchedRows& rows, const MatrixXd& weights) {
  const Index modes = regions.rows(), width = regions.cols();
  const MatrixXd share = log_share(regions, rows).array().exp();
  const MatrixXd slope = (weights - share).transpose() * rows.phi - kRegionRidge * regions;
  MatrixXd curvature(modes * width, modes * width);
  for (Index a = 0; a < modes; ++a) {
    for (Index b = 0; b <= a; ++b) {
      const VectorXd product = share.col(a).array() * ((a == b ? 1.0 : 0.0) - share.col(b).array());
      const MatrixXd block = rows.phi.transpose() * product.asDiagonal() * rows.phi;
      curvature.block(a * width, b * width, width, width) = block;
      curvature.block(b * width, a * width, width, width) = block.transpose();
    }
  }
  curvature.diagonal().array() += kRegionRidge;
  VectorXd gradient(modes * width);
  for (Index k = 0; k < modes; ++k) gradient.segment(k * width, width) = slope.row(k).transpose();
  const VectorXd move = symmetric_solution(curvature, gradient);
  const double before = region_objective(regions, rows, weights);
  double length = 1;
  for (int halving = 0; halving < 12; ++halving, length /= 2) {
    MatrixXd next = regions;
    for (Index k = 0; k < modes; ++k) next.row(k) += length * move.segment(k * width, width).transpose();
    if (region_objective(next, rows, weights) > before) return next;
  }
  return regions;
}

// Regions are separated by their dynamics and not by the size of their noise: while they are sought all have the same.
void pool_residuals(const SwitchedRows& rows, const VectorXd& least, RefinedModes& state) {
  const Index n = rows.rows(), count = state.weights.cols();
  MatrixXd residuals(n * count, rows.outputs());
  for (Index k = 0; k < count; ++k) residuals.middleRows(k * n, n) = rows.y - rows.phi * state.modes.theta[k];
  const MatrixXd factor = residual_factor(residuals, state.weights.reshaped(), least);
  for (MatrixXd& own : state.modes.factor) own = factor;
}

// The modes, the regions or the chain that suit the weights best.
void maximise(const SwitchedRows& rows, const VectorXd& least, RefinedModes& state, const MatrixXd& steps) {
  ScaledModes& modes = state.modes;
  const Index count = state.weights.cols();
  modes.theta.resize(static_cast<std::size_t>(count));
  modes.factor.resize(static_cast<std::size_t>(count));
  for (Index k = 0; k < count; ++k) {
    const VectorXd weights = state.weights.col(k);
    modes.theta[k] = weighted_theta(rows, weights);
    modes.factor[k] = residual_factor(rows.y - rows.phi * modes.theta[k], weights, least);
  }
  if (modes.switching == Switching::kRegions) {
    pool_residuals(rows, least, state);
    for (int step = 0; step < 2; ++step) modes.regions = improve_regions(modes.regions, rows, state.weights);
    return;
  }
  modes.initial = (state.weights.colwise().sum().transpose().array() + kUnseenSteps).matrix();
  modes.initial /= modes.initial.sum();
  modes.transitions = (steps.array() + kUnseenSteps).matrix();
  for (Index k = 0; k < count; ++k) modes.transitions.row(k) /= modes.transitions.row(k).sum();
}

// Shares the rows out. Returns the expected transitions, where there is a chain.
MatrixXd expect(const SwitchedRows& rows, RefinedModes& state) {
  const MatrixXd density = log_densities(state.modes, rows);
  if (state.modes.switching == Switching::kMarkov) {
    ModeBelief belief = believe(state.modes, rows, density);
    state.weights = std::move(belief.given_all);
    state.log_likelihood = belief.log_likelihood.sum();
    return std::move(belief.steps);
  }
  MatrixXd joint = density + log_share(state.modes.regions, rows);
  state.log_likelihood = 0;
  for (Index t = 0; t < joint.rows(); ++t) {
    const double most = joint.row(t).maxCoeff();
    const double sum = (joint.row(t).array() - most).exp().sum();
    state.log_likelihood += most + std::log(sum);
    joint.row(t).array() -= most + std::log(sum);
  }
  state.weights = joint.array().exp();
  return {};
}

MatrixXd counted_steps(const SwitchedRows& rows, const std::vector<int>& modes, int count) {
  MatrixXd steps = MatrixXd::Zero(count, count);
  for (const auto& run : rows.runs) {
    for (auto t = run.begin + 1; t < run.end; ++t) steps(modes[t - 1], modes[t]) += 1;
  }
  return steps;
}

void alternate(const SwitchedRows& rows, const VectorXd& least, RefinedModes& state, int rounds) {
  double before = -1e300;
  for (int round = 0; round < rounds; ++round) {
    const MatrixXd steps = expect(rows, state);
    if (round > 2 && state.log_likelihood - before < kGain * static_cast<double>(rows.rows())) return;
    before = state.log_likelihood;
    maximise(rows, least, state, steps);
  }
  expect(rows, state);
}

}  // namespace

Eigen::MatrixXd residual_factor(const MatrixXd& residual, const VectorXd& weights, const VectorXd& least) {
  const double total = std::max(weights.sum(), 1e-9);
  MatrixXd covariance = residual.transpose() * weights.asDiagonal() * residual / total;
  for (Index i = 0; i < least.size(); ++i) {
    covariance(i, i) = std::max(covariance(i, i) * (1 + 1e-9), least(i));
  }
  const Eigen::LLT<MatrixXd> solver(covariance);
  if (solver.info() == Eigen::Success) return solver.matrixL();
  return covariance.diagonal().cwiseSqrt().asDiagonal();
}

Eigen::VectorXd min_variance(const SwitchedRows& rows) {
  const MatrixXd residual = rows.y - rows.phi * weighted_theta(rows, VectorXd::Ones(rows.rows()));
  const VectorXd variance = residual.colwise().squaredNorm().transpose() / static_cast<double>(rows.rows());
  return (variance * kSmallResidual * kSmallResidual).array().max(1e-18);
}

RefinedModes refine(const SwitchedRows& rows, Switching switching, const std::vector<int>& first, int modes,
                    const Eigen::VectorXd& least, int rounds) {
  RefinedModes state;
  state.modes.switching = switching;
  state.modes.regions = MatrixXd::Zero(modes, rows.phi.cols());
  state.weights = MatrixXd::Zero(rows.rows(), modes);
  for (Index t = 0; t < rows.rows(); ++t) state.weights(t, first[static_cast<std::size_t>(t)]) = 1;
  maximise(rows, least, state, counted_steps(rows, first, modes));
  alternate(rows, least, state, rounds);
  return state;
}

RefinedModes refine_further(const SwitchedRows& rows, const RefinedModes& from, const Eigen::VectorXd& least,
                            int rounds) {
  RefinedModes state = from;
  alternate(rows, least, state, rounds);
  return state;
}

}  // namespace wisp
