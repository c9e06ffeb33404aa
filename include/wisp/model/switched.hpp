#pragma once
// Markov-switched ARX dynamics, as a value: several ARX modes that share orders and operating point, and a Markov chain
// that decides which of them acts (J. D. Hamilton, Econometrica 57, 1989).
//
//   yᵢ(t) = −Σ A_l(i,j) yⱼ(t−l) + Σ B_l(i,k) uₖ(t−nk−l) + cᵢ + eᵢ(t)     with A, B, c and the covariance of e those of
//   mode s(t)
//
// on deviations from the operating point. The chain takes one step with every sample and does not depend on the
// samples.

#include <cstddef>
#include <vector>

#include "wisp/base/result.hpp"
#include "wisp/model/arx.hpp"

namespace wisp {

inline constexpr std::size_t kMaxArxModes = 64;
inline constexpr std::size_t kShockQuantiles = 17;

/// One mode. Shapes are those of ArxModel.
struct ArxMode {
  std::vector<std::vector<double>> theta;      ///< per output row
  std::vector<std::vector<double>> std_error;  ///< the same shape, or empty where unknown
  std::vector<double> constant;                ///< c, per output
  std::vector<double> shock;  ///< ny × ny, lower triangular, row-major: e = shock · w, w standard normal
};

struct SwitchedArxModel {
  ArxOrders orders;                 ///< of every mode
  std::vector<double> output_mean;  ///< the operating point, per output
  std::vector<double> input_mean;   ///< per regressor input
  std::vector<ArxMode> modes;       ///< 1 … kMaxArxModes
  std::vector<double> initial;      ///< per mode, probability of an instance's first sample; sums to 1
  std::vector<double> transitions;  ///< probabilities, from × to, row-major; rows sum to 1
  /// Of recorded shocks over their standard deviation, at probabilities 0, 1/16 … 1; or empty. Exported lamps draw from
  /// them, banks play normal shocks.
  std::vector<double> shock_quantiles{};
};

/// One mode as an ARX model of its own, its shocks as a mixing matrix.
///
/// Precondition: mode < model.modes.size().
ArxModel mode_model(const SwitchedArxModel& model, std::size_t mode);

/// Checks shapes, finiteness and that probabilities sum to 1. Errors say which of them and what was expected.
Result<void> check(const SwitchedArxModel& model);

}  // namespace wisp
