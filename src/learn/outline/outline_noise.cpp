#include "learn/outline/outline_noise.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "learn/numeric/decompositions.hpp"

namespace wisp {
namespace {

using Matrix = Eigen::MatrixXd;

constexpr int kMaxDoublings = 40;
constexpr double kNothingLeft = 1e-14;  // of what the shocks put in
constexpr int kMaxPasses = 200;
constexpr double kCloseEnough = 1e-6;

// Outputs that feed each other, and the companion matrix of their dynamics.
struct Block {
  std::vector<int> outputs;
  Matrix companion;

  Eigen::Index size() const { return static_cast<Eigen::Index>(outputs.size()); }
};

std::vector<std::vector<int>> coupled_outputs(const ArxModel& model) {
  const int ny = model.orders.outputs();
  std::vector<int> label(ny);
  std::iota(label.begin(), label.end(), 0);
  for (bool changed = true; changed;) {
    changed = false;
    for (int i = 0; i < ny; ++i) {
      for (int j = 0; j < ny; ++j) {
        if (model.orders.na(i, j) == 0 || label[i] == label[j]) continue;
        label[i] = label[j] = std::min(label[i], label[j]);
        changed = true;
      }
    }
  }
  std::vector<std::vector<int>> blocks;
  for (int first = 0; first < ny; ++first) {
    std::vector<int> outputs;
    for (int i = 0; i < ny; ++i) {
      if (label[i] == first) outputs.push_back(i);
    }
    if (!outputs.empty()) blocks.push_back(std::move(outputs));
  }
  return blocks;
}

Matrix companion_of(const ArxModel& model, const std::vector<int>& outputs) {
  const auto size = static_cast<Eigen::Index>(outputs.size());
  Eigen::Index order = 1;
  for (int i : outputs) {
    for (int j : outputs) order = std::max<Eigen::Index>(order, model.orders.na(i, j));
  }
  Matrix out = Matrix::Zero(size * order, size * order);
  for (Eigen::Index r = 0; r < size; ++r) {
    for (Eigen::Index c = 0; c < size; ++c) {
      const auto lags = model.a(outputs[r], outputs[c]);
      for (std::size_t lag = 0; lag < lags.size(); ++lag) {
        out(r, static_cast<Eigen::Index>(lag) * size + c) = -lags[lag];
      }
    }
  }
  out.bottomLeftCorner(size * (order - 1), size * (order - 1)).setIdentity();
  return out;
}

std::vector<Block> blocks_of(const ArxModel& model) {
  std::vector<Block> blocks;
  for (auto& outputs : coupled_outputs(model)) {
    Matrix companion = companion_of(model, outputs);
    blocks.push_back({std::move(outputs), std::move(companion)});
  }
  return blocks;
}

// Σ F_i^t G F_jᵀ^t, G the shocks in the corner of the state, summed by doubling: X ← X + F X Fᵀ, F ← F².
Matrix pair_covariance(const Block& i, const Block& j, const Matrix& shocks) {
  Matrix f = i.companion;
  Matrix g = j.companion;
  Matrix sum = Matrix::Zero(f.rows(), g.rows());
  sum.topLeftCorner(i.size(), j.size()) = shocks;
  for (int doubling = 0; doubling < kMaxDoublings; ++doubling) {
    sum += f * sum * g.transpose();
    f = f * f;
    g = g * g;
    if (f.cwiseAbs().maxCoeff() * g.cwiseAbs().maxCoeff() < kNothingLeft) break;
  }
  return sum.topLeftCorner(i.size(), j.size());
}

// The linear map from vec Q_ij to vec P_ij, rows first.
Matrix pair_map(const Block& i, const Block& j) {
  Matrix map(i.size() * j.size(), i.size() * j.size());
  for (Eigen::Index c = 0; c < i.size(); ++c) {
    for (Eigen::Index d = 0; d < j.size(); ++d) {
      Matrix unit = Matrix::Zero(i.size(), j.size());
      unit(c, d) = 1;
      const Matrix answer = pair_covariance(i, j, unit);
      for (Eigen::Index a = 0; a < i.size(); ++a) {
        for (Eigen::Index b = 0; b < j.size(); ++b) map(a * j.size() + b, c * j.size() + d) = answer(a, b);
      }
    }
  }
  return map;
}

Matrix part_of(const Covariance& whole, const Block& i, const Block& j) {
  Matrix out(i.size(), j.size());
  for (Eigen::Index a = 0; a < i.size(); ++a) {
    for (Eigen::Index b = 0; b < j.size(); ++b) out(a, b) = whole(i.outputs[a], j.outputs[b]);
  }
  return out;
}

void put(const Matrix& part, const Block& i, const Block& j, Covariance& whole) {
  for (Eigen::Index a = 0; a < i.size(); ++a) {
    for (Eigen::Index b = 0; b < j.size(); ++b) {
      whole(i.outputs[a], j.outputs[b]) = whole(j.outputs[b], i.outputs[a]) = part(a, b);
    }
  }
}

// For every output of a block the matrix W whose product with the block's shocks, element by element and summed, is the
// output's stationary variance: the observability Gramian's corner, by doubling X ← X + Fᵀ X F, F ← F².
std::vector<Matrix> variance_weights(const Block& block) {
  const Eigen::Index state = block.companion.rows();
  std::vector<Matrix> sums(block.outputs.size(), Matrix::Zero(state, state));
  for (Eigen::Index r = 0; r < block.size(); ++r) sums[r](r, r) = 1;
  Matrix f = block.companion;
  for (int doubling = 0; doubling < kMaxDoublings; ++doubling) {
    for (Matrix& sum : sums) sum += f.transpose() * sum * f;
    f = f * f;
    const double left = f.cwiseAbs().maxCoeff();
    if (left * left < kNothingLeft) break;
  }
  for (Matrix& sum : sums) sum = sum.topLeftCorner(block.size(), block.size()).eval();
  return sums;
}

// Least squares with a little weight on size: where two points' dynamics have nothing in common no finite shocks make
// them move together, and then less is better than absurdly much.
Matrix solved(const Matrix& map, const Matrix& wanted) {
  const Matrix normal = map.transpose() * map;
  const double weight = 1e-4 * normal.trace() / static_cast<double>(normal.rows());
  const Matrix weighted = normal + weight * Matrix::Identity(normal.rows(), normal.cols());
  const Eigen::VectorXd stacked = wanted.transpose().reshaped();  // rows first
  const Eigen::VectorXd found = symmetric_solution(weighted, map.transpose() * stacked);
  return found.reshaped(wanted.cols(), wanted.rows()).transpose();
}

}  // namespace

Covariance stationary_covariance(const ArxModel& model, const Covariance& shocks) {
  const std::vector<Block> blocks = blocks_of(model);
  Covariance out = Covariance::Zero(shocks.rows(), shocks.cols());
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    for (std::size_t j = i; j < blocks.size(); ++j) {
      put(pair_covariance(blocks[i], blocks[j], part_of(shocks, blocks[i], blocks[j])), blocks[i], blocks[j], out);
    }
  }
  return out;
}

Covariance shocks_for(const ArxModel& model, const Covariance& wanted) {
  const std::vector<Block> blocks = blocks_of(model);
  Covariance out = Covariance::Zero(wanted.rows(), wanted.cols());
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    for (std::size_t j = i; j < blocks.size(); ++j) {
      const Matrix shocks = solved(pair_map(blocks[i], blocks[j]), part_of(wanted, blocks[i], blocks[j]));
      put(shocks, blocks[i], blocks[j], out);
    }
  }
  return out;
}

Eigen::MatrixXd shared_factor(const Covariance& shocks, int rank) {
  const Eigen::VectorXd scale = shocks.diagonal().cwiseAbs().cwiseSqrt();
  const Eigen::VectorXd inverse = scale.unaryExpr([](double s) { return s > 0 ? 1 / s : 0.0; });
  const Matrix correlation = inverse.asDiagonal() * shocks * inverse.asDiagonal();
  const auto [values, vectors] = symmetric_eigensystem(correlation);
  // Ascending eigenvalues: the last ones are the largest.
  const Eigen::Index most = std::min<Eigen::Index>(rank, shocks.rows());
  Matrix factor(shocks.rows(), most);
  for (Eigen::Index k = 0; k < most; ++k) {
    const Eigen::Index at = shocks.rows() - 1 - k;
    factor.col(k) = std::sqrt(std::max(0.0, values[at])) * vectors.col(at);
  }
  return scale.asDiagonal() * factor;
}

bool scale_to_variance(const ArxModel& model, const Covariance& wanted, Eigen::MatrixXd& factor) {
  double worst = 0;
  for (const Block& block : blocks_of(model)) {
    const std::vector<Matrix> weights = variance_weights(block);
    double off = 0;
    for (int pass = 0; pass < kMaxPasses; ++pass) {
      const Covariance shocks = factor * factor.transpose();
      const Matrix own = part_of(shocks, block, block);
      off = 0;
      for (Eigen::Index r = 0; r < block.size(); ++r) {
        const double variance = weights[r].cwiseProduct(own).sum();
        if (!(variance > 0)) continue;
        const int output = block.outputs[r];
        const double ratio = wanted(output, output) / variance;
        off = std::max(off, std::abs(ratio - 1));
        factor.row(output) *= std::sqrt(ratio);
      }
      if (off < kCloseEnough) break;
    }
    worst = std::max(worst, off);
  }
  return worst < 0.01;
}

}  // namespace wisp
