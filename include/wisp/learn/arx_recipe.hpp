#pragma once
// Recipes for one ARX model, or several in alternation. Settings left open (std::nullopt) are chosen from the
// recordings, and the report states the choice.
//
// Orders and signs: docs/explanation/identification.md.

#include <cstdint>
#include <optional>
#include <string>
#include <tuple>
#include <variant>
#include <vector>

#include "wisp/learn/recipe_fields.hpp"
#include "wisp/model/arx.hpp"
#include "wisp/model/training.hpp"
#include "wisp/record/recording.hpp"

namespace wisp {

/// Choice of the operating point.
enum class ArxOffset {
  kMean,      ///< subtract from every channel its mean over all samples (MATLAB: detrend(z, 0))
  kNone,      ///< use the data unchanged
  kEstimate,  ///< like kMean, and estimate a constant term with the other coefficients
};

template <>
inline constexpr std::array<std::string_view, 3> kWordsOf<ArxOffset>{"mean", "none", "estimate"};

/// Outputs whose past appears in an output's regression; inputs appear in all regressions. A group is one output, or
/// the x and y of one control point.
enum class Coupling {
  kFull,      ///< all outputs
  kDiagonal,  ///< outputs of its own group
  kBand,      ///< outputs of its own group and of the groups before and after it
};

template <>
inline constexpr std::array<std::string_view, 3> kWordsOf<Coupling>{"full", "diagonal", "band"};

/// Objective of the estimation.
enum class ArxFocus {
  kPrediction,  ///< one-step prediction: least squares
  kSimulation,  ///< free simulation: least squares, or 15 or 30 lags under a kernel if better on held-out rows
  kAuto,        ///< least squares, unless 15 or 30 lags under a kernel simulate held-out rows significantly better
};

template <>
inline constexpr std::array<std::string_view, 3> kWordsOf<ArxFocus>{"prediction", "simulation", "auto"};

/// Prior on the coefficients.
enum class ArxKernel {
  kNone,
  kTc,  ///< tuned/correlated: coefficients decay over lags, neighbouring lags correlate; decay rate from the data
};

template <>
inline constexpr std::array<std::string_view, 2> kWordsOf<ArxKernel>{"none", "tc"};

/// Number of steps that stands for infinitely many: free simulation from the input alone.
inline constexpr int kFreeRun = 0;

/// Initial state of a free simulation.
enum class InitialState {
  kMeasured,   ///< the measured samples before the first simulated row
  kZero,       ///< the operating point: every output at its mean
  kEstimated,  ///< past outputs chosen by least squares so that the simulation fits best
};

template <>
inline constexpr std::array<std::string_view, 3> kWordsOf<InitialState>{"measured", "zero", "estimated"};

/// One order or delay for all pairs of channels, or a matrix: outputs × outputs for na, outputs × inputs for nb and nk.
/// Each number is 0 to 4096.
using OrderChoice = std::variant<int, OrderMatrix>;

/// Orders first … last, inclusive, 0 to 4096.
struct OrderRange {
  int first = 1;
  int last = 1;
};

/// Criterion by which an order search selects its candidate.
enum class OrderCriterion {
  kFpe,
  kAic,
  kAicc,
  kBic,
  kValidation,  ///< mean squared error on the validation recordings
};

template <>
inline constexpr std::array<std::string_view, 5> kWordsOf<OrderCriterion>{"fpe", "aic", "aicc", "bic", "validation"};

/// Grid of orders and delays from which a search selects. A candidate has equal orders for all pairs of channels.
struct ArxSearch {
  OrderRange na{1, 10};  ///< ten lags are the customary first choice; a candidate costs almost nothing
  OrderRange nb{1, 10};
  OrderRange nk{0, 3};
  OrderCriterion by = OrderCriterion::kFpe;
  int steps = 1;                        ///< prediction horizon for validation: 1 to 100000 steps, or kFreeRun
  std::vector<Recording> validation{};  ///< required by kValidation; with other criteria also evaluated
};

/// One ARX model: y(t) + A₁ y(t−1) + … = B₁ u(t−nk) + … + e(t). fields_of() below documents each field.
struct ArxRecipe {
  std::string name{};
  std::vector<std::string> inputs{};
  std::vector<std::string> outputs{};
  Preparation preparation{};
  OrderChoice na = 4;  ///< two damped resonances per output; the choice of Reissell and Pai (2001)
  OrderChoice nb = 4;
  std::optional<OrderChoice> nk = 1;
  std::optional<int> max_delay{};
  Coupling coupling = Coupling::kFull;
  ArxOffset offset = ArxOffset::kMean;  ///< a linear model describes deviations from an operating point
  ArxKernel kernel = ArxKernel::kNone;
  double radius = 0.999;
  bool keep_unstable = false;
  std::optional<ArxSearch> search{};
  ArxFocus focus = ArxFocus::kPrediction;  ///< ArxPart always uses kPrediction
  bool responses = false;
};

/// Several ARX modes of equal orders, each with its own constant, and a Markov chain that switches them. The operating
/// point is the mean of every channel.
struct SwitchedRecipe {
  std::string name{};
  std::vector<std::string> inputs{};
  std::vector<std::string> outputs{};
  OrderChoice na = 2;  ///< lower than a single model's: every mode has its own coefficients
  OrderChoice nb = 2;
  OrderChoice nk = 1;
  Coupling coupling = Coupling::kFull;
  std::optional<int> modes{};
  std::uint64_t seed = 1;
};

/// The light of a flame, for playback by a lamp: ARX modes from calm to restless, switched by a Markov chain. A
/// row's mode is its level of variation within half a second; shock strengths are calibrated by playing the model.
struct FlickerRecipe {
  std::string name{};
  std::string output{};
  double rate_hz = 50;
  int modes = 3;
  int order = 4;  ///< two damped resonances
  std::uint64_t seed = 1;
};

constexpr auto fields_of(const ArxRecipe&) {
  using R = ArxRecipe;
  return std::tuple(
      field("name", &R::name, "of the model"),
      field("inputs", &R::inputs, "channels that are inputs; none: a model of the outputs alone", {"inputs", "A,B"}),
      field("outputs", &R::outputs, "channels that are outputs", {"outputs", "C,D"}),
      field("preparation", &R::preparation, "of every recording, and of those that the model is judged on later"),
      field("na", &R::na, "order of A: lags of outputs; a number, or a matrix, outputs by outputs"),
      field("nb", &R::nb, "order of B: lags of inputs; a number, or a matrix, outputs by inputs"),
      field("nk", &R::nk, "delays in samples; none given: every input's delay to every output is found"),
      field("max_delay", &R::max_delay,
            "longest delay that is tried then, 0 to 4096; none given: as the data say, up to 640"),
      field("coupling", &R::coupling, "which outputs appear in an output's equation", {"coupling", "C"}),
      field("offset", &R::offset, "the operating point: mean removes means, none, estimate adds a constant term",
            {"offset", "O"}),
      field("kernel", &R::kernel,
            "a prior on the coefficients: tc, every channel's die down over its lags and neighbours are alike, as fast "
            "as the data say; with --na 0 --nb 60 --nk 0 a step response without a choice of orders",
            {"kernel", "K"}),
      field("radius", &R::radius,
            "poles of an unstable estimate are drawn in to this spectral radius, or farther where the rows learned "
            "from are simulated better so",
            {"radius", "R", 0.001, 0.999999}),
      field("keep_unstable", &R::keep_unstable, "leave an unstable estimate as it is, to compare; it cannot be played",
            {"keep-unstable"}),
      field("search", &R::search, "a grid of orders and delays in the place of na, nb and nk"),
      field("focus", &R::focus,
            "what the coefficients are best at: prediction, the next sample (least squares at the given orders); "
            "simulation, the better of that and 15 or 30 lags under a kernel in free runs of held-out rows; auto, the "
            "latter only where it is surely better",
            {"focus", "F"}),
      field(
          "responses", &R::responses,
          "report step and frequency responses with 95 % bands, which cost memory by the square of the coefficients"));
}

constexpr auto fields_of(const SwitchedRecipe&) {
  using R = SwitchedRecipe;
  return std::tuple(
      field("name", &R::name, "of the model"),
      field("inputs", &R::inputs, "channels that are inputs; none: a model of the outputs alone", {"inputs", "A,B"}),
      field("outputs", &R::outputs, "channels that are outputs", {"outputs", "C,D"}),
      field("na", &R::na, "order of A in every mode: lags of outputs"),
      field("nb", &R::nb, "order of B in every mode: lags of inputs"), field("nk", &R::nk, "delay in samples"),
      field("coupling", &R::coupling, "which outputs appear in an output's equation", {"coupling", "C"}),
      field("modes", &R::modes, "how many, or auto: as many, up to 6, as predict held-out rows surely better",
            {"modes", "K", 1, 64, "auto"}),
      field("seed", &R::seed, "of the starts that are tried", {"seed", "N"}));
}

constexpr auto fields_of(const FlickerRecipe&) {
  using R = FlickerRecipe;
  return std::tuple(
      field("name", &R::name, "of the model"),
      field("output", &R::output, "the channel of light; default: brightness, or the only output", {"channel", "NAME"}),
      field("rate_hz", &R::rate_hz,
            "what the model steps at; faster recordings are averaged down to the nearest whole part of their rate",
            {nullptr, "", 10, 1000}),
      field("modes", &R::modes, "degrees of restlessness", {"modes", "K", 2, 8}),
      field("order", &R::order, "lags in every mode", {nullptr, "", 1, 8}),
      field("seed", &R::seed, "of the play that shocks are matched by", {"seed", "N"}));
}

}  // namespace wisp
