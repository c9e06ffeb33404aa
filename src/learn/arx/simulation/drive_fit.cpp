#include "learn/arx/simulation/drive_fit.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <complex>

namespace wisp::arx {
namespace {

using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXcd;
using Eigen::VectorXd;

constexpr Index kRows = 512;           // that are summed at a time
constexpr double kNegligible = 1e-30;  // an initial state that has died down to this share
constexpr double kDriveRidge = 1e-11;

// Products of one run's series over its rows: of every mode driven by every input, of every mode by itself, of the
// inputs themselves and 1.
struct RunSums {
  MatrixXcd products;
  MatrixXcd moments;  // with the outputs
};

RunSums sums_of(const BlockRun& run, Index history, const VectorXcd& modes, Index direct) {
  const Index n = modes.size(), inputs = run.inputs.cols(), driven = n * inputs, size = driven + n + direct;
  RunSums sums{MatrixXcd::Zero(size, size), MatrixXcd::Zero(size, run.outputs.cols())};
  VectorXcd state = VectorXcd::Zero(driven), own = VectorXcd::Ones(n);
  MatrixXcd series(size, kRows);
  MatrixXd outputs(kRows, run.outputs.cols());
  for (Index begin = 0; begin < run.rows; begin += kRows) {
    const Index rows = std::min(kRows, run.rows - begin);
    for (Index r = 0; r < rows; ++r) {
      const auto u = run.inputs.row(history + begin + r);
      const auto y = run.outputs.row(history + begin + r);
      if (y.hasNaN()) {
        series.col(r).setZero();
        outputs.row(r).setZero();
      } else {
        series.col(r) << state, own, VectorXcd::Ones(direct);
        series.col(r).segment(driven + n, inputs) = u.transpose();
        outputs.row(r) = y;
      }
      for (Index k = 0; k < inputs; ++k) {
        auto part = state.segment(k * n, n);
        part = (part.array() * modes.array() + u[k]).matrix();
      }
      own = own.cwiseProduct(modes);
      own = (own.cwiseAbs().array() < kNegligible).select(VectorXcd::Zero(n), own);
    }
    sums.products.selfadjointView<Eigen::Lower>().rankUpdate(series.leftCols(rows).conjugate());
    sums.moments += series.leftCols(rows).conjugate() * outputs.topRows(rows);
  }
  sums.products = MatrixXcd(sums.products.selfadjointView<Eigen::Lower>());
  return sums;
}

// The normal equations of one run: unknowns are what inputs do to modes, then each output's direct part; the initial
// state is eliminated.
class Normal {
 public:
  Normal(const MatrixXcd& shapes, const VectorXd& weight, Index inputs, Index direct)
      : shapes_(shapes), weight_(weight), inputs_(inputs), direct_(direct) {
    const Index size = modes() * inputs + shapes.rows() * direct;
    matrix_ = MatrixXcd::Zero(size, size);
    right_ = VectorXcd::Zero(size);
    between_ = shapes.adjoint() * weight.asDiagonal() * shapes;
  }

  void add(const RunSums& sums) {
    const Index n = modes(), driven = n * inputs_, size = matrix_.rows();
    const auto weighted = [&](Index modes_of) {  // an input's part, or the initial state's
      MatrixXcd rows(n, size);
      for (Index k = 0; k < inputs_; ++k) {
        rows.middleCols(k * n, n) = sums.products.block(modes_of, k * n, n, n).cwiseProduct(between_);
      }
      for (Index o = 0; o < shapes_.rows(); ++o) {
        rows.middleCols(driven + o * direct_, direct_) = (weight_[o] * shapes_.row(o).adjoint()).asDiagonal() *
                                                         sums.products.block(modes_of, driven + n, n, direct_);
      }
      return rows;
    };
    const auto moment = [&](Index modes_of) -> VectorXcd {
      return (shapes_.adjoint() * weight_.asDiagonal())
          .cwiseProduct(sums.moments.middleRows(modes_of, n))
          .rowwise()
          .sum();
    };
    for (Index k = 0; k < inputs_; ++k) {
      const MatrixXcd rows = weighted(k * n);
      matrix_.middleRows(k * n, n) += rows;
      matrix_.block(driven, k * n, size - driven, n) += rows.rightCols(size - driven).adjoint();
      right_.segment(k * n, n) += moment(k * n);
    }
    for (Index o = 0; o < shapes_.rows(); ++o) {
      const Index at = driven + o * direct_;
      matrix_.block(at, at, direct_, direct_) += weight_[o] * sums.products.bottomRightCorner(direct_, direct_);
      right_.segment(at, direct_) += weight_[o] * sums.moments.col(o).tail(direct_);
    }
    MatrixXcd own = sums.products.block(driven, driven, n, n).cwiseProduct(between_);
    own.diagonal().array() += kDriveRidge * own.diagonal().cwiseAbs().maxCoeff() + 1e-300;
    const Eigen::LDLT<MatrixXcd> solver(own);
    const MatrixXcd rows = weighted(driven);
    matrix_ -= rows.adjoint() * solver.solve(rows);
    right_ -= rows.adjoint() * solver.solve(moment(driven));
  }

  VectorXcd solution() {
    matrix_.diagonal() *= 1 + kDriveRidge;
    matrix_.diagonal().array() += 1e-300;
    return matrix_.ldlt().solve(right_);
  }

 private:
  Index modes() const { return shapes_.cols(); }

  const MatrixXcd& shapes_;
  const VectorXd& weight_;
  Index inputs_, direct_;
  MatrixXcd between_;
  MatrixXcd matrix_;
  VectorXcd right_;
};

}  // namespace

Drive fit_drive(const SimulationBlock& block, const VectorXcd& modes, const MatrixXcd& shapes, bool constant) {
  const Index inputs = block.inputs(), direct = inputs + (constant ? 1 : 0), n = modes.size();
  Normal normal(shapes, block.weight(), inputs, direct);
  for (const BlockRun& run : block.runs()) normal.add(sums_of(run, block.history(), modes, direct));
  const VectorXcd found = normal.solution();
  Drive drive{found.head(n * inputs).reshaped(n, inputs), MatrixXd(shapes.rows(), inputs),
              VectorXd::Zero(shapes.rows())};
  for (Index o = 0; o < shapes.rows(); ++o) {
    const VectorXd own = found.segment(n * inputs + o * direct, direct).real();
    drive.d.row(o) = own.head(inputs).transpose();
    if (constant) drive.level[o] = own[inputs];
  }
  return drive;
}

}  // namespace wisp::arx
