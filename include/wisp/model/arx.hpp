#pragma once
// ARX dynamics: autoregression with exogenous inputs, as a value.
//
//   y(t) + A₁ y(t−1) + … + A_na y(t−na) = B₁ u(t−nk) + … + B_nb u(t−nk−nb+1) + c + e(t)
//
// on deviations y − output_mean and u − input_mean. Signs and the meaning of na, nb, nk as in L. Ljung, System
// Identification (2nd ed.), section 4.2, and MATLAB's arx. Orders are matrices: every output row is its own regression
// with its own regressors, and what is zero costs nothing.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "wisp/base/result.hpp"

namespace wisp {

/// A small dense matrix of non-negative integers, row-major.
class OrderMatrix {
 public:
  OrderMatrix() = default;
  OrderMatrix(int rows, int columns, int value = 0)
      : rows_(rows), columns_(columns), values_(static_cast<std::size_t>(rows) * columns, value) {}

  int rows() const { return rows_; }
  int columns() const { return columns_; }
  int& operator()(int row, int column) { return values_[static_cast<std::size_t>(row) * columns_ + column]; }
  int operator()(int row, int column) const { return values_[static_cast<std::size_t>(row) * columns_ + column]; }
  std::span<const int> values() const { return values_; }

  friend bool operator==(const OrderMatrix&, const OrderMatrix&) = default;

 private:
  int rows_ = 0;
  int columns_ = 0;
  std::vector<int> values_;
};

/// The orders of an ARX model: na is ny × ny, nb and nk are ny × nu.
struct ArxOrders {
  OrderMatrix na;
  OrderMatrix nb;
  OrderMatrix nk;

  int outputs() const { return na.rows(); }
  int inputs() const { return nb.columns(); }

  /// Coefficients of output row i.
  int row_size(int i) const;

  /// Largest lag of any output or input: the samples of history that a step needs.
  int history() const;

  friend bool operator==(const ArxOrders&, const ArxOrders&) = default;
};

/// Residuals as they were, to be played again instead of Gaussian shocks: rows in the order of time, all outputs of a
/// row together, so that what they share, their memory and their tails stay. An instance plays row after row while its
/// input has been what it was then, and jumps to a row whose past is nearer when it has not. How far two pasts are
/// apart is the mean over a few lags of the differences' sizes. A jump moves no output: the dynamics lie between.
/// Rows that no input drives are followed for 0.4 to 1.2 s, then from where the outputs were alike, and rather from
/// where little has been played (run/arx/lookup_lanes.hpp).
struct ResampledResiduals {
  std::vector<double> scale;        ///< per output: a stored 1, in the output's unit, >= 0
  std::vector<std::int8_t> rows;    ///< rows × outputs, row-major
  std::vector<std::uint32_t> ends;  ///< one past the last row of every stretch, ascending; the last is the row count
  double wind_scale = 0;            ///< a stored 1 of `winds`, in the regressor's unit
  std::vector<std::int16_t> winds;  ///< the input: of every stretch as many samples before it as the last lag says,
                                    ///< then one a row
  int toward = -1;                  ///< the regressor that the input is; -1: none
  std::vector<int> lags;  ///< 1 to kMaxResampledLags lags, steps, ascending from 0; empty where nothing drives it
  double tolerance = 0;   ///< by which a row may be farther than the nearest one before a jump, in the regressor's unit
  double margin = 0;      ///< pasts that differ by less count as alike, in the regressor's unit
  int longest = 1;        ///< where an input drives it, steps from one jump to the next at most, 1 to 1 000 000
  std::vector<int> mirror;  ///< per output ±(1 + the output whose residual it takes in an input from the other side);
                            ///< empty: that side is no mirror image
  int across = 0;  ///< in the round: the last `across` outputs are the z parts of level vectors, the `across` before
                   ///< them the x parts. A row stores one number a vector, its part along the wind; the part across
                   ///< is taken from a second row. Regressor `toward + 3` is then the wind's z

  bool empty() const { return rows.empty(); }
  std::size_t row_count() const { return ends.empty() ? 0 : ends.back(); }
};

/// Most lags of the input's past that resampled residuals look at.
inline constexpr std::size_t kMaxResampledLags = 16;

/// Most rows that residuals are drawn from.
inline constexpr std::size_t kMaxResampledRows = std::size_t{1} << 22;

/// Residual noise e(t) = diag(sd) w(t) + mixing v(t), w and v independent standard normal.
struct ResidualNoise {
  std::vector<double> sd;                      ///< per output, in the output's unit
  std::vector<std::array<double, 2>> sd_ci95;  ///< 95 % interval of the residual's standard deviation, per output
  int rank = 0;                                ///< columns of `mixing`: shocks that outputs share
  std::vector<double> mixing;                  ///< ny × rank, row-major
  ResampledResiduals resampled;                ///< where it has rows they are e(t), and the rest only tells their size
};

/// Coefficients of output row i lie together: for each output j its na(i,j) lags of A in the equation's own sign and
/// without the leading 1, then for each input k its nb(i,k) lags of B.
struct ArxModel {
  ArxOrders orders;
  std::vector<std::vector<double>> theta;      ///< per output row
  std::vector<std::vector<double>> std_error;  ///< the same shape, or empty where unknown
  std::vector<double> constant;                ///< c, per output
  std::vector<double> output_mean;             ///< the operating point, per output
  std::vector<double> input_mean;              ///< per regressor input
  ResidualNoise noise;

  /// Lags 1 … na(i,j) of output j in row i.
  std::span<const double> a(int i, int j) const;
  /// Lags nk … nk+nb−1 of input k in row i.
  std::span<const double> b(int i, int k) const;
};

/// Checks shapes, orders and finiteness. Errors say which coefficient or matrix and what was expected.
Result<void> check(const ArxModel& model);

/// Outputs whose equations feed each other, directly or through others, as blocks of output indices. Different blocks
/// simulate independently.
///
/// Precondition: `na` is square.
std::vector<std::vector<int>> coupled_outputs(const OrderMatrix& na);

/// Largest absolute eigenvalue of the companion matrix of A(q), with coefficients rounded to single precision as
/// `run/` uses them: below 1 the model is stable. 0 for a model without feedback. Independent blocks of outputs are
/// found and solved apart.
double spectral_radius(const ArxModel& model);

}  // namespace wisp
