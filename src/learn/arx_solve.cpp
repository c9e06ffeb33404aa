#include "arx_solve.hpp"

#include <Eigen/Dense>
#include <cmath>

namespace wisp {
namespace {

// A column of norm 1 that keeps less than this after the columns before it are taken out is rounding error: data is
// known to 1e-16, and some digits are lost over the rows.
constexpr double kNothingLeft = 1e-12;

// A column enters the account of a dependent one where it carries more than this of its norm.
constexpr double kPartOfDependence = 1e-6;

DependentColumn describe(const Eigen::MatrixXd& factor, const std::vector<int>& kept, int column) {
  DependentColumn dependent{column, {}};
  const auto count = static_cast<Eigen::Index>(kept.size());
  const Eigen::VectorXd weights =
      factor.topLeftCorner(count, count).triangularView<Eigen::Upper>().solve(factor.col(column).head(count));
  for (Eigen::Index k = 0; k < count; ++k) {
    if (std::abs(weights[k]) > kPartOfDependence) dependent.of.push_back(kept[k]);
  }
  return dependent;
}

double condition_number(const Eigen::MatrixXd& matrix) {
  if (matrix.cols() == 0) return 1;
  const auto values = Eigen::JacobiSVD<Eigen::MatrixXd>(matrix).singularValues();
  return values[0] / values[values.size() - 1];
}

// Modified Gram–Schmidt order with Householder reflections: column after column, dependent ones passed over.
struct Reduction {
  Eigen::MatrixXd factor;  // rows: kept columns in order; all columns, then the target
  std::vector<int> kept;
  std::vector<DependentColumn> dependent;
};

Reduction reduce(Eigen::MatrixXd stacked) {
  Reduction out;
  const auto columns = static_cast<int>(stacked.cols()) - 1;
  Eigen::VectorXd work(stacked.cols());
  for (int j = 0; j < columns; ++j) {
    const auto row = static_cast<Eigen::Index>(out.kept.size());
    const Eigen::Index left = stacked.rows() - row;
    if (left == 0 || stacked.col(j).tail(left).norm() <= kNothingLeft) {
      out.dependent.push_back(describe(stacked, out.kept, j));
      continue;
    }
    double tau = 0;
    double beta = 0;
    Eigen::VectorXd essential(left - 1);
    stacked.col(j).tail(left).makeHouseholder(essential, tau, beta);
    stacked.bottomRightCorner(left, stacked.cols() - j).applyHouseholderOnTheLeft(essential, tau, work.data());
    stacked.col(j).tail(left - 1).setZero();
    out.kept.push_back(j);
  }
  out.factor = std::move(stacked);
  return out;
}

}  // namespace

RowSolution solve_row(const RowProblem& problem) {
  const auto d = static_cast<Eigen::Index>(problem.regressors.size());
  const Eigen::Index rows = problem.triangle.rows();
  Eigen::MatrixXd stacked = Eigen::MatrixXd::Zero(rows + (problem.ridge > 0 ? d : 0), d + 1);
  Eigen::VectorXd norm(d);
  for (Eigen::Index j = 0; j < d; ++j) {
    const auto column = problem.triangle.col(problem.regressors[j]);
    norm[j] = column.norm();
    if (norm[j] > 0) stacked.col(j).head(rows) = column / norm[j];
    if (problem.ridge > 0) stacked(rows + j, j) = std::sqrt(problem.ridge);
  }
  stacked.col(d).head(rows) = problem.triangle.col(problem.target);

  const Reduction reduction = reduce(std::move(stacked));
  const auto kept = static_cast<Eigen::Index>(reduction.kept.size());
  Eigen::MatrixXd factor(kept, kept);
  for (Eigen::Index k = 0; k < kept; ++k) factor.col(k) = reduction.factor.col(reduction.kept[k]).head(kept);
  const auto upper = factor.triangularView<Eigen::Upper>();
  const Eigen::VectorXd theta = upper.solve(reduction.factor.col(d).head(kept));
  const Eigen::MatrixXd inverse = upper.solve(Eigen::MatrixXd::Identity(kept, kept));
  const Eigen::MatrixXd covariance = inverse * inverse.transpose();

  RowSolution solution;
  solution.theta = Eigen::VectorXd::Zero(d);
  solution.inverse = Eigen::MatrixXd::Zero(d, d);
  for (Eigen::Index k = 0; k < kept; ++k) {
    const int j = reduction.kept[k];
    solution.theta[j] = theta[k] / norm[j];
    for (Eigen::Index l = 0; l < kept; ++l) {
      const int i = reduction.kept[l];
      solution.inverse(j, i) = covariance(k, l) / (norm[j] * norm[i]);
    }
  }
  solution.dependent = reduction.dependent;
  solution.scaled_condition = condition_number(factor);
  for (Eigen::Index k = 0; k < kept; ++k) factor.col(k) *= norm[reduction.kept[k]] * problem.unit[reduction.kept[k]];
  solution.condition = condition_number(factor);
  return solution;
}

}  // namespace wisp
