#include "learn/arx/search/search_fit.hpp"

#include <Eigen/Dense>
#include <limits>
#include <optional>

#include "learn/arx/fit/arx_solve.hpp"

namespace wisp {
namespace {

// The residuals' products are a small difference of large ones; this share of a residual's square may be rounding.
constexpr double kMaxRounding = 1e-10;

// A pivot below this: the column is nearly a combination of those before it, and the triangle must decide.
constexpr double kMinPivot = 1e-9;

std::optional<Eigen::MatrixXd> products(const Eigen::MatrixXd& gram, const Eigen::MatrixXd& annihilator) {
  const Eigen::MatrixXd half = gram.selfadjointView<Eigen::Upper>() * annihilator;
  Eigen::MatrixXd out = annihilator.transpose() * half;
  const Eigen::RowVectorXd terms = gram.diagonal().cwiseMax(0).cwiseSqrt().transpose() * annihilator.cwiseAbs();
  for (Eigen::Index i = 0; i < out.rows(); ++i) {
    const double rounding = std::numeric_limits<double>::epsilon() * terms[i] * terms[i];
    if (!(rounding <= kMaxRounding * out(i, i))) return std::nullopt;
  }
  return out;
}

Eigen::MatrixXd products_by_triangle(const Eigen::MatrixXd& triangle, const Eigen::MatrixXd& annihilator) {
  const Eigen::MatrixXd residuals = triangle * annihilator;
  return residuals.transpose() * residuals;
}

bool solve_by_gram(const Eigen::MatrixXd& gram, const CandidateRows& rows, const LagLayout& layout,
                   Eigen::MatrixXd& annihilator) {
  const Eigen::MatrixXd part = gram(rows.columns, rows.columns);
  const Eigen::VectorXd weight = part.diagonal().cwiseSqrt().cwiseInverse();
  if (!weight.allFinite()) return false;
  const Eigen::LLT<Eigen::MatrixXd> cholesky(weight.asDiagonal() * part * weight.asDiagonal());
  if (cholesky.info() != Eigen::Success) return false;
  if (!rows.columns.empty() && cholesky.matrixLLT().diagonal().minCoeff() < std::sqrt(kMinPivot)) return false;
  for (int output : rows.outputs) {
    const Eigen::VectorXd moment = weight.cwiseProduct(gram.col(layout.target(output))(rows.columns));
    annihilator.col(output)(rows.columns) = -weight.cwiseProduct(cholesky.solve(moment));
  }
  return true;
}

bool solve_by_triangle(const Eigen::MatrixXd& triangle, const CandidateRows& rows, const LagLayout& layout,
                       Eigen::MatrixXd& annihilator) {
  SharedProblem problem{rows.columns, {}, Eigen::VectorXd::Ones(static_cast<Eigen::Index>(rows.columns.size())), 0};
  for (int output : rows.outputs) problem.targets.push_back(layout.target(output));
  const SharedSolution solution = solve_with_triangle(triangle, problem);
  for (std::size_t k = 0; k < rows.outputs.size(); ++k) {
    annihilator.col(rows.outputs[k])(rows.columns) = -solution.theta.col(static_cast<Eigen::Index>(k));
  }
  return solution.dependent.empty();
}

}  // namespace

CandidateFit fit_candidate(SearchWindows& windows, int first_sample, const LagLayout& layout,
                           const std::vector<CandidateRows>& rows) {
  CandidateFit fit;
  fit.annihilator = Eigen::MatrixXd::Zero(layout.size(), layout.outputs());
  for (int i = 0; i < layout.outputs(); ++i) fit.annihilator(layout.target(i), i) = 1;
  const Eigen::MatrixXd& gram = windows.gram(first_sample);
  bool by_gram = true;
  for (const CandidateRows& part : rows) by_gram = by_gram && solve_by_gram(gram, part, layout, fit.annihilator);
  if (by_gram) {
    if (auto square = products(gram, fit.annihilator)) {
      fit.residual_gram = std::move(*square);
      return fit;
    }
  }
  const Eigen::MatrixXd& triangle = windows.triangle(first_sample);
  for (const CandidateRows& part : rows) {
    fit.determined = solve_by_triangle(triangle, part, layout, fit.annihilator) && fit.determined;
  }
  fit.residual_gram = products_by_triangle(triangle, fit.annihilator);
  return fit;
}

Eigen::MatrixXd residual_gram_over(SearchWindows& windows, int first_sample, const Eigen::MatrixXd& annihilator) {
  if (auto square = products(windows.gram(first_sample), annihilator)) return *square;
  return products_by_triangle(windows.triangle(first_sample), annihilator);
}

}  // namespace wisp
