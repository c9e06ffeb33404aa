#pragma once
// Residual tests: whiteness, and independence of the inputs.
//
// Source: L. Ljung, System Identification (2nd ed.), section 16.6 (whiteness; independence of past inputs); G. Ljung
// and G. Box, Biometrika 65 (1978), for the whiteness statistic.

#include <cstddef>
#include <span>
#include <vector>

#include "learn/rows/arx_design.hpp"
#include "wisp/base/result.hpp"
#include "wisp/model/arx.hpp"
#include "wisp/record/recording.hpp"

namespace wisp {

struct ResidualTestOptions {
  int lags = 25;                 ///< largest lag of auto- and cross-correlations, 1 to 10000
  bool learned_from_it = false;  ///< the recordings are the training data: the fit has taken degrees of freedom
};

inline constexpr int kReportedLags = 20;

/// Whiteness test of one output's residual.
struct Whiteness {
  std::vector<double> correlation;  ///< r(1) … r(lags)
  double bound = 0;                 ///< 1.96/√n: 95 % of the correlations of a white residual lie within
  double statistic = 0;             ///< the Ljung–Box statistic Q
  double p = 1;                     ///< probability of a Q at least this large for a white residual
};

/// Test that one output's residual is independent of one input's past.
struct Independence {
  std::vector<double> correlation;  ///< between residual(t) and input(t − lag), lag −lags … lags: 2·lags + 1 values
  double bound = 0;                 ///< 95 % bound under independence, from the autocorrelation of both series
  double statistic = 0;             ///< test statistic over lags nk … nk + lags
  double p = 1;                     ///< probability of a statistic at least this large under independence
};

struct ResidualTests {
  std::size_t rows = 0;
  std::vector<Whiteness> whiteness;                     ///< per output
  std::vector<std::vector<Independence>> independence;  ///< [output][input]
};

/// Tests the residuals of a model on recordings. History never crosses a gap; correlations are summed over all
/// stretches. Errors: as signals_of_model(); lags out of range; fewer than four rows per lag.
Result<ResidualTests> test_residuals(const ArxModel& model, std::span<const Recording> recordings,
                                     const ChannelChoice& channels, const ResidualTestOptions& options = {});

}  // namespace wisp
