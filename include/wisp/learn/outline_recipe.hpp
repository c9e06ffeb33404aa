#pragma once
// How an outline, and a flame, is learned from recordings of its control points.
//
// Source: L.-M. Reissell and D. K. Pai (2001), section 3.4: every control point its own ARX system of two outputs,
// order 4, driven by the wind, its residual fed back as Gaussian noise. Beyond it: wind from both sides, inputs or
// none, shocks that the control points share (docs/fidelity.md says why), a part held out for judging.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

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

/// On which scale the inputs of several recordings are, where they say how loud the sound was at 1.
enum class InputGain {
  kAuto,          ///< as free simulation of held-out data says
  kCommon,        ///< one for all, as one microphone hears them
  kPerRecording,  ///< each recording's own
};

/// Where a model's rule of extinction comes from.
enum class ExtinctionSource {
  kNone,   ///< there is none: nothing puts it out
  kAuto,   ///< learned from the recorded extinctions; without any, the default raised above all gusts that it survived
  kGiven,  ///< `level` and `seconds`
};

/// The rule of what input puts the thing out (wisp/model/extinction.hpp). It is of the first input.
struct ExtinctionRecipe {
  ExtinctionSource source = ExtinctionSource::kNone;
  double level = 0;    ///< for kGiven: input, 1 is the 95th percentile of training; in the range of Extinction::level
  double seconds = 0;  ///< for kGiven: for which it must last; in the range of Extinction::seconds
};

/// How to learn an outline.
struct OutlineRecipe {
  std::optional<int> order = 0;  ///< lags of outputs and of inputs, 1 to 64; unset: searched, up to 32; 0: 3 where
                                 ///< residuals are drawn, which hold the rest, and else 4, the paper's, two damped
                                 ///< resonances a coordinate
  std::optional<int> delay = 0;  ///< frames until an input acts, 0 to 1000; 0: in the same frame, the paper's; unset:
                                 ///< searched, up to a quarter of a second
  bool align = true;             ///< move inputs that come after the motion that they cause
  InputGain gain = InputGain::kAuto;
  std::optional<OutlineCoupling> coupling{};  ///< unset: kCoordinate where residuals are drawn, else kPoint; more costs
                                            ///< more and did not look better (docs/fidelity.md)
  std::optional<std::vector<std::string>> inputs{};  ///< names; unset: all inputs of the recordings; empty: none, flicker
  bool square = false;                             ///< every input's square beside it: what it does may bend
  std::optional<int> input_curve = 0;  ///< knots of a monotone curve that bends every input, 3 to 16; 0: none; unset: 3
                                       ///< to 6 or none, as held-out data say, none beside squares
  bool one_sided = false;      ///< inputs as they are, no sign and no mirror image: the paper's 192 multiply-adds
  std::optional<bool> mirror{};  ///< learn from the mirror image too; unset: where inputs have signs
  double holdout = 0.3;        ///< 0 to 0.9: the last part of each recording, kept for judging
  bool refit = true;           ///< after judging, learn the model that is returned from everything
  std::optional<OutlineNoise> noise{};     ///< unset: kDrawn where an input drives the outline and there are 10 s of it,
                                         ///< else kMatched: what is short would be seen to repeat
  std::size_t drawn_bytes = 256 * 1024;  ///< most that drawn residuals take, two a channel and frame
  int shared_shocks = 4;                 ///< 1 to 64: normal numbers a frame; more changed no figure (docs/fidelity.md)
  bool growing_noise = true;             ///< let the noise grow with the inputs where held-out data say that it does
  bool match_variance = true;            ///< scale the noise until every channel at rest has the recording's variance
  double pixels_per_unit = 0;            ///< 0: each recording's own mean calm height is 1
  ExtinctionRecipe extinction{};
  std::uint64_t seed = 1;                ///< of the trial runs
  std::string name = "outline";          ///< of the model
};

/// How to learn a flame: an outline that wind puts out, and whose lean need not be proportional to the wind.
struct FlameRecipe : OutlineRecipe {
  FlameRecipe() {
    input_curve.reset();
    extinction.source = ExtinctionSource::kAuto;
  }
};

}  // namespace wisp
