#pragma once
// Markov-switched ARX dynamics, as a value: several ARX modes with common orders and operating point, and a Markov
// chain that selects the active one (J. D. Hamilton, Econometrica 57, 1989).
//
//   yᵢ(t) = −Σ A_l(i,j) yⱼ(t−l) + Σ B_l(i,k) uₖ(t−nk−l) + cᵢ + eᵢ(t)     with A, B, c and the covariance of e those of
//   mode s(t)
//
// on deviations from the operating point. The chain takes one step per sample, independently of inputs and outputs.

#include <cstddef>
#include <vector>

#include "wisp/base/result.hpp"
#include "wisp/model/arx.hpp"

namespace wisp {

inline constexpr std::size_t kMaxArxModes = 64;
inline constexpr std::size_t kShockQuantiles = 17;

/// One mode. Shapes are those of ArxModel.
struct ArxMode {
  std::vector<std::vector<double>> theta;      ///< coefficients per output row
  std::vector<std::vector<double>> std_error;  ///< standard errors in the shape of theta, or empty if unknown
  std::vector<double> constant;                ///< c, per output
  std::vector<double> shock;  ///< ny × ny, lower triangular, row-major: e = shock · w, w standard normal
};

struct SwitchedArxModel {
  ArxOrders orders;                 ///< orders of every mode
  std::vector<double> output_mean;  ///< the operating point, per output
  std::vector<double> input_mean;   ///< per regressor input
  std::vector<ArxMode> modes;       ///< 1 … kMaxArxModes
  std::vector<double> initial;      ///< per mode, probability that it makes an instance's first sample; sums to 1
  std::vector<double> transitions;  ///< probabilities, from × to, row-major; rows sum to 1
  /// Quantiles of recorded shocks over their standard deviation, at probabilities 0, 1/16 … 1; or empty. Only exported
  /// firmware draws from them; banks draw normal shocks.
  std::vector<double> shock_quantiles{};
};

/// Returns one mode as an ARX model of its own, without the correlation of its outputs' shocks.
/// Precondition: mode < model.modes.size().
ArxModel mode_model(const SwitchedArxModel& model, std::size_t mode);

/// Checks shapes, finiteness and sums of probabilities. Errors name the field and what was expected.
Result<void> check(const SwitchedArxModel& model);

}  // namespace wisp
