#pragma once
// How one ARX model, or several that take turns, is learned. What a recipe leaves open
// (std::nullopt) the recordings decide, and the report says what they decided.
//
// Orders and signs: docs/explanation/identification.md.

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "wisp/model/arx.hpp"
#include "wisp/model/training.hpp"
#include "wisp/record/recording.hpp"

namespace wisp {

/// How the operating point is found.
enum class ArxOffset {
  kMean,      ///< the mean of every channel over all of its samples is subtracted first (MATLAB: detrend(z, 0))
  kNone,      ///< data is taken as it is
  kEstimate,  ///< as kMean, and a constant term is estimated with the other coefficients
};

/// Which outputs appear in an output's regression. Inputs appear in every one.
enum class Coupling {
  kFull,      ///< all of them
  kDiagonal,  ///< those of its own group
  kBand,      ///< those of its own group and of its neighbours along the chain of groups
};

/// What coefficients are best at.
enum class ArxFocus {
  kPrediction,  ///< the next sample: least squares
  kSimulation,  ///< free simulation: least squares or 15 lags under a kernel, whichever simulates held-out rows better
  kAuto,        ///< least squares, or 15 lags under a kernel where that simulates held-out rows surely better
};

/// What is known of the coefficients before any data.
enum class ArxKernel {
  kNone,
  kTc,  ///< each channel's die down over its lags and neighbours are alike (tuned, correlated); how fast, the data say
};

/// In the place of a number of steps: infinitely many, from the input alone (free simulation).
inline constexpr int kFreeRun = 0;

/// Where a free simulation starts.
enum class InitialState {
  kMeasured,   ///< from the measured samples before the first simulated row
  kZero,       ///< from the operating point: every output was at its mean
  kEstimated,  ///< from the past outputs that make the simulation fit best, by least squares
};

/// One order or delay for all pairs of channels, or a matrix: outputs × outputs for na, outputs × inputs for nb and nk.
/// 0 to 4096.
using OrderChoice = std::variant<int, OrderMatrix>;

/// Orders first … last, both included, 0 to 4096.
struct OrderRange {
  int first = 1;
  int last = 1;
};

/// What the best candidate is best at.
enum class OrderCriterion {
  kFpe,
  kAic,
  kAicc,
  kBic,
  kValidation,  ///< mean squared error on the validation recordings
};

/// A grid of orders and delays, the same for all pairs of channels, of which the best is taken.
struct ArxSearch {
  OrderRange na{1, 10};  ///< ten lags are what identification people try first; a candidate costs next to nothing
  OrderRange nb{1, 10};
  OrderRange nk{0, 3};
  OrderCriterion by = OrderCriterion::kFpe;
  int steps = 1;                        ///< for validation: steps ahead, 1 to 100000, or kFreeRun
  std::vector<Recording> validation{};  ///< for kValidation, which needs them; others are judged on them too
};

/// One ARX model: y(t) + A₁ y(t−1) + … = B₁ u(t−nk) + … + e(t).
struct ArxRecipe {
  std::string name{};                  ///< of the model
  std::vector<std::string> inputs{};   ///< channels; none: a model of the outputs alone
  std::vector<std::string> outputs{};  ///< channels, at least one
  Preparation preparation{};           ///< of every recording, and of those that the model is judged on later
  OrderChoice na = 4;                  ///< lags of outputs; 4 is two damped resonances an output, the paper's choice
  OrderChoice nb = 4;                  ///< lags of inputs
  std::optional<OrderChoice> nk = 1;   ///< delays in samples; unset: every input's delay to every output is found
  std::optional<int> max_delay{};      ///< longest delay that is tried then, 0 to 4096; unset: as the data say, to 640
  Coupling coupling = Coupling::kFull;
  ArxOffset offset = ArxOffset::kMean;  ///< a linear model describes deviations from an operating point
  ArxKernel kernel = ArxKernel::kNone;  ///< kTc with na 0 and many lags of the inputs: a step response without orders
  double radius = 0.999;  ///< in (0, 1): an unstable estimate is brought within it; a smaller one may simulate better
  bool keep_unstable = false;              ///< leave an unstable estimate as it is, to compare: it cannot be played
  std::optional<ArxSearch> search{};       ///< in the place of na, nb and nk
  ArxFocus focus = ArxFocus::kPrediction;  ///< of parts and tables beyond memory always so
  bool responses = false;  ///< report step and frequency responses with 95 % bands, which cost d_total² memory
};

/// Several ARX modes of the same orders, each with a constant of its own, and a Markov chain that switches them. The
/// operating point is the mean of every channel.
struct SwitchedRecipe {
  std::string name{};
  std::vector<std::string> inputs{};
  std::vector<std::string> outputs{};
  OrderChoice na = 2;  ///< lower than a single model's: every mode has its own coefficients
  OrderChoice nb = 2;
  OrderChoice nk = 1;
  Coupling coupling = Coupling::kFull;
  std::optional<int> modes{};  ///< 1 to 64; unset: as many, up to 6, as predict held-out rows surely better
  std::uint64_t seed = 1;      ///< of the starts that are tried
};

/// The light of a flame, as a lamp can play it: ARX modes from calm to restless that a Markov chain switches. Modes are
/// stretches of about half a second that vary as much; how strong their shocks are is matched by playing.
struct FlickerRecipe {
  std::string name{};
  std::string output{};    ///< the channel; empty: "brightness", or the only output
  double rate_hz = 50;     ///< 10 to 1000: what the model steps at; faster recordings are averaged down to the nearest
                           ///< whole part of their rate
  int modes = 3;           ///< 2 to 8
  int order = 4;           ///< lags, 1 to 8: two damped resonances
  std::uint64_t seed = 1;  ///< of the play that shocks are matched by
};

}  // namespace wisp
