#include "learn/choose/search_fit.hpp"

#include <Eigen/Dense>
#include <limits>
#include <optional>

#include "learn/fit/arx_estimate.hpp"
#include "learn/rows/lag_gram.hpp"

namespace wisp {
namespace {

// Maximum relative rounding error of squared residuals from the Gram matrix; above it the triangle is used.
constexpr double kMaxRounding = 1e-10;

// Minimum pivot, as a share of a column's square: below it the column is nearly a combination of the columns before it,
// and the triangle is used instead of the Gram matrix.
constexpr double kMinPivot = 1e-9;
constexpr double kDependent = 1e-10;  // a column counts as dependent if others leave a smaller share of its norm

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

// Whether no column depends on the columns before it; `squares`: sums of squares of the columns.
bool well_determined(const Eigen::LLT<Eigen::MatrixXd>& cholesky, const Eigen::VectorXd& squares) {
  const Eigen::ArrayXd pivots = cholesky.matrixLLT().diagonal().array().square();
  return cholesky.info() == Eigen::Success && (pivots >= kMinPivot * squares.array()).all() && (pivots > 0).all();
}

bool solve_by_gram(const Eigen::MatrixXd& gram, const SharedRows& rows, const LagLayout& layout,
                   Eigen::MatrixXd& annihilator) {
  const Eigen::LLT<Eigen::MatrixXd> cholesky(gram(rows.columns, rows.columns));
  if (!well_determined(cholesky, gram.diagonal()(rows.columns))) return false;
  for (int output : rows.outputs) {
    annihilator.col(output)(rows.columns) = -cholesky.solve(gram.col(layout.target(output))(rows.columns));
  }
  return true;
}

bool solve_by_triangle(const Eigen::MatrixXd& triangle, const SharedRows& rows, const LagLayout& layout,
                       Eigen::MatrixXd& annihilator) {
  SharedProblem problem{rows.columns, {}, Eigen::VectorXd::Ones(static_cast<Eigen::Index>(rows.columns.size())), {}};
  for (int output : rows.outputs) problem.targets.push_back(layout.target(output));
  const SharedSolution solution = solve_with_triangle(triangle, problem);
  for (std::size_t k = 0; k < rows.outputs.size(); ++k) {
    annihilator.col(rows.outputs[k])(rows.columns) = -solution.theta.col(static_cast<Eigen::Index>(k));
  }
  return solution.dependent.empty();
}

}  // namespace

SearchWindows::SearchWindows(const Signals& signals, const LagLayout& layout, int earliest, int latest)
    : signals_(signals),
      layout_(layout),
      earliest_(earliest),
      latest_(latest),
      plan_(plan_rows(signals, layout, latest)),
      rows_(static_cast<std::size_t>(latest - earliest) + 1),
      gram_(rows_.size()) {
  const ChannelPairs all = ChannelPairs::Constant(layout.channels(), layout.channels(), true);
  rows_.back() = plan_.rows;
  gram_.back() = lag_gram(signals, plan_, layout, all);
  for (int first = latest - 1; first >= earliest; --first) {
    const Eigen::MatrixXd more = earlier_rows(first);
    rows_[index(first)] = rows_[index(first + 1)] + static_cast<std::size_t>(more.rows());
    gram_[index(first)] = gram_[index(first + 1)];
    gram_[index(first)].noalias() += more.transpose() * more;
  }
}

// Row `first_sample` of every episode that has it, unless samples in it are missing.
Eigen::MatrixXd SearchWindows::earlier_rows(int first_sample) const {
  const auto first = static_cast<std::size_t>(first_sample);
  Eigen::MatrixXd rows(0, layout_.size());
  Eigen::RowVectorXd row(layout_.size());
  for (std::size_t r = 0; r < signals_.samples.size(); ++r) {
    for (const Episode& episode : signals_.episodes[r]) {
      if (episode.size() <= first) continue;
      row[0] = 1;
      for (int p = 1; p < layout_.size(); ++p) {
        const auto [channel, lag] = layout_[p];
        const std::size_t t = episode.begin + first - static_cast<std::size_t>(lag);
        const bool there = lag <= first_sample;
        row[p] = there ? (signals_.samples[r][channel][t] - signals_.offset[channel]) * signals_.scale[channel] : 0.0;
      }
      if (row.hasNaN()) continue;
      rows.conservativeResize(rows.rows() + 1, Eigen::NoChange);
      rows.bottomRows(1) = row;
    }
  }
  return rows;
}

const Eigen::MatrixXd& SearchWindows::triangle(int first_sample) {
  const auto found = triangle_.find(first_sample);
  if (found != triangle_.end()) return found->second;
  if (first_sample == latest_) return triangle_[latest_] = triangle_by_qr(signals_, plan_, layout_);
  Eigen::MatrixXd later = triangle(first_sample + 1);
  reduce_rows(later, earlier_rows(first_sample));
  return triangle_[first_sample] = std::move(later);
}

CandidateFit fit_candidate(SearchWindows& windows, int first_sample, const LagLayout& layout,
                           const std::vector<SharedRows>& rows) {
  CandidateFit fit;
  fit.annihilator = Eigen::MatrixXd::Zero(layout.size(), layout.outputs());
  for (int i = 0; i < layout.outputs(); ++i) fit.annihilator(layout.target(i), i) = 1;
  const Eigen::MatrixXd& gram = windows.gram(first_sample);
  bool by_gram = true;
  for (const SharedRows& part : rows) by_gram = by_gram && solve_by_gram(gram, part, layout, fit.annihilator);
  if (auto square = by_gram ? products(gram, fit.annihilator) : std::nullopt) {
    fit.residual_gram = std::move(*square);
    return fit;
  }
  const Eigen::MatrixXd& triangle = windows.triangle(first_sample);
  for (const SharedRows& part : rows) {
    fit.determined = solve_by_triangle(triangle, part, layout, fit.annihilator) && fit.determined;
  }
  fit.residual_gram = products_by_triangle(triangle, fit.annihilator);
  return fit;
}

Eigen::MatrixXd left_by(SearchWindows& windows, int first_sample, const std::vector<int>& base,
                        const std::vector<int>& tail) {
  std::vector<int> both = base;
  both.insert(both.end(), tail.begin(), tail.end());
  const Eigen::MatrixXd part = windows.gram(first_sample)(both, both);
  const Eigen::LLT<Eigen::MatrixXd> cholesky(part);
  const Eigen::MatrixXd upper = cholesky.matrixU();
  if (well_determined(cholesky, part.diagonal())) return upper.bottomRightCorner(std::ssize(tail), std::ssize(tail));
  const Eigen::MatrixXd& triangle = windows.triangle(first_sample);
  if (base.empty()) return triangle(Eigen::all, tail);
  Eigen::MatrixXd columns = triangle(Eigen::all, base);
  columns.colwise().normalize();
  // A column that other columns determine would add a direction of rounding errors alone: the rank leaves it out.
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(columns);
  qr.setThreshold(kDependent);
  const Eigen::MatrixXd rotated = qr.householderQ().adjoint() * triangle(Eigen::all, tail);
  return rotated.bottomRows(rotated.rows() - qr.rank());
}

Eigen::MatrixXd residual_gram_over(SearchWindows& windows, int first_sample, const Eigen::MatrixXd& annihilator) {
  if (auto square = products(windows.gram(first_sample), annihilator)) return *square;
  return products_by_triangle(windows.triangle(first_sample), annihilator);
}

}  // namespace wisp
