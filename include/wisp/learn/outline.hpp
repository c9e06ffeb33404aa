#pragma once
// Learning an outline: from recordings of its control points to a model that moves like it.
//
// Source: L.-M. Reissell and D. K. Pai (2001), section 3.4: every control point its own ARX system of two outputs,
// order 4, driven by the wind, its residual fed back as Gaussian noise. Beyond it: wind from both sides, inputs or
// none, shocks that the control points share (docs/fidelity.md says why), a part held out for judging.

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "wisp/base/result.hpp"
#include "wisp/learn/arx_fit.hpp"
#include "wisp/learn/curve_choice.hpp"
#include "wisp/learn/outline_alignment.hpp"
#include "wisp/learn/outline_figures.hpp"
#include "wisp/learn/outline_inputs.hpp"
#include "wisp/model/model.hpp"
#include "wisp/record/recording.hpp"
#include "wisp/run/cost.hpp"

namespace wisp {

/// Which control points feed each other.
enum class OutlineCoupling {
  kCoordinate,  ///< none: every coordinate its own system
  kPoint,       ///< every point its own system, as in the paper
  kBand,        ///< every point hears its neighbours too
  kFull,        ///< every point hears all others but the last, which mirrors the first about the base
};

/// What shakes the outline.
enum class OutlineNoise {
  kIndependent,  ///< every channel by itself, with its residual's standard deviation: the paper's
  kResidual,     ///< shared shocks with the residuals' covariance
  kMatched,      ///< shared shocks under which the whole outline at rest has the recording's covariance; where points
                 ///< feed each other, as kResidual: the coupling itself holds the shape
  kDrawn,        ///< the residuals themselves, played again where the input is as it was then (docs/fidelity.md)
};

/// How to learn.
struct OutlineOptions {
  std::optional<int> order = 0;  ///< lags of outputs and of inputs, 1 to 64; unset: searched, up to 32; 0: 3 where
                                 ///< residuals are drawn, which hold the rest, and else 4, the paper's, two damped
                                 ///< resonances a coordinate
  std::optional<int> delay = 0;  ///< frames until an input acts, 0 to 1000; 0: in the same frame, the paper's; unset:
                                 ///< searched, up to a quarter of a second
  bool align = true;             ///< move inputs that come after the motion that they cause (outline_alignment.hpp)
  std::optional<OutlineCoupling> coupling;  ///< unset: kCoordinate where residuals are drawn, else kPoint; more costs
                                            ///< more and did not look better (docs/fidelity.md)
  std::optional<std::vector<std::string>> inputs;  ///< names; unset: all inputs of the recordings; empty: none, flicker
  std::optional<int> input_curve = 0;  ///< knots of a monotone curve that bends every input, 3 to 16; 0: none; unset: 3
                                       ///< to 6 or none, as held-out data say
  bool one_sided = false;      ///< inputs as they are, no sign and no mirror image: the paper's 192 multiply-adds
  std::optional<bool> mirror;  ///< learn from the mirror image too; unset: where inputs have signs
  double holdout = 0.3;        ///< 0 to 0.9: the last part of each recording, kept for judging
  bool refit = true;           ///< after judging, learn the model that is returned from everything
  std::optional<OutlineNoise> noise;     ///< unset: kDrawn where an input drives the outline and there are 10 s of it,
                                         ///< else kMatched: what is short would be seen to repeat
  std::size_t drawn_bytes = 256 * 1024;  ///< most that drawn residuals take, two a channel and frame
  int shared_shocks = 4;                 ///< 1 to 64: normal numbers a frame; more changed no figure (docs/fidelity.md)
  bool match_variance = true;            ///< scale the noise until every channel at rest has the recording's variance
  double pixels_per_unit = 0;            ///< 0: each recording's own mean calm height is 1
  std::uint64_t seed = 1;                ///< of the trial runs
  std::string name = "outline";          ///< of the model
};

/// One channel's residual noise, one step ahead, in the model's units.
struct OutlineResidual {
  double sd = 0;
  std::array<double, 2> sd_ci95{};  ///< χ² interval
};

/// What orders and delays are compared by.
enum class OutlineCriterion {
  kGiven,           ///< nothing was compared
  kFpe,             ///< Akaike's final prediction error: where too little is held out
  kHeldOutStep,     ///< the error one step ahead on what is held out: where no input drives the outline
  kHeldOutFreeRun,  ///< the error of free simulation on what is held out
};

/// An order and a delay that were compared.
struct OutlineCandidate {
  int order = 0;
  int delay = 0;
  double fpe = 0;
  double error = 0;  ///< by the criterion: root mean square in the model's units, geometric mean over channels
};

/// Which order and delay, and why.
struct OutlineChoice {
  OutlineCriterion by = OutlineCriterion::kGiven;
  std::vector<OutlineCandidate> candidates;
  std::size_t chosen = 0;  ///< of the candidates: the lowest order within 2 % of the best's error, at its best delay
  std::string reason;

  const OutlineCandidate& taken() const { return candidates[chosen]; }
};

/// How good the model is.
struct OutlineSummary {
  double rate_hz = 0;
  std::vector<OutlineInput> inputs;
  std::size_t points = 0;
  ArxOrders orders;
  OutlineChoice choice;
  CurveChoice curve_choice;                ///< what bends the inputs, and why; without candidates where none was tried
  std::vector<CurveEstimate> curves;       ///< one an input, of the returned model; empty: none
  std::vector<InputAlignment> alignment;   ///< of every recording's inputs
  std::size_t rows_learned = 0;            ///< complete rows before the cut, which the judged model was learned from
  std::size_t rows_held_out = 0;           ///< and after it
  bool refitted = false;                   ///< whether the returned model was learned from both
  OutlineFigures learned;                  ///< on what was learned from
  std::optional<OutlineFigures> held_out;  ///< on what was held out; nothing where that is too short
  std::vector<OutlineResidual> residuals;  ///< of the returned model, one a channel
  double fpe = 0;                          ///< of the returned model, mean over rows of V·(1 + d/n)/(1 − d/n)
  ArxStability stable;
  Cost cost;
  double held_share = 0;         ///< of steps in which an output is held at its range, playing freely with noise
  std::vector<double> sd_ratio;  ///< of every channel: playing freely along the liveliest recording over
                                 ///< what that has; 1 where nothing moves
  double shared_variance = 0;    ///< share of the wanted shocks' variance that the shared ones carry, 0 to 1
  bool variance_matched = false;
  double pixels_per_unit = 0;  ///< of the first recording
  std::vector<std::string> warnings;
  Usable usable;
};

/// A model of an outline and what to think of it.
struct OutlineFit {
  Model model;
  OutlineSummary summary;
};

/// Learns a model from recordings of an outline in pixels (outline_units.hpp). The model has the knots of the first;
/// recordings with others are expressed in those, with a warning.
/// Errors, naming the recording: not an outline, another number of points than the first, rates that differ, inputs
/// that it has not, too few rows for the order, options out of range.
Result<OutlineFit> learn_outline(std::span<const Recording> recordings, const OutlineOptions& options = {});

}  // namespace wisp
