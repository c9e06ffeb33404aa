#include "flags/outline_flags.hpp"

#include <cstdlib>

#include "wisp/model/extinction.hpp"

namespace wisp::cli {
namespace {

Result<ExtinctionRecipe> extinction_recipe(const Arguments& arguments) {
  const std::string& text = arguments.text("blow-out");
  if (text == "off") return ExtinctionRecipe{};
  if (text == "auto") return ExtinctionRecipe{ExtinctionSource::kAuto};
  ExtinctionRecipe recipe{ExtinctionSource::kGiven};
  char* end = nullptr;
  recipe.level = std::strtod(text.c_str(), &end);
  const bool comma = end != text.c_str() && *end == ',';
  const char* second = comma ? end + 1 : end;
  if (comma) recipe.seconds = std::strtod(second, &end);
  if (!comma || end == second || *end != 0) {
    return Error{"--blow-out: found \"" + text + "\", expected auto, off, or LEVEL,SECONDS such as 1.5,0.3"};
  }
  const auto fits = check(Extinction{.level = recipe.level, .seconds = recipe.seconds}, 1);
  if (!fits) return Error{"--blow-out: " + fits.error().message};
  return recipe;
}

}  // namespace

Flag extinction_flag(const std::string& fallback) {
  return {"blow-out", Kind::kText, "auto|off|LEVEL,SECONDS", fallback,
          "what wind puts it out: learned where the recordings have it and else twice the strong wind of training "
          "(auto), nothing (off), or any wind of LEVEL (1: the 95th percentile of training) for SECONDS"};
}

Flag align_flag() {
  return {"align",
          Kind::kChoice,
          "A",
          "auto",
          "auto: an input that comes after the motion that it causes is moved; off: as recorded",
          {"auto", "off"}};
}

std::vector<Flag> outline_flags() {
  return {
      {"paper", Kind::kInteger, "ORDER", "0",
       "the paper's systems, one a control point, of that order (its own is 4), with independent Gaussian noise; 0: "
       "symmetric and antisymmetric components of the shape, with resampled residuals"},
      align_flag(),
      {"holdout", Kind::kNumber, "SHARE", "0.3",
       "kept for judging, and then learned from too: the last part of each recording"},
      {"seed", Kind::kInteger, "N", "1", "of the trial runs"},
      {"skip-bad", Kind::kSwitch, "", "", "leave bad recordings out, listing them, instead of stopping at the first"},
  };
}

Result<OutlineRecipe> outline_recipe(const Arguments& arguments, std::string name) {
  const auto extinction = extinction_recipe(arguments);
  if (!extinction) return extinction.error();
  OutlineRecipe recipe;
  recipe.extinction = *extinction;
  recipe.paper = static_cast<int>(arguments.integer("paper"));
  recipe.align = arguments.text("align") == "auto";
  recipe.holdout = arguments.number("holdout");
  recipe.seed = static_cast<std::uint64_t>(arguments.integer("seed"));
  recipe.name = std::move(name);
  return recipe;
}

}  // namespace wisp::cli
