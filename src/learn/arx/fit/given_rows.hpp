#pragma once
// A fit whose coefficients come from elsewhere than least squares, with all figures that a fit has.

#include <Eigen/Core>
#include <vector>

#include "learn/arx/fit/arx_fit.hpp"
#include "learn/arx/rows/arx_rows.hpp"

namespace wisp {

/// One output row in scaled units, in the order of row_regressors() and without A's sign.
struct GivenRow {
  Eigen::VectorXd theta;
  Eigen::MatrixXd covariance;
  double effective = 0;  ///< coefficients that the data determined; 0: as many as least squares does
};

/// The row of a model, as it is in the signals' scaled units; without a covariance.
GivenRow row_of_model(const ArxModel& model, int output, const Signals& signals, ArxOffset offset);

/// As fit_arx(), with every output row as given: loss, noise, criteria and fits are of its residuals, standard errors
/// of its covariance where it has one and else those of `plain`.
/// Errors: as fit_arx().
Result<ArxFit> fit_with_rows(std::span<const Recording> recordings, const ChannelChoice& channels,
                             const ArxOptions& options, const std::vector<GivenRow>& rows, const ArxFit& plain);

}  // namespace wisp
