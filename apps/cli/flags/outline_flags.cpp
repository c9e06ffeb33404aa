#include "flags/outline_flags.hpp"

#include <cstdlib>
#include <optional>

#include "flags/curve_flag.hpp"
#include "wisp/model/extinction.hpp"

namespace wisp::cli {
namespace {

std::optional<int> number_unless_auto(const Arguments& arguments, std::string_view flag) {
  if (arguments.text(flag) == "auto") return std::nullopt;
  return arguments.integer(flag);
}

InputGain gain_of(const std::string& word) {
  return word == "auto" ? InputGain::kAuto : word == "one" ? InputGain::kCommon : InputGain::kPerRecording;
}

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
      {"order",
       Kind::kIntegerOrWord,
       "N|auto",
       "0",
       "lags of outputs and inputs in every equation; 0: 2 where all points feed each other (4 of an input whose root "
       "and square are regressors too), 3 where residuals are resampled, else 4; auto searches 1 to 32 on what is held "
       "out",
       {"auto"}},
      {"delay",
       Kind::kIntegerOrWord,
       "N|auto",
       "0",
       "frames until an input acts; auto searches up to a quarter of a second",
       {"auto"}},
      align_flag(),
      {"gain",
       Kind::kChoice,
       "G",
       "auto",
       "the winds of several recordings on one scale, as one microphone hears them (one), each on its own (own), or as "
       "held-out data say (auto)",
       {"auto", "one", "own"}},
      {"coupling",
       Kind::kChoice,
       "C",
       "auto",
       "what feeds each other: nothing (coordinate), a point's two coordinates, neighbouring points, all points; auto: "
       "full where residuals are resampled from at least 20 s, coordinate where from less or with --light, else point",
       {"auto", "coordinate", "point", "band", "full"}},
      {"light", Kind::kSwitch, "", "",
       "a third of the arithmetic a frame, for less fidelity: every coordinate its own system"},
      {"one-sided", Kind::kSwitch, "", "", "inputs as they are: no sign, no mirror image"},
      {"holdout", Kind::kNumber, "SHARE", "0.3",
       "kept for judging: the last part of each recording, or of a flicker without inputs seconds in turn"},
      {"noise",
       Kind::kChoice,
       "N",
       "auto",
       "what shakes the outline: independent (each channel by itself), residual or matched (shared shocks), resampled "
       "(the "
       "residuals themselves, played again where the input is as it was); auto: resampled from 10 s on with an input, "
       "else "
       "matched",
       {"auto", "independent", "residual", "matched", "resampled"}},
      {"seed", Kind::kInteger, "N", "1", "of the trial runs"},
      {"skip-bad", Kind::kSwitch, "", "", "leave bad recordings out, listing them, instead of stopping at the first"},
  };
}

Result<OutlineRecipe> outline_recipe(const Arguments& arguments, std::string name) {
  const auto extinction = extinction_recipe(arguments);
  if (!extinction) return extinction.error();
  OutlineRecipe recipe;
  recipe.extinction = *extinction;
  recipe.order = number_unless_auto(arguments, "order");
  recipe.delay = number_unless_auto(arguments, "delay");
  recipe.align = arguments.text("align") == "auto";
  recipe.gain = gain_of(arguments.text("gain"));
  const std::string& coupling = arguments.text("coupling");
  if (coupling == "coordinate") recipe.coupling = OutlineCoupling::kCoordinate;
  if (coupling == "point") recipe.coupling = OutlineCoupling::kPoint;
  if (coupling == "band") recipe.coupling = OutlineCoupling::kBand;
  if (coupling == "full") recipe.coupling = OutlineCoupling::kFull;
  const std::string& noise = arguments.text("noise");
  if (noise == "independent") recipe.noise = OutlineNoise::kIndependent;
  if (noise == "residual") recipe.noise = OutlineNoise::kResidual;
  if (noise == "matched") recipe.noise = OutlineNoise::kMatched;
  if (noise == "resampled") recipe.noise = OutlineNoise::kResampled;
  recipe.light = arguments.on("light");
  recipe.one_sided = arguments.on("one-sided");
  recipe.input_curve = curve_knots_of(arguments);
  recipe.holdout = arguments.number("holdout");
  recipe.seed = static_cast<std::uint64_t>(arguments.integer("seed"));
  recipe.name = std::move(name);
  return recipe;
}

}  // namespace wisp::cli
