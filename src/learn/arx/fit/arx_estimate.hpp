#pragma once
// Least squares for a whole design: which factorisation, and what comes out of it.
//
// The Gram matrix of lagged channels costs least by far (lag_gram.hpp). Its rounding errors enter the coefficients
// multiplied by the condition squared; one step of refinement with residuals from the data takes that back to what QR
// has, while the inverse (standard errors) keeps it. So the Gram matrix is used up to kMaxConditionForGram and
// Householder QR beyond, whichever the measured condition says.

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "learn/arx/fit/arx_solve.hpp"
#include "learn/arx/rows/arx_design.hpp"
#include "learn/arx/rows/arx_rows.hpp"

namespace wisp {

/// Nine digits in standard errors: condition² · 2.2e-16 = 1e-9.
inline constexpr double kMaxConditionForGram = 2e3;

/// Coefficients of every group of rows: regressors × rows, in scaled units, without A's sign.
using GroupThetas = std::vector<Eigen::MatrixXd>;

struct ArxEstimate {
  std::vector<SharedSolution> groups;  ///< as the design's, in scaled units
  std::vector<double> effective;       ///< per group: number of coefficients, or what a kernel leaves of it
  Eigen::MatrixXd residual_gram;       ///< ny × ny: Σ r_i r_j
  Eigen::VectorXd target_square;       ///< Σ (y − ȳ)² per output
  std::string method;                  ///< which factorisation and why

  Eigen::MatrixXd gram;  ///< of all columns of the layout; empty unless `joint` was requested

  /// Σ r_i r_j for other coefficients than the estimate's.
  std::function<Eigen::MatrixXd(const GroupThetas&)> residual_gram_at;

  GroupThetas thetas() const;
};

/// What to compute.
struct EstimateOptions {
  bool joint = false;                   ///< also the products that tie rows of different groups together
  ArxKernel kernel = ArxKernel::kNone;  ///< with one, every group has one output
  std::vector<int> kernel_outputs{};    ///< outputs that have the kernel; empty: all
};

/// From the data. The estimate keeps references to its arguments.
///
/// Precondition: plan.rows > 0.
ArxEstimate estimate_from_data(const Signals& signals, const RowPlan& plan, const ArxDesign& design,
                               const EstimateOptions& options);

/// From the triangle of all columns of the design's layout; `scale` per channel as in Signals.
ArxEstimate estimate_from_triangle(const Eigen::MatrixXd& triangle, const std::vector<double>& scale,
                                   const ArxDesign& design, const EstimateOptions& options);

}  // namespace wisp
