#include "outline_noise.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numeric>

namespace wisp {
namespace {

using Matrix = Eigen::MatrixXd;

constexpr int kLongestResponse = 30000;  // samples: a radius of 0.999 has fallen to 1e-13 by then
constexpr double kResponseEnd = 1e-7;    // of the largest value: its square is 1e-14 of the variance

// Outputs that feed each other, and the impulse responses of their dynamics to their shocks.
struct Block {
  std::vector<int> outputs;
  std::vector<Matrix> response;
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

Matrix next_response(const ArxModel& model, const Block& block) {
  const auto size = static_cast<Eigen::Index>(block.outputs.size());
  const auto now = block.response.size();
  Matrix next = Matrix::Zero(size, size);
  for (Eigen::Index r = 0; r < size; ++r) {
    for (Eigen::Index c = 0; c < size; ++c) {
      const auto lags = model.a(block.outputs[r], block.outputs[c]);
      for (std::size_t lag = 0; lag < lags.size() && lag < now; ++lag) {
        next.row(r) -= lags[lag] * block.response[now - 1 - lag].row(c);
      }
    }
  }
  return next;
}

Block with_response(const ArxModel& model, std::vector<int> outputs) {
  Block block{std::move(outputs), {}};
  const auto size = static_cast<Eigen::Index>(block.outputs.size());
  block.response.push_back(Matrix::Identity(size, size));
  const int history = std::max(1, model.orders.history());
  double largest = 1;
  for (int quiet = 0; quiet < history && static_cast<int>(block.response.size()) < kLongestResponse;) {
    block.response.push_back(next_response(model, block));
    const double size_now = block.response.back().cwiseAbs().maxCoeff();
    largest = std::max(largest, size_now);
    quiet = size_now < kResponseEnd * largest ? quiet + 1 : 0;
  }
  return block;
}

std::vector<Block> blocks_of(const ArxModel& model) {
  std::vector<Block> blocks;
  for (auto& outputs : coupled_outputs(model)) blocks.push_back(with_response(model, std::move(outputs)));
  return blocks;
}

// The linear map from vec Q_ij to vec P_ij, rows first: Σ H_i ⊗ H_j.
Matrix pair_map(const Block& i, const Block& j) {
  const auto ni = static_cast<Eigen::Index>(i.outputs.size());
  const auto nj = static_cast<Eigen::Index>(j.outputs.size());
  Matrix map = Matrix::Zero(ni * nj, ni * nj);
  const std::size_t length = std::min(i.response.size(), j.response.size());
  for (std::size_t t = 0; t < length; ++t) {
    for (Eigen::Index a = 0; a < ni; ++a) {
      for (Eigen::Index c = 0; c < ni; ++c) map.block(a * nj, c * nj, nj, nj) += i.response[t](a, c) * j.response[t];
    }
  }
  return map;
}

Eigen::VectorXd stacked(const Covariance& whole, const Block& i, const Block& j) {
  Eigen::VectorXd out(static_cast<Eigen::Index>(i.outputs.size() * j.outputs.size()));
  Eigen::Index at = 0;
  for (int a : i.outputs) {
    for (int b : j.outputs) out[at++] = whole(a, b);
  }
  return out;
}

void put(const Eigen::VectorXd& values, const Block& i, const Block& j, Covariance& whole) {
  Eigen::Index at = 0;
  for (int a : i.outputs) {
    for (int b : j.outputs) whole(a, b) = whole(b, a) = values[at++];
  }
}

// Least squares with a little weight on size: where two points' dynamics have nothing in common no finite shocks make
// them move together, and then less is better than absurdly much.
Eigen::VectorXd solved(const Matrix& map, const Eigen::VectorXd& wanted) {
  const Matrix normal = map.transpose() * map;
  const double weight = 1e-4 * normal.trace() / static_cast<double>(normal.rows());
  const Matrix weighted = normal + weight * Matrix::Identity(normal.rows(), normal.cols());
  return weighted.ldlt().solve(map.transpose() * wanted);
}

// Maps of every block with itself: all that variances need.
std::vector<Matrix> own_maps(const std::vector<Block>& blocks) {
  std::vector<Matrix> maps;
  for (const Block& block : blocks) maps.push_back(pair_map(block, block));
  return maps;
}

}  // namespace

Covariance stationary_covariance(const ArxModel& model, const Covariance& shocks) {
  const std::vector<Block> blocks = blocks_of(model);
  Covariance out = Covariance::Zero(shocks.rows(), shocks.cols());
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    for (std::size_t j = i; j < blocks.size(); ++j) {
      put(pair_map(blocks[i], blocks[j]) * stacked(shocks, blocks[i], blocks[j]), blocks[i], blocks[j], out);
    }
  }
  return out;
}

Covariance shocks_for(const ArxModel& model, const Covariance& wanted) {
  const std::vector<Block> blocks = blocks_of(model);
  Covariance out = Covariance::Zero(wanted.rows(), wanted.cols());
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    for (std::size_t j = i; j < blocks.size(); ++j) {
      put(solved(pair_map(blocks[i], blocks[j]), stacked(wanted, blocks[i], blocks[j])), blocks[i], blocks[j], out);
    }
  }
  return out;
}

Eigen::MatrixXd shared_factor(const Covariance& shocks, int rank) {
  const Eigen::VectorXd scale = shocks.diagonal().cwiseAbs().cwiseSqrt();
  const Eigen::VectorXd inverse = scale.unaryExpr([](double s) { return s > 0 ? 1 / s : 0.0; });
  const Matrix correlation = inverse.asDiagonal() * shocks * inverse.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Matrix> solver(correlation);
  // Ascending eigenvalues: the last ones are the largest.
  const Eigen::Index most = std::min<Eigen::Index>(rank, shocks.rows());
  Matrix factor(shocks.rows(), most);
  for (Eigen::Index k = 0; k < most; ++k) {
    const Eigen::Index at = shocks.rows() - 1 - k;
    factor.col(k) = std::sqrt(std::max(0.0, solver.eigenvalues()[at])) * solver.eigenvectors().col(at);
  }
  return scale.asDiagonal() * factor;
}

bool scale_to_variance(const ArxModel& model, const Covariance& wanted, Eigen::MatrixXd& factor) {
  const std::vector<Block> blocks = blocks_of(model);
  const std::vector<Matrix> maps = own_maps(blocks);
  double worst = 0;
  for (int pass = 0; pass < 200; ++pass) {
    const Covariance shocks = factor * factor.transpose();
    worst = 0;
    for (std::size_t k = 0; k < blocks.size(); ++k) {
      const Eigen::VectorXd reached = maps[k] * stacked(shocks, blocks[k], blocks[k]);
      const auto size = static_cast<Eigen::Index>(blocks[k].outputs.size());
      for (Eigen::Index r = 0; r < size; ++r) {
        const int output = blocks[k].outputs[r];
        const double variance = reached[r * size + r];
        if (!(variance > 0)) continue;
        const double ratio = wanted(output, output) / variance;
        worst = std::max(worst, std::abs(ratio - 1));
        factor.row(output) *= std::sqrt(ratio);
      }
    }
    if (worst < 1e-6) break;
  }
  return worst < 0.01;
}

}  // namespace wisp
