#pragma once
// What a fit of curves needs of the data: products of the pieces of every curve, lag by lag, with the outputs' own past
// taken out.

#include <Eigen/Core>
#include <vector>

#include "learn/arx/curve/curve_fit.hpp"
#include "learn/arx/rows/arx_rows.hpp"

namespace wisp {

/// One input lag of an output row: the regressor Σ rise_p · piece_p(u(t − lag)).
struct CurvedTap {
  int curve = 0;  ///< which input's
  int first = 0;  ///< column of its first piece
};

/// Products of one output row.
struct CurveRow {
  std::vector<CurvedTap> taps;
  Eigen::MatrixXd gram;    ///< pieces of all taps, then the target, what the outputs' past explains taken out
  double own_columns = 0;  ///< coefficients of that past
  double unit = 1;         ///< of the target: what one of gram's is in the output's unit
};

struct CurveGram {
  std::vector<std::vector<double>> knots;  ///< per curve
  std::vector<CurveRow> rows;
  std::size_t samples = 0;
};

/// Errors: as fit_input_curves().
Result<CurveGram> curve_gram(std::span<const Recording> recordings, const ChannelChoice& channels,
                             const CurveFitOptions& options);

}  // namespace wisp
