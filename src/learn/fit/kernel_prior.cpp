// Prior for the coefficients of a channel: over the lags they decay and are smooth. Marginal likelihood chooses the
// decay and the scale from the data.
//
// Source: T. Chen, H. Ohlsson, L. Ljung, Automatica 48 (2012), the TC kernel; G. Pillonetto et al., Automatica 50
// (2014), section 4.4 (empirical Bayes). With the kernel c·λ^max(i, j) the differences of neighbouring coefficients are
// independent (F. Carli, European Control Conference 2014), so that the prior's factor has two diagonals. Departure:
// the noise variance is maximised over in closed form instead of taken from another fit.

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

#include "learn/fit/arx_estimate.hpp"

namespace wisp::arx {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Step sizes of the search, in natural logarithms (factors from 7 down to 1.1): the likelihood is flat at its maximum.
constexpr double kFirstStep = 2;
constexpr double kLastStep = 0.1;

// Lower bound of a difference's variance, as a share of the first coefficient's variance: below it, digits are lost.
constexpr double kMinShare = 1e-10;

// Hyperparameters of a channel: ln(variance of the first coefficient / noise variance), and ln(λ/(1 − λ)).
struct Hyper {
  double log_scale;
  double log_odds;
};

// Standard deviations of the differences θ_j − θ_{j+1}; the last is that of θ_n itself.
void write_deviations(const KernelBlock& block, const Hyper& hyper, VectorXd& sd) {
  const double decay = 1 / (1 + std::exp(-hyper.log_odds));
  double power = 1;
  for (int j = 0; j < block.size; ++j) {
    const double share = j + 1 < block.size ? power * (1 - decay) : power;
    sd[block.first + j] = std::exp(0.5 * hyper.log_scale) * std::sqrt(std::max(share, kMinShare));
    power *= decay;
  }
}

// Gram matrix of the regression on the differences: θ_j is the sum of the differences from j on.
MatrixXd on_differences(const MatrixXd& gram, const std::vector<KernelBlock>& blocks) {
  MatrixXd out = gram;
  for (const KernelBlock& block : blocks) {
    for (int j = 1; j < block.size; ++j) out.col(block.first + j) += out.col(block.first + j - 1);
  }
  for (const KernelBlock& block : blocks) {
    for (int j = 1; j < block.size; ++j) out.row(block.first + j) += out.row(block.first + j - 1);
  }
  return out;
}

class MarginalLikelihood {
 public:
  MarginalLikelihood(const RegressionProducts& products, const std::vector<KernelBlock>& blocks)
      : products_(products), blocks_(blocks), gram_(on_differences(products.gram, blocks)), moment_(products.moment) {
    for (const KernelBlock& block : blocks) {
      for (int j = 1; j < block.size; ++j) moment_[block.first + j] += moment_[block.first + j - 1];
    }
    free_ = VectorXd::Ones(gram_.rows());
    for (const KernelBlock& block : blocks) free_.segment(block.first, block.size).setZero();
  }

  VectorXd deviations(const std::vector<Hyper>& hyper) const {
    VectorXd sd = VectorXd::Ones(gram_.rows());
    for (std::size_t k = 0; k < blocks_.size(); ++k) write_deviations(blocks_[k], hyper[k], sd);
    return sd;
  }

  /// −2 ln of the marginal likelihood up to a constant; columns outside all blocks have a flat prior.
  double operator()(const std::vector<Hyper>& hyper) const {
    const VectorXd sd = deviations(hyper);
    MatrixXd inner = sd.asDiagonal() * gram_ * sd.asDiagonal();
    inner.diagonal() += VectorXd::Ones(free_.size()) - free_;
    const Eigen::LLT<MatrixXd> factor(inner);
    if (factor.info() != Eigen::Success) return std::numeric_limits<double>::infinity();
    const VectorXd half = factor.matrixL().solve(sd.cwiseProduct(moment_));
    const double rest = products_.square - half.squaredNorm();
    if (!(rest > 0)) return std::numeric_limits<double>::infinity();
    const VectorXd diagonal = MatrixXd(factor.matrixL()).diagonal();
    return 2 * diagonal.array().log().sum() + products_.rows * std::log(rest / products_.rows);
  }

 private:
  const RegressionProducts& products_;
  const std::vector<KernelBlock>& blocks_;
  MatrixXd gram_;
  VectorXd moment_;
  VectorXd free_;
};

// Initial hyperparameters of the search: each channel's first coefficient contributes as much variance as the noise,
// and the response decays over about eight lags.
std::vector<Hyper> first_guess(const RegressionProducts& products, const std::vector<KernelBlock>& blocks) {
  std::vector<Hyper> guess;
  for (const KernelBlock& block : blocks) {
    const double energy = products.gram.diagonal().segment(block.first, block.size).mean();
    guess.push_back({std::log(std::max(products.rows / std::max(energy, 1e-300), 1e-300)), 2.0});
  }
  return guess;
}

}  // namespace

MatrixXd kernel_factor(const RegressionProducts& products, const std::vector<KernelBlock>& blocks) {
  const MarginalLikelihood likelihood(products, blocks);
  std::vector<Hyper> best = first_guess(products, blocks);
  double least = likelihood(best);
  for (double step = kFirstStep; step >= kLastStep; step /= 2) {
    bool moved = true;
    for (int round = 0; moved && round < 50; ++round) {
      moved = false;
      for (std::size_t k = 0; k < 2 * best.size(); ++k) {
        for (double sign : {1.0, -1.0}) {
          std::vector<Hyper> tried = best;
          (k % 2 == 0 ? tried[k / 2].log_scale : tried[k / 2].log_odds) += sign * step;
          const double value = likelihood(tried);
          if (!(value < least)) continue;
          least = value, best = std::move(tried), moved = true;
          break;
        }
      }
    }
  }
  MatrixXd factor = MatrixXd::Zero(products.gram.rows(), products.gram.cols());
  const VectorXd sd = likelihood.deviations(best);
  for (const KernelBlock& block : blocks) {
    for (int j = block.first; j < block.first + block.size; ++j) {
      factor(j, j) = 1 / sd[j];
      if (j + 1 < block.first + block.size) factor(j, j + 1) = -1 / sd[j];
    }
  }
  return factor;
}

}  // namespace wisp::arx
