#pragma once
// How an outline, and a flame, is learned from recordings of its control points.
//
// Source: L.-M. Reissell and D. K. Pai (2001), section 3.4: every control point is an ARX system of two outputs and
// order 4, driven by the wind; its residual is fed back as Gaussian noise. Beyond the paper: wind from both sides, no
// input at all, shocks shared by control points or resampled residuals, a part held out for judging, extinction.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "wisp/learn/arx_recipe.hpp"

namespace wisp {

/// Which control points feed each other.
enum class OutlineCoupling {
  kCoordinate,  ///< none: every coordinate is its own system
  kPoint,       ///< every point is its own system, as in the paper
  kBand,        ///< every point hears its neighbours too, regularised by a ridge
  kFull,        ///< every point hears all others but the last, which mirrors the first about the base; with a ridge
                ///< on the components of the outline's shape
};

/// What shakes the outline.
enum class OutlineNoise {
  kIndependent,  ///< every channel by itself, with its residual's standard deviation: the paper's
  kResidual,     ///< shared shocks with the residuals' covariance
  kMatched,      ///< shared shocks under which the whole outline at rest has the recording's covariance; where points
                 ///< feed each other, as kResidual: the coupling itself keeps the shape
  kResampled,    ///< resampled residuals (block bootstrap), matched to the input as it was
};

/// On which scale the inputs of several recordings are, where they say how loud the sound was at 1.
enum class InputGain {
  kAuto,          ///< the one of less error in free simulation of held-out data
  kCommon,        ///< one for all, as one microphone hears them
  kPerRecording,  ///< each recording's own
};

/// Where a model's rule of extinction comes from.
enum class ExtinctionSource {
  kNone,   ///< there is none: nothing extinguishes it
  kAuto,   ///< learned from recorded extinctions; without any, the default raised above all gusts that were survived
  kGiven,  ///< `level` and `seconds`
};

/// The rule of what extinguishes a flame (wisp/model/extinction.hpp). It is of the first input.
struct ExtinctionRecipe {
  ExtinctionSource source = ExtinctionSource::kNone;
  double level = 0;    ///< for kGiven: input, 1 is the 95th percentile of training; in the range of Extinction::level
  double seconds = 0;  ///< for kGiven: for which it must last; in the range of Extinction::seconds
};

/// How to learn an outline. What is unset is decided from the recordings, and the report says how.
struct OutlineRecipe {
  std::optional<int> order = 0;  ///< lags of outputs and of inputs, 1 to 64; unset: searched, up to 32; 0: 2 where
                                 ///< all coordinates hear each other, 3 with resampled residuals, which carry the
                                 ///< rest, and else the paper's 4, two damped resonances a coordinate
  std::optional<int> delay = 0;  ///< frames until an input acts, 0 to 1000; 0: in the same frame, as in the paper;
                                 ///< unset: searched, up to a quarter of a second
  bool align = true;             ///< move inputs that come after the motion that they cause
  InputGain gain = InputGain::kAuto;
  std::optional<OutlineCoupling> coupling{};  ///< unset: with resampled residuals kFull from 20 s on unless `light`
                                              ///< or without mirror images,
                                              ///< else kCoordinate; without them kPoint
  bool light = false;  ///< a third of the arithmetic: every coordinate its own system, an input nonlinearity in the
                       ///< place of powers of the input
  std::optional<std::vector<std::string>> inputs{};  ///< names; unset: all of the recordings; empty: none, flicker only
  std::optional<int> input_curve = 0;  ///< knots of the input nonlinearity, 3 to 16; 0: none; unset: 3 to 6 or none
  bool one_sided = false;        ///< inputs as they are, no sign and no mirror image: the paper's 192 multiply-adds
  std::optional<bool> mirror{};  ///< learn from the mirror image too; unset: where inputs have signs
  double holdout = 0.3;          ///< 0 to 0.9, kept for judging: the last part of each recording; where nothing drives
                                 ///< the outline and `refit` is set, seconds of that share, in turn
  bool refit = true;             ///< after judging, learn the returned model from everything
  std::optional<OutlineNoise> noise{};  ///< unset: kResampled for at least 10 s with an input, else kMatched: what is
                                        ///< short would be seen to repeat
  std::size_t resampled_bytes = 256 * 1024;  ///< maximum size of resampled residuals, two bytes a channel and frame
  int shared_shocks = 4;                     ///< 1 to 64: normal numbers a frame; more changed no figure
  bool match_variance = true;  ///< scale the noise until every channel at rest has the recording's variance
  double pixels_per_unit = 0;  ///< 0: each recording's own mean calm height is 1
  ExtinctionRecipe extinction{};
  std::uint64_t seed = 1;        ///< of the trial runs
  std::string name = "outline";  ///< of the model
};

/// How to learn a flame: an outline that wind extinguishes, and whose lean need not be proportional to the wind.
struct FlameRecipe : OutlineRecipe {
  FlameRecipe() {
    input_curve.reset();
    extinction.source = ExtinctionSource::kAuto;
  }
};

}  // namespace wisp
