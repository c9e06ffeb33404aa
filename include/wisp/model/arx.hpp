#pragma once
// ARX dynamics: autoregression with exogenous inputs, as a value.
//
//   y(t) + A₁ y(t−1) + … + A_na y(t−na) = B₁ u(t−nk) + … + B_nb u(t−nk−nb+1) + c + e(t)
//
// on deviations y − output_mean and u − input_mean. Signs and the meaning of na, nb, nk as in L. Ljung, System
// Identification (2nd ed.), section 4.2, and MATLAB's arx. Orders are matrices: every output row is its own regression
// with its own regressors, and zero orders cost nothing.

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

  /// Returns the number of coefficients of output row i.
  int row_size(int i) const;

  /// Returns the largest lag of any output or input: the samples of history that a step needs.
  int history() const;

  friend bool operator==(const ArxOrders&, const ArxOrders&) = default;
};

/// Recorded residuals, replayed instead of Gaussian shocks: stretches of rows without a gap, all outputs of a row
/// together, which preserves cross-correlation, autocorrelation and tails. An instance replays rows while its input
/// history resembles the recorded one, and otherwise jumps to a row with a nearer history. The distance of two
/// histories is the mean absolute difference over a few lags. A jump does not move the outputs discontinuously, since
/// the dynamics filter residuals. Without a driving input, an instance jumps every 0.4 to 1.2 s to a row with similar
/// outputs, preferring little-used rows (run/arx/lookup_lanes.hpp).
struct ResampledResiduals {
  std::vector<double> scale;        ///< per column of `rows`: value of a stored 1, in the output's unit, >= 0
  std::vector<std::int8_t> rows;    ///< rows × (outputs − across), row-major
  std::vector<std::uint32_t> ends;  ///< one past each stretch's last row, ascending; the last is the row count
  double wind_scale = 0;            ///< value of a stored 1 in `winds`, in the regressor's unit
  std::vector<std::int16_t> winds;  ///< input samples: per stretch, those before it (as many as the largest lag),
                                    ///< then one per row
  int toward = -1;                  ///< index of the regressor that is the driving input; -1: none
  std::vector<int> lags;    ///< up to kMaxResampledLags lags, ascending from 0, ≤ 4096 steps; empty: no driving input
  double tolerance = 0;     ///< excess over the nearest row's distance that causes a jump, in the regressor's unit
  double margin = 0;        ///< difference at one lag below which inputs count as equal, in the regressor's unit
  int longest = 1;          ///< with a driving input, longest run of rows between jumps, 1 to 1 000 000 steps
  std::vector<int> mirror;  ///< per column ±(1 + j): a row replayed for the negative of its recorded inputs has,
                            ///< in this column, ± its residual of column j; empty: no mirror symmetry
  int across = 0;  ///< for 3-D bodies: the last `across` outputs are the z components of horizontal vectors, the
                   ///< `across` before them the x components. A row stores one number per vector, its component along
                   ///< the wind; the component across comes from a second row. Regressor `toward + 3` is the wind's z

  bool empty() const { return rows.empty(); }
  std::size_t row_count() const { return ends.empty() ? 0 : ends.back(); }
};

/// Largest number of input lags that resampled residuals compare.
inline constexpr std::size_t kMaxResampledLags = 16;

/// Largest number of rows of resampled residuals.
inline constexpr std::size_t kMaxResampledRows = std::size_t{1} << 22;

/// Residual noise e(t) = diag(sd) w(t), w independent standard normal.
struct ResidualNoise {
  std::vector<double> sd;                      ///< standard deviation per output, in the output's unit
  std::vector<std::array<double, 2>> sd_ci95;  ///< 95 % interval of the residual's standard deviation, per output
  ResampledResiduals resampled;                ///< if not empty, e(t) is replayed from its rows, which sd describes
};

/// Coefficients of output row i are contiguous: for each output j its na(i,j) lags of A in the equation's own sign and
/// without the leading 1, then for each input k its nb(i,k) lags of B.
struct ArxModel {
  ArxOrders orders;
  std::vector<std::vector<double>> theta;      ///< coefficients per output row
  std::vector<std::vector<double>> std_error;  ///< standard errors in the shape of theta, or empty if unknown
  std::vector<double> constant;                ///< c, per output
  std::vector<double> output_mean;             ///< the operating point, per output
  std::vector<double> input_mean;              ///< per regressor input
  ResidualNoise noise;

  /// Returns the coefficients of lags 1 … na(i,j) of output j in row i.
  std::span<const double> a(int i, int j) const;
  /// Returns the coefficients of lags nk … nk+nb−1 of input k in row i.
  std::span<const double> b(int i, int k) const;
};

/// Checks shapes, orders and finiteness. Errors name the coefficient or matrix and what was expected.
Result<void> check(const ArxModel& model);

/// Returns blocks of output indices. Two outputs are in one block if the equation of either has lags of the other,
/// directly or through others. Different blocks simulate independently. Precondition: `na` is square.
std::vector<std::vector<int>> coupled_outputs(const OrderMatrix& na);

/// Returns the largest absolute eigenvalue of the companion matrix of A(q), with coefficients rounded to single
/// precision as `run/` uses them: below 1 the model is stable. Returns 0 for a model without feedback. Each
/// block of coupled_outputs() is solved separately.
double spectral_radius(const ArxModel& model);

}  // namespace wisp
