#include "studies/baselines/dynamic_texture.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace wisp::baselines {
namespace {

Eigen::Index frame_count(std::span<const Frames> frames) {
  Eigen::Index count = 0;
  for (const Frames& each : frames) count += each.size();
  return count;
}

double mean_wind(std::span<const Frames> frames) {
  double sum = 0;
  for (const Frames& each : frames) sum += each.wind.sum();
  return sum / static_cast<double>(frame_count(frames));
}

// As many principal components as carry the share of the variance.
Eigen::MatrixXd components(std::span<const Frames> frames, const Eigen::VectorXd& mean, double share) {
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(mean.size(), mean.size());
  for (const Frames& each : frames) {
    const Eigen::MatrixXd deviations = each.outputs.rowwise() - mean.transpose();
    covariance += deviations.transpose() * deviations;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(covariance);  // ascending
  const double total = solver.eigenvalues().sum();
  Eigen::Index kept = 0;
  double carried = 0;
  while (kept < mean.size() && carried < share * total) carried += solver.eigenvalues()[mean.size() - ++kept];
  return solver.eigenvectors().rightCols(kept).rowwise().reverse();
}

// Rows of states, and of what they follow from: the state before and the wind now.
struct Regression {
  Eigen::MatrixXd from;
  Eigen::MatrixXd to;
};

Regression regression(std::span<const Frames> frames, const DynamicTexture& texture) {
  const Eigen::Index n = texture.c.cols();
  const Eigen::Index rows = frame_count(frames) - static_cast<Eigen::Index>(frames.size());
  Regression out{Eigen::MatrixXd(rows, n + (texture.driven ? 1 : 0)), Eigen::MatrixXd(rows, n)};
  Eigen::Index at = 0;
  for (const Frames& each : frames) {
    const Eigen::MatrixXd states = (each.outputs.rowwise() - texture.mean.transpose()) * texture.c;
    const Eigen::Index steps = each.size() - 1;
    out.from.block(at, 0, steps, n) = states.topRows(steps);
    if (texture.driven) out.from.col(n).segment(at, steps) = each.wind.tail(steps).array() - texture.mean_wind;
    out.to.middleRows(at, steps) = states.bottomRows(steps);
    at += steps;
  }
  return out;
}

double radius_of(const Eigen::MatrixXd& a) { return a.eigenvalues().cwiseAbs().maxCoeff(); }

// B with B B' = covariance, whatever its rank.
Eigen::MatrixXd root(const Eigen::MatrixXd& covariance) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(covariance);
  return solver.eigenvectors() * solver.eigenvalues().cwiseMax(0).cwiseSqrt().asDiagonal();
}

}  // namespace

std::size_t DynamicTexture::bytes() const {
  const auto numbers = mean.size() + c.size() + a.size() + b.size() + (driven ? g.size() + 1 : 0);
  return 4 * static_cast<std::size_t>(numbers);
}

std::int64_t DynamicTexture::operations() const {
  const Eigen::Index n = states();
  // A x, B v, C x + mean, and G u.
  return 2 * (n * n + n * n + c.rows() * n) + (driven ? 2 * n + 1 : 0);
}

DynamicTexture learn_dynamic_texture(std::span<const Frames> frames, const DynamicTextureOptions& options) {
  DynamicTexture out;
  out.mean = mean_of(frames);
  out.driven = options.driven;
  out.mean_wind = mean_wind(frames);
  out.c = components(frames, out.mean, options.variance);
  const Eigen::Index n = out.c.cols();
  const Regression data = regression(frames, out);
  const Eigen::MatrixXd theta =
      (data.from.transpose() * data.from).ldlt().solve(data.from.transpose() * data.to).transpose();
  out.a = theta.leftCols(n);
  out.g = out.driven ? Eigen::VectorXd(theta.col(n)) : Eigen::VectorXd::Zero(n);
  const Eigen::MatrixXd residual = data.to - data.from * theta.transpose();
  out.b = root(residual.transpose() * residual / static_cast<double>(residual.rows()));
  out.found_radius = radius_of(out.a);
  if (out.found_radius > options.radius) out.a *= options.radius / out.found_radius;
  return out;
}

DynamicTexturePlayer::DynamicTexturePlayer(const DynamicTexture& texture, std::uint64_t seed, bool noise)
    : texture_(texture), random_(seed), noise_(noise), state_(Eigen::VectorXd::Zero(texture.states())) {}

Eigen::VectorXd DynamicTexturePlayer::step(double wind) {
  state_ = texture_.a * state_ + texture_.g * (wind - texture_.mean_wind);
  if (noise_) state_ += texture_.b * random_.next(texture_.states());
  return texture_.mean + texture_.c * state_;
}

}  // namespace wisp::baselines
