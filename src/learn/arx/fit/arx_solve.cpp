#include "learn/arx/fit/arx_solve.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/Householder>
#include <cmath>

#include "learn/numeric/decompositions.hpp"

namespace wisp {
namespace {

// A column of norm 1 of which less than this is left after the columns before it are taken out is rounding error: data
// is known to 1e-16, and some digits are lost over the rows.
constexpr double kNothingLeft = 1e-12;

// A column enters the account of a dependent one where it carries more than this of its norm.
constexpr double kPartOfDependence = 1e-6;

DependentColumn describe(const Eigen::MatrixXd& reduced, const std::vector<int>& kept, int column) {
  DependentColumn dependent{column, {}};
  const auto count = static_cast<Eigen::Index>(kept.size());
  Eigen::MatrixXd factor(count, count);
  for (Eigen::Index k = 0; k < count; ++k) factor.col(k) = reduced.col(kept[k]).head(count);
  if (reduced.col(column).head(count).norm() <= kNothingLeft) return dependent;
  const Eigen::VectorXd weights = factor.triangularView<Eigen::Upper>().solve(reduced.col(column).head(count));
  for (Eigen::Index k = 0; k < count; ++k) {
    if (std::abs(weights[k]) > kPartOfDependence) dependent.of.push_back(kept[k]);
  }
  return dependent;
}

// From the eigenvalues of the Gram matrix where these have eight digits, else from singular values, which cost more.
double condition_number(const Eigen::MatrixXd& matrix) {
  if (matrix.cols() == 0) return 1;
  const Eigen::MatrixXd gram = matrix.transpose() * matrix;
  const Eigen::VectorXd squares = symmetric_eigenvalues(gram);
  constexpr double kMaxSquare = 1e8;
  const double square = squares[squares.size() - 1] / squares[0];
  if (square > 0 && square < kMaxSquare) return std::sqrt(square);
  const Eigen::VectorXd values = singular_values(matrix);
  return values[0] / values[values.size() - 1];
}

// Fills in all that follows from the factor of the kept columns, scaled to norm 1.
SharedSolution finish(const SharedProblem& problem, const Eigen::MatrixXd& factor, const Eigen::MatrixXd& rotated,
                      const std::vector<int>& kept, const Eigen::VectorXd& norm) {
  const auto d = static_cast<Eigen::Index>(problem.columns.size());
  const auto count = static_cast<Eigen::Index>(kept.size());
  const auto upper = factor.triangularView<Eigen::Upper>();
  const Eigen::MatrixXd theta = upper.solve(rotated);
  const Eigen::MatrixXd root = upper.solve(Eigen::MatrixXd::Identity(count, count));
  const Eigen::MatrixXd inverse = root * root.transpose();
  SharedSolution solution;
  solution.theta = Eigen::MatrixXd::Zero(d, theta.cols());
  solution.inverse = Eigen::MatrixXd::Zero(d, d);
  Eigen::MatrixXd in_units = factor;
  for (Eigen::Index k = 0; k < count; ++k) {
    const int j = kept[k];
    solution.theta.row(j) = theta.row(k) / norm[j];
    in_units.col(k) *= norm[j] * problem.unit[j];
    for (Eigen::Index l = 0; l < count; ++l) solution.inverse(j, kept[l]) = inverse(k, l) / (norm[j] * norm[kept[l]]);
  }
  solution.scaled_condition = condition_number(factor);
  solution.condition = condition_number(in_units);
  return solution;
}

// Householder reflections column after column, so that a column is dependent only on those before it and can be named.
struct Reduction {
  Eigen::MatrixXd matrix;
  std::vector<int> kept;
  std::vector<DependentColumn> dependent;
};

Reduction reduce(Eigen::MatrixXd matrix, int regressors) {
  Reduction out;
  Eigen::VectorXd work(matrix.cols());
  for (int j = 0; j < regressors; ++j) {
    const auto row = static_cast<Eigen::Index>(out.kept.size());
    const Eigen::Index left = matrix.rows() - row;
    if (left == 0 || matrix.col(j).tail(left).norm() <= kNothingLeft) {
      out.dependent.push_back(describe(matrix, out.kept, j));
      continue;
    }
    double tau = 0;
    double beta = 0;
    Eigen::VectorXd essential(left - 1);
    matrix.col(j).tail(left).makeHouseholder(essential, tau, beta);
    matrix.bottomRightCorner(left, matrix.cols() - j).applyHouseholderOnTheLeft(essential, tau, work.data());
    matrix.col(j).tail(left - 1).setZero();
    out.kept.push_back(j);
  }
  out.matrix = std::move(matrix);
  return out;
}

}  // namespace

SharedSolution solve_with_triangle(const Eigen::MatrixXd& triangle, const SharedProblem& problem) {
  const auto d = static_cast<Eigen::Index>(problem.columns.size());
  const auto targets = static_cast<Eigen::Index>(problem.targets.size());
  const Eigen::Index rows = triangle.rows();
  const Eigen::Index prior = problem.prior.rows();
  Eigen::MatrixXd stacked = Eigen::MatrixXd::Zero(rows + prior, d + targets);
  Eigen::VectorXd norm(d);
  for (Eigen::Index j = 0; j < d; ++j) {
    const auto column = triangle.col(problem.columns[j]);
    norm[j] = column.norm();
    if (norm[j] > 0) stacked.col(j).head(rows) = column / norm[j];
    if (prior > 0 && norm[j] > 0) stacked.col(j).tail(prior) = problem.prior.col(j) / norm[j];
  }
  for (Eigen::Index i = 0; i < targets; ++i) stacked.col(d + i).head(rows) = triangle.col(problem.targets[i]);

  Reduction reduction = reduce(std::move(stacked), static_cast<int>(d));
  const auto count = static_cast<Eigen::Index>(reduction.kept.size());
  Eigen::MatrixXd factor(count, count);
  for (Eigen::Index k = 0; k < count; ++k) factor.col(k) = reduction.matrix.col(reduction.kept[k]).head(count);
  SharedSolution solution = finish(problem, factor, reduction.matrix.block(0, d, count, targets), reduction.kept, norm);
  solution.dependent = std::move(reduction.dependent);
  return solution;
}

std::optional<SharedSolution> solve_with_gram(const Eigen::MatrixXd& gram, const SharedProblem& problem,
                                              double max_condition) {
  const auto d = static_cast<Eigen::Index>(problem.columns.size());
  Eigen::VectorXd norm(d);
  std::vector<int> all(problem.columns.size());
  for (Eigen::Index j = 0; j < d; ++j) {
    norm[j] = std::sqrt(gram(problem.columns[j], problem.columns[j]));
    if (!(norm[j] > 0)) return std::nullopt;
    all[j] = static_cast<int>(j);
  }
  Eigen::MatrixXd scaled = gram(problem.columns, problem.columns);
  scaled = norm.cwiseInverse().asDiagonal() * scaled * norm.cwiseInverse().asDiagonal();
  if (problem.prior.size() > 0) {
    const Eigen::MatrixXd prior = problem.prior * norm.cwiseInverse().asDiagonal();
    scaled += prior.transpose() * prior;
  }
  const Eigen::LLT<Eigen::MatrixXd, Eigen::Upper> cholesky(scaled);
  if (cholesky.info() != Eigen::Success) return std::nullopt;
  const Eigen::MatrixXd factor = cholesky.matrixU();
  const Eigen::MatrixXd moments = norm.cwiseInverse().asDiagonal() * gram(problem.columns, problem.targets);
  SharedSolution solution = finish(problem, factor, cholesky.matrixL().solve(moments), all, norm);
  if (!(solution.scaled_condition <= max_condition)) return std::nullopt;
  return solution;
}

}  // namespace wisp
