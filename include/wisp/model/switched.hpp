#pragma once
// Switched ARX dynamics, as a value: several ARX modes that share orders and operating point, and what decides which of
// them acts.
//
//   yᵢ(t) = −Σ A_l(i,j) yⱼ(t−l) + Σ B_l(i,k) uₖ(t−nk−l) + cᵢ + eᵢ(t)     with A, B, c and the size of e those of mode
//   s(t)
//
// on deviations from the operating point. The mode is decided either by regions of the space of regressors, cut by
// affine functions of them (a piecewise affine system), or by a Markov chain that knows nothing of them.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "wisp/base/result.hpp"
#include "wisp/model/arx.hpp"

namespace wisp {

/// What decides which mode acts.
enum class Switching : std::uint8_t {
  kRegions,  ///< the mode whose affine function of the regressors is largest; of equal ones the first
  kMarkov,   ///< a Markov chain that takes one step with every sample
};

inline constexpr std::size_t kMaxArxModes = 64;
inline constexpr int kMaxLyapunovStates = 256;  ///< larger blocks of outputs carry no certificate

/// One mode. Shapes are those of ArxModel.
struct ArxMode {
  std::vector<std::vector<double>> theta;      ///< per output row
  std::vector<std::vector<double>> std_error;  ///< the same shape, or empty where unknown
  std::vector<double> constant;                ///< c, per output
  std::vector<double> shock;  ///< ny × ny, lower triangular, row-major: e = shock · w, w standard normal
};

/// A sample that the regions look at.
struct RegionSample {
  bool input = false;  ///< of an input, not of an output
  int channel = 0;
  int lag = 0;

  friend bool operator==(const RegionSample&, const RegionSample&) = default;
};

struct SwitchedArxModel {
  ArxOrders orders;                 ///< of every mode
  std::vector<double> output_mean;  ///< the operating point, per output
  std::vector<double> input_mean;   ///< per regressor input
  std::vector<ArxMode> modes;       ///< 1 … kMaxArxModes
  Switching switching = Switching::kRegions;

  /// For kRegions, else empty: per mode the constant and then a weight for each of region_samples(), which are taken as
  /// deviations from the operating point. modes × (1 + samples), row-major.
  std::vector<double> regions;

  std::vector<double> initial;      ///< for kMarkov, else empty: per mode, of an instance's first sample; sums to 1
  std::vector<double> transitions;  ///< for kMarkov, else empty: from × to, row-major; rows sum to 1

  /// Why switching cannot make it diverge. Not empty: per block of state_blocks() a matrix P, states × states,
  /// row-major, such that xᵀPx shrinks in every mode: a common quadratic Lyapunov function. Empty: none was found, and
  /// it is the range that outputs are clamped to that bounds it.
  std::vector<std::vector<double>> lyapunov;
};

/// The samples that the regions look at: of every channel the lags that any output row has, outputs first.
std::vector<RegionSample> region_samples(const ArxOrders& orders);

/// One mode as an ARX model of its own, its shocks as a mixing matrix.
///
/// Precondition: mode < model.modes.size().
ArxModel mode_model(const SwitchedArxModel& model, std::size_t mode);

/// A single mode: what an ARX model is among switched ones. Its noise has the covariance of the model's where its size
/// does not hang on the input.
SwitchedArxModel switched_of(const ArxModel& model);

/// Outputs that feed each other, in any mode, and the companion matrices of their A.
struct StateBlock {
  std::vector<int> outputs;                    ///< ascending
  int states = 0;                              ///< outputs × longest lag
  std::vector<std::vector<double>> companion;  ///< per mode states × states, row-major, as single precision sees A
};

/// Blocks in the order of their first output; those without feedback have no states and are left out.
std::vector<StateBlock> state_blocks(const SwitchedArxModel& model);

/// Whether xᵀPx is positive and shrinks under every one of the block's matrices.
///
/// Precondition: lyapunov.size() == states².
bool is_common_lyapunov(const StateBlock& block, std::span<const double> lyapunov);

/// Checks shapes, finiteness, that probabilities sum to 1 and, where there is a Lyapunov function, that it is one.
/// Errors say which of them and what was expected.
Result<void> check(const SwitchedArxModel& model);

}  // namespace wisp
