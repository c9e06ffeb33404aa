#pragma once
// Products of lagged channels over the candidates' windows of rows, and the fit of one candidate within a window.

#include <Eigen/Core>
#include <map>
#include <vector>

#include "learn/rows/arx_design.hpp"
#include "learn/rows/arx_rows.hpp"

namespace wisp {

/// Gram matrices of a layout, one per window: the rows of every episode from a first sample (`earliest` to `latest`)
/// on. Columns are 0 in rows before their lag: in windows that begin earlier, a column's products must not be used.
class SearchWindows {
 public:
  /// Preconditions: `signals` and `layout` outlive the windows; layout.history() <= latest; 0 <= earliest <= latest.
  SearchWindows(const Signals& signals, const LagLayout& layout, int earliest, int latest);

  std::size_t rows(int first_sample) const { return rows_[index(first_sample)]; }
  const Eigen::MatrixXd& gram(int first_sample) const { return gram_[index(first_sample)]; }

  /// Triangle of the same window, RᵀR = gram but for rounding. Computed on first use.
  const Eigen::MatrixXd& triangle(int first_sample);

 private:
  std::size_t index(int first_sample) const { return static_cast<std::size_t>(first_sample - earliest_); }
  Eigen::MatrixXd earlier_rows(int first_sample) const;

  const Signals& signals_;
  const LagLayout& layout_;
  int earliest_;
  int latest_;
  RowPlan plan_;
  std::vector<std::size_t> rows_;
  std::vector<Eigen::MatrixXd> gram_;
  std::map<int, Eigen::MatrixXd> triangle_;
};

struct CandidateFit {
  /// One column per output, one row per column of the layout: −θ at the regressors, 1 at the target. A row of data
  /// times this matrix is a row of residuals.
  Eigen::MatrixXd annihilator;
  Eigen::MatrixXd residual_gram;  ///< ny × ny: Σ r_i r_j over the window
  bool determined = true;
};

CandidateFit fit_candidate(SearchWindows& windows, int first_sample, const LagLayout& layout,
                           const std::vector<SharedRows>& rows);

/// Matrix T of columns `tail` after regression on columns `base`: |T v|² is the sum of squared residuals of tail·v.
Eigen::MatrixXd left_by(SearchWindows& windows, int first_sample, const std::vector<int>& base,
                        const std::vector<int>& tail);

/// Σ r_i r_j of a fit over a window of different data.
Eigen::MatrixXd residual_gram_over(SearchWindows& windows, int first_sample, const Eigen::MatrixXd& annihilator);

}  // namespace wisp
