// Source: the constrained least-squares problem of S. Lacy and D. Bernstein, "Subspace identification with guaranteed
// stability using constrained optimization", IEEE Trans. Automatic Control 48 (2003), solved here for the coefficients
// of A. The boundary of the stable set has corners where poles meet, so the way there leads through the inside: a
// barrier of Lyapunov's equation, which is smooth (J. Nocedal and S. Wright, Numerical Optimization, chapters 6 and
// 19), lowered step by step; then, on the boundary, sequential quadratic programming (chapter 18) with the derivatives
// of simple poles. Every step is kept only if it is feasible and better; the poles scaled inwards are where it starts
// and what it can never be worse than.

#include "learn/arx/fit/arx_stability.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numeric>
#include <optional>

#include "learn/arx/rows/arx_orders.hpp"
#include "learn/numeric/decompositions.hpp"

namespace wisp {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Blocks of more poles are only scaled inwards: every step of the search costs their number cubed several times over.
constexpr Index kMaxExactSize = 100;

// One coefficient of A that may move: row and column within the block, and its lag.
struct Coefficient {
  int row;
  int column;
  int lag;
};

// Outputs that feed each other, and the quadratic loss of their coefficients.
class Block {
 public:
  Block(const ArxModel& model, const std::vector<RowCurvature>& curvature, std::vector<int> outputs)
      : outputs_(std::move(outputs)) {
    for (std::size_t r = 0; r < outputs_.size(); ++r) {
      for (std::size_t c = 0; c < outputs_.size(); ++c) {
        const auto a = model.a(outputs_[r], outputs_[c]);
        order_ = std::max(order_, static_cast<int>(a.size()));
        for (std::size_t l = 0; l < a.size(); ++l) {
          coefficients_.push_back({static_cast<int>(r), static_cast<int>(c), static_cast<int>(l) + 1});
          start_.conservativeResize(start_.size() + 1);
          start_[start_.size() - 1] = a[l];
        }
      }
    }
    const Index size = start_.size();
    give_ = MatrixXd::Zero(size, size);
    stiffness_ = MatrixXd::Zero(size, size);
    Index at = 0;
    for (int output : outputs_) {
      Index own = 0;
      for (int c = 0; c < model.orders.outputs(); ++c) own += model.orders.na(output, c);
      const MatrixXd inverse = curvature[output].inverse.topLeftCorner(own, own) / curvature[output].weight;
      give_.block(at, at, own, own) = inverse;
      stiffness_.block(at, at, own, own) = pseudo_inverse(inverse);
      at += own;
    }
  }

  /// Of the companion matrix: its poles.
  Index size() const { return static_cast<Index>(outputs_.size()) * order_; }

  const VectorXd& start() const { return start_; }
  const std::vector<int>& outputs() const { return outputs_; }

  double loss(const VectorXd& a) const { return (a - start_).dot(stiffness_ * (a - start_)); }

  double radius(const VectorXd& a) const {
    if (start_.size() == 0) return 0;
    return eigenvalues(companion(a)).cwiseAbs().maxCoeff();
  }

  VectorXd scaled(VectorXd a, double factor) const {
    for (Index k = 0; k < a.size(); ++k) a[k] *= std::pow(factor, coefficients_[k].lag);
    return a;
  }

  /// ln tr P with P = M P Mᵀ + 1 and M the companion matrix over `most`: finite inside, infinite on the boundary and
  /// beyond. Adds `weight` times its slope to `slope`.
  double barrier(const VectorXd& a, double most, double weight, VectorXd& slope) const {
    const MatrixXd m = companion(a) / most;
    const auto p = lyapunov(m);
    const auto q = lyapunov(m.transpose());
    if (!p || !q) return std::numeric_limits<double>::infinity();
    const MatrixXd push = *q * m * *p * (2 / most / p->trace());
    for (Index k = 0; k < a.size(); ++k) {
      slope[k] -= weight * push(coefficients_[k].row, place(coefficients_[k]));
    }
    return std::log(p->trace());
  }

  VectorXd loss_slope(const VectorXd& a) const { return 2 * (stiffness_ * (a - start_)); }
  const MatrixXd& give() const { return give_; }

  /// Poles scaled inwards as far as `most` asks.
  VectorXd feasible(const VectorXd& a, double most) const {
    const double now = radius(a);
    return now > most ? scaled(a, most / now * (1 - 1e-12)) : a;
  }

  /// The coefficients of least loss for which every pole, taken to move linearly from where it is at `a`, stays within
  /// `most`.
  VectorXd linearised_best(const VectorXd& a, double most) const {
    const auto [values, vectors, left] = eigensystem(companion(a));
    MatrixXd slope(0, a.size());
    VectorXd bound(0);
    for (Index p = 0; p < values.size(); ++p) {
      if (values[p].imag() < 0 || std::abs(values[p]) < 0.5 * most) continue;
      const Index row = slope.rows();
      slope.conservativeResize(row + 1, Eigen::NoChange);
      bound.conservativeResize(row + 1);
      for (Index k = 0; k < a.size(); ++k) {
        const Coefficient& c = coefficients_[k];
        const std::complex<double> moves = -left(p, c.row) * vectors(place(c), p);
        slope(row, k) = 2 * (std::conj(values[p]) * moves).real();
      }
      bound[row] = most * most - std::norm(values[p]) + slope.row(row).dot(a - start_);
    }
    return start_ + bounded_step(slope, bound);
  }

 private:
  // A coefficient's column of the companion matrix.
  Index place(const Coefficient& c) const { return (c.lag - 1) * static_cast<Index>(outputs_.size()) + c.column; }

  // P = M P Mᵀ + 1 by doubling, or nothing where the sum does not converge.
  static std::optional<MatrixXd> lyapunov(MatrixXd m) {
    MatrixXd p = MatrixXd::Identity(m.rows(), m.cols());
    for (int doubling = 0; doubling < 60; ++doubling) {
      p += (m * p * m.transpose()).eval();
      m = (m * m).eval();
      const double left = m.squaredNorm();
      if (!(left < 1e200)) return std::nullopt;
      if (left < 1e-32) return p;
    }
    return std::nullopt;
  }

  MatrixXd companion(const VectorXd& a) const {
    const auto ny = static_cast<Index>(outputs_.size());
    MatrixXd matrix = MatrixXd::Zero(ny * order_, ny * order_);
    for (Index k = 0; k < a.size(); ++k) {
      matrix(coefficients_[k].row, place(coefficients_[k])) = -a[k];
    }
    for (Index r = ny; r < matrix.rows(); ++r) matrix(r, r - ny) = 1;
    return matrix;
  }

  // min q' stiffness q with slope q <= bound, by Hildreth's method on the multipliers.
  VectorXd bounded_step(const MatrixXd& slope, const VectorXd& bound) const {
    const MatrixXd coupling = slope * give_ * slope.transpose();
    VectorXd multiplier = VectorXd::Zero(bound.size());
    for (int sweep = 0; sweep < 1000; ++sweep) {
      double change = 0;
      for (Index k = 0; k < bound.size(); ++k) {
        if (!(coupling(k, k) > 0)) continue;
        const double next =
            std::max(0.0, multiplier[k] - (coupling.row(k).dot(multiplier) + bound[k]) / coupling(k, k));
        change = std::max(change, std::abs(next - multiplier[k]) * std::sqrt(coupling(k, k)));
        multiplier[k] = next;
      }
      if (change <= 1e-14 * multiplier.cwiseAbs().maxCoeff()) break;
    }
    return -give_ * (slope.transpose() * multiplier);
  }

  std::vector<int> outputs_;
  std::vector<Coefficient> coefficients_;
  int order_ = 0;
  VectorXd start_;
  MatrixXd give_;       // inverse of stiffness
  MatrixXd stiffness_;  // of the loss
};

// Loss and barrier together.
struct Height {
  double value;
  VectorXd slope;
};

Height height(const Block& block, const VectorXd& a, double most, double weight) {
  Height at{block.loss(a), block.loss_slope(a)};
  at.value += weight * block.barrier(a, most, weight, at.slope);
  return at;
}

// Quasi-Newton steps (BFGS) down to where loss and barrier balance.
VectorXd settle(const Block& block, VectorXd a, double most, double weight) {
  constexpr int kMaxSteps = 40;
  MatrixXd inverse = 0.5 * block.give();
  Height at = height(block, a, most, weight);
  for (int step = 0; step < kMaxSteps && std::isfinite(at.value); ++step) {
    const VectorXd direction = -(inverse * at.slope);
    const double descent = at.slope.dot(direction);
    if (!(descent < -1e-10 * std::abs(at.value))) break;
    double share = 1;
    Height next = height(block, a + direction, most, weight);
    while (!(next.value <= at.value + 1e-4 * share * descent) && share > 1e-8) {
      share /= 2;
      next = height(block, a + share * direction, most, weight);
    }
    if (share <= 1e-8) break;
    const VectorXd moved = share * direction;
    const VectorXd turned = next.slope - at.slope;
    const double curvature = moved.dot(turned);
    if (curvature > 0) {
      const VectorXd image = inverse * turned;
      inverse += (1 + turned.dot(image) / curvature) / curvature * moved * moved.transpose() -
                 (image * moved.transpose() + moved * image.transpose()) / curvature;
    }
    a += moved;
    at = std::move(next);
  }
  return a;
}

// From the inside to near the boundary, while the barrier is lowered.
VectorXd through_the_inside(const Block& block, double most) {
  VectorXd a = block.feasible(block.start(), 0.98 * most);
  double weight = 0.1 * block.loss(a);
  for (int level = 0; level < 9; ++level, weight /= 5) a = settle(block, a, most, weight);
  return block.feasible(a, most);
}

// Feasible steps that lessen the loss, until there is none.
VectorXd descend(const Block& block, VectorXd a, double most) {
  constexpr double kWorthwhile = 1e-9;
  for (int iteration = 0; iteration < 50; ++iteration) {
    const VectorXd goal = block.linearised_best(a, most);
    const double loss = block.loss(a);
    bool better = false;
    for (double share = 1; share > 1e-3 && !better && goal.allFinite(); share /= 2) {
      const VectorXd next = block.feasible(a + share * (goal - a), most);
      better = block.loss(next) < loss * (1 - kWorthwhile);
      if (better) a = next;
    }
    if (!better) break;
  }
  return a;
}

// Writes A, and lets B and the constant follow to where they are best for it.
void write_block(const Block& block, const VectorXd& a, const std::vector<RowCurvature>& curvature, ArxModel& model) {
  Index at = 0;
  for (int output : block.outputs()) {
    Index own = 0;
    for (int c = 0; c < model.orders.outputs(); ++c) own += model.orders.na(output, c);
    const MatrixXd& inverse = curvature[output].inverse;
    const VectorXd moved = a.segment(at, own) - block.start().segment(at, own);
    const VectorXd push = shortest_solution(inverse.topLeftCorner(own, own), moved);
    const VectorXd follow = inverse.bottomLeftCorner(inverse.rows() - own, own) * push;
    std::vector<double>& theta = model.theta[output];
    for (Index k = 0; k < own; ++k) theta[k] = a[at + k];
    for (Index k = 0; k < follow.size(); ++k) {
      const auto place = static_cast<std::size_t>(own + k);
      (place < theta.size() ? theta[place] : model.constant[output]) += follow[k];
    }
    at += own;
  }
}

}  // namespace

double make_stable(ArxModel& model, const std::vector<RowCurvature>& curvature, double max_radius) {
  double loss = 0;
  for (std::vector<int>& outputs : arx::coupled_outputs(model.orders.na)) {
    const Block block(model, curvature, std::move(outputs));
    if (block.radius(block.start()) <= max_radius) continue;
    if (block.size() > kMaxExactSize) {
      const VectorXd scaled = block.feasible(block.start(), max_radius);
      loss += block.loss(scaled);
      write_block(block, scaled, curvature, model);
      continue;
    }
    const VectorXd from_scaled = descend(block, block.feasible(block.start(), max_radius), max_radius);
    const VectorXd from_inside = descend(block, through_the_inside(block, max_radius), max_radius);
    const VectorXd& best = block.loss(from_inside) < block.loss(from_scaled) ? from_inside : from_scaled;
    loss += block.loss(best);
    write_block(block, best, curvature, model);
  }
  return loss;
}

void scale_poles(ArxModel& model, double factor) {
  for (int i = 0; i < model.orders.outputs(); ++i) {
    std::size_t at = 0;
    for (int j = 0; j < model.orders.outputs(); ++j) {
      double power = factor;
      for (int lag = 0; lag < model.orders.na(i, j); ++lag, power *= factor) model.theta[i][at++] *= power;
    }
  }
}

}  // namespace wisp
