#pragma once
// One candidate of a search, fitted within a window.

#include <Eigen/Core>
#include <vector>

#include "learn/arx/rows/arx_design.hpp"
#include "learn/arx/search/search_windows.hpp"

namespace wisp {

/// Rows of a candidate: their regressors and targets, as columns of the search's layout.
struct CandidateRows {
  std::vector<int> columns;
  std::vector<int> outputs;
};

struct CandidateFit {
  /// One column an output over all columns of the layout: −θ at the regressors, 1 at the target. A row of data times it
  /// is the residual.
  Eigen::MatrixXd annihilator;
  Eigen::MatrixXd residual_gram;  ///< ny × ny: Σ r_i r_j over the window
  bool determined = true;
};

/// Fits within the window that starts at `first_sample`.
CandidateFit fit_candidate(SearchWindows& windows, int first_sample, const LagLayout& layout,
                           const std::vector<CandidateRows>& rows);

/// Σ r_i r_j of a fit over a window of other data.
Eigen::MatrixXd residual_gram_over(SearchWindows& windows, int first_sample, const Eigen::MatrixXd& annihilator);

}  // namespace wisp
