#include "learn/numeric/lyapunov.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "learn/numeric/decompositions.hpp"

namespace wisp {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kCentres = 60;      // of the method: each takes away a fixed share of what is left above the best
constexpr int kNewtonSteps = 30;  // for each centre
constexpr double kCloser = 0.5;   // share of the way from the rate at a centre to the bound before that the next takes
constexpr double kSafe = 1 - 1e-7;  // a rate below it survives rounding

// Σ over l of (Aᵀ)ˡ Q Aˡ by doubling: the P with AᵀPA − P = −Q for a stable A.
MatrixXd lyapunov_sum(MatrixXd a, MatrixXd q) {
  for (int doubling = 0; doubling < 40; ++doubling) {
    const MatrixXd more = a.transpose() * q * a;
    if (!more.allFinite() || more.norm() <= 1e-15 * q.norm()) break;
    q += more;
    a = a * a;
  }
  return q;
}

// Largest λ of AᵀPA v = λPv.
double rate(const MatrixXd& a, const MatrixXd& p) {
  const MatrixXd m = a.transpose() * p * a;
  const auto values = generalized_eigenvalues(0.5 * (m + m.transpose()), p);
  return values ? values->maxCoeff() : 1e300;
}

class Centres {
 public:
  explicit Centres(std::vector<MatrixXd> matrices) : matrices_(std::move(matrices)), n_(matrices_.front().rows()) {
    for (Eigen::Index j = 0; j < n_; ++j) {
      for (Eigen::Index i = 0; i <= j; ++i) {
        MatrixXd unit = MatrixXd::Zero(n_, n_);
        unit(i, j) = unit(j, i) = 1;
        basis_.push_back(std::move(unit));
      }
    }
  }

  double rate_of(const MatrixXd& p) const {
    double most = 0;
    for (const MatrixXd& a : matrices_) most = std::max(most, rate(a, p));
    return most;
  }

  // Minimises tr P − ln det P − Σ ln det(bound·P − AᵀPA) from a P where it is finite.
  MatrixXd centre(MatrixXd p, double bound) const {
    for (int step = 0; step < kNewtonSteps; ++step) {
      const auto [gradient, hessian] = derivatives(p, bound);
      const VectorXd move = -symmetric_solution(hessian, gradient);
      const double decrement = -gradient.dot(move);
      if (!(decrement > 1e-8)) break;
      MatrixXd along = MatrixXd::Zero(n_, n_);
      for (std::size_t m = 0; m < basis_.size(); ++m) along += move(static_cast<Eigen::Index>(m)) * basis_[m];
      double length = 1 / (1 + std::sqrt(decrement));  // inside by the theory; kept only if it truly is
      while (length > 1e-10 && !inside(p + length * along, bound)) length /= 2;
      p += length * along;
    }
    return p;
  }

  // Scales that make a first P the identity.
  void change_coordinates(const MatrixXd& inverse_factor, const MatrixXd& factor) {
    for (MatrixXd& a : matrices_) a = factor.transpose() * a * inverse_factor.transpose();
  }

 private:
  MatrixXd slack(const MatrixXd& a, const MatrixXd& p, double bound) const { return bound * p - a.transpose() * p * a; }

  bool inside(const MatrixXd& p, double bound) const {
    if (Eigen::LLT<MatrixXd>(p).info() != Eigen::Success) return false;
    return std::all_of(matrices_.begin(), matrices_.end(), [&](const MatrixXd& a) {
      return Eigen::LLT<MatrixXd>(slack(a, p, bound)).info() == Eigen::Success;
    });
  }

  std::pair<VectorXd, MatrixXd> derivatives(const MatrixXd& p, double bound) const {
    const auto size = static_cast<Eigen::Index>(basis_.size());
    VectorXd gradient(size);
    for (Eigen::Index m = 0; m < size; ++m) gradient(m) = basis_[m].trace();
    MatrixXd hessian = MatrixXd::Zero(size, size);
    const auto add = [&](const MatrixXd& s, auto map) {
      const MatrixXd root = Eigen::LLT<MatrixXd>(s).matrixL().solve(MatrixXd::Identity(n_, n_));
      MatrixXd columns(n_ * n_, size);
      for (Eigen::Index m = 0; m < size; ++m) {
        const MatrixXd white = root * map(basis_[static_cast<std::size_t>(m)]) * root.transpose();
        gradient(m) -= white.trace();
        columns.col(m) = white.reshaped();
      }
      hessian += columns.transpose() * columns;
    };
    add(p, [](const MatrixXd& h) { return h; });
    for (const MatrixXd& a : matrices_) add(slack(a, p, bound), [&](const MatrixXd& h) { return slack(a, h, bound); });
    return {std::move(gradient), std::move(hessian)};
  }

  std::vector<MatrixXd> matrices_;
  Eigen::Index n_;
  std::vector<MatrixXd> basis_;  // of the symmetric matrices
};

// A P that suits the modes on the mean: the sum of their own Lyapunov functions.
MatrixXd first_guess(const std::vector<MatrixXd>& matrices) {
  const auto n = matrices.front().rows();
  MatrixXd p = MatrixXd::Zero(n, n);
  for (const MatrixXd& a : matrices) {
    const MatrixXd own = lyapunov_sum(a, MatrixXd::Identity(n, n));
    p += own / own.trace();
  }
  return p + 1e-12 * MatrixXd::Identity(n, n);
}

std::vector<double> row_major(const MatrixXd& p) {
  std::vector<double> out;
  for (Eigen::Index i = 0; i < p.rows(); ++i) {
    for (Eigen::Index j = 0; j < p.cols(); ++j) out.push_back(0.5 * (p(i, j) + p(j, i)));
  }
  return out;
}

}  // namespace

std::optional<std::vector<double>> find_common_lyapunov(const StateBlock& block) {
  if (block.states > kMaxSearchedStates || block.companion.empty()) return {};
  std::vector<MatrixXd> matrices;
  for (const auto& mode : block.companion) {
    matrices.push_back(Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(
        mode.data(), block.states, block.states));
  }
  const MatrixXd guess = first_guess(matrices);
  const Eigen::LLT<MatrixXd> guess_factor(guess);
  if (guess_factor.info() != Eigen::Success) return {};
  const MatrixXd factor = guess_factor.matrixL();
  const MatrixXd inverse = factor.triangularView<Eigen::Lower>().solve(MatrixXd::Identity(block.states, block.states));
  Centres centres(matrices);
  centres.change_coordinates(inverse, factor);
  MatrixXd p = MatrixXd::Identity(block.states, block.states);
  double best = centres.rate_of(p), bound = 1.5 * best + 1e-9;
  for (int round = 0; round < kCentres && best >= kSafe; ++round) {
    p = centres.centre(p, bound);
    const double found = centres.rate_of(p);
    if (!(found < bound)) break;
    best = std::min(best, found);
    bound = std::max(found + kCloser * (bound - found), 1e-12);
    if (bound - found < 1e-6) break;  // it gets no better
  }
  // Where the rate is just below 1, one more centre at 1 gives the certificate the most room.
  if (!(best < kSafe)) return {};
  const MatrixXd back = factor * centres.centre(p, 1.0) * factor.transpose();
  auto certificate = row_major(back / back.diagonal().maxCoeff());
  if (!is_common_lyapunov(block, certificate)) return {};
  return certificate;
}

std::vector<std::vector<double>> find_common_lyapunov(const SwitchedArxModel& model) {
  std::vector<std::vector<double>> all;
  for (const StateBlock& block : state_blocks(model)) {
    auto one = find_common_lyapunov(block);
    if (!one) return {};
    all.push_back(std::move(*one));
  }
  return all;
}

}  // namespace wisp
