#pragma once
// How an outline, and a flame, is learned from recordings of its control points.
//
// Source: L.-M. Reissell and D. K. Pai (2001), section 3.4. Beyond the paper: components of the outline's shape instead
// of control points, wind from both sides, no input at all, resampled residuals, a part held out for judging,
// extinction.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace wisp {

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

/// How to learn an outline.
struct OutlineRecipe {
  int paper = 0;      ///< 0: symmetric and antisymmetric components of the shape, resampled residuals; 1 to 64: the
                      ///< paper's systems, one a control point, of that order (its own is 4), Gaussian noise
  bool align = true;  ///< move inputs that come after the motion that they cause
  std::optional<std::vector<std::string>> inputs{};  ///< names; unset: all of the recordings; empty: none, flicker only
  double holdout = 0.3;  ///< 0 to 0.9: the last part of each recording is kept for judging, and then learned from too
  double pixels_per_unit = 0;  ///< 0: each recording's own mean calm height is 1
  ExtinctionRecipe extinction{};
  std::uint64_t seed = 1;        ///< of the trial runs
  std::string name = "outline";  ///< of the model
};

/// How to learn a flame: an outline that wind extinguishes.
struct FlameRecipe : OutlineRecipe {
  FlameRecipe() { extinction.source = ExtinctionSource::kAuto; }
};

}  // namespace wisp
