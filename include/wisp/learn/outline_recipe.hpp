#pragma once
// Recipes for learning an outline, or a flame, from recordings of its control points.
//
// Source: L.-M. Reissell and D. K. Pai (2001), section 3.4. Departures from the paper: components of the outline's
// shape instead of control points, wind from both sides, models without inputs, resampled residuals, a held-out part
// for judging, extinction.

#include <cstdint>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "wisp/learn/recipe_fields.hpp"

namespace wisp {

/// Origin of a model's rule of extinction.
enum class ExtinctionSource {
  kNone,   ///< no rule: nothing extinguishes the flame
  kAuto,   ///< learned from recorded extinctions; without any, the default raised above all gusts survived
  kGiven,  ///< `level` and `seconds`
};

template <>
inline constexpr std::array<std::string_view, 3> kWordsOf<ExtinctionSource>{"none", "auto", "given"};

/// Rule of a flame's extinction (wisp/model/extinction.hpp). It applies to the first input.
struct ExtinctionRecipe {
  ExtinctionSource source = ExtinctionSource::kNone;
  double level = 0;    ///< for kGiven: extinguishing wind, 1 is the training's 95th percentile; as Extinction::level
  double seconds = 0;  ///< for kGiven: duration at that level until extinction; as Extinction::seconds
};

/// Settings for learning an outline. fields_of() below documents each field.
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

/// Settings for learning a flame: an outline that wind extinguishes.
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
