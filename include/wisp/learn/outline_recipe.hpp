#pragma once
// How an outline, and a flame, is learned from recordings of its control points.
//
// Source: L.-M. Reissell and D. K. Pai (2001), section 3.4. Beyond the paper: components of the outline's shape instead
// of control points, wind from both sides, no input at all, resampled residuals, a part held out for judging,
// extinction.

#include <cstdint>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "wisp/learn/recipe_fields.hpp"

namespace wisp {

/// Where a model's rule of extinction comes from.
enum class ExtinctionSource {
  kNone,   ///< there is none: nothing extinguishes it
  kAuto,   ///< learned from recorded extinctions; without any, the default raised above all gusts that were survived
  kGiven,  ///< `level` and `seconds`
};

template <>
inline constexpr std::array<std::string_view, 3> kWordsOf<ExtinctionSource>{"none", "auto", "given"};

/// The rule of what extinguishes a flame (wisp/model/extinction.hpp). It is of the first input.
struct ExtinctionRecipe {
  ExtinctionSource source = ExtinctionSource::kNone;
  double level = 0;    ///< for kGiven: input, 1 is the 95th percentile of training; in the range of Extinction::level
  double seconds = 0;  ///< for kGiven: for which it must last; in the range of Extinction::seconds
};

/// How to learn an outline. What each field means: fields_of() below.
struct OutlineRecipe {
  int paper = 0;
  bool align = true;
  std::optional<std::vector<std::string>> inputs{};
  double holdout = 0.3;
  double pixels_per_unit = 0;
  ExtinctionRecipe extinction{};
  std::uint64_t seed = 1;
  std::string name = "outline";
};

/// How to learn a flame: an outline that wind extinguishes.
struct FlameRecipe : OutlineRecipe {
  FlameRecipe() { extinction.source = ExtinctionSource::kAuto; }
};

constexpr auto fields_of(const OutlineRecipe&) {
  using R = OutlineRecipe;
  return std::tuple(
      field("paper", &R::paper,
            "the paper's systems, one a control point, of that order (its own is 4), with independent Gaussian noise; "
            "0: symmetric and antisymmetric components of the shape, with resampled residuals",
            {"paper", "ORDER", 0, 64}),
      field("align", &R::align, "auto: an input that comes after the motion that it causes is moved; off: as recorded",
            {.flag = "align", .sign = "A", .words = {"off", "auto"}}),
      field("inputs", &R::inputs, "names; none given: all of the recordings; an empty list: flicker alone"),
      field("holdout", &R::holdout, "kept for judging, and then learned from too: the last part of each recording",
            {"holdout", "SHARE", 0, 0.9}),
      field("pixels_per_unit", &R::pixels_per_unit, "0: each recording's own mean calm height is 1", {nullptr, "", 0}),
      field("extinction", &R::extinction, "what puts it out: a rule of the first input"),
      field("seed", &R::seed, "of the trial runs", {"seed", "N"}), field("name", &R::name, "of the model"));
}

}  // namespace wisp
