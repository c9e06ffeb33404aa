// `wisp learn outline` and its preset `wisp learn flame`: learn a model of an outline, from clips or recordings.

#include <cstdio>

#include "commands/commands.hpp"
#include "flags/capture_flags.hpp"
#include "flags/recipe_flags.hpp"
#include "reports/learned_model.hpp"
#include "terminal.hpp"
#include "wisp/learn/learn.hpp"
#include "wisp/model/extinction.hpp"

namespace wisp::cli {
namespace {

Result<ExtinctionRecipe> extinction_recipe(const Arguments& arguments) {
  const std::string& text = arguments.text("blow-out");
  if (text == "off") return ExtinctionRecipe{};
  if (text == "auto") return ExtinctionRecipe{ExtinctionSource::kAuto};
  ExtinctionRecipe recipe{ExtinctionSource::kGiven};
  char rest = 0;
  if (std::sscanf(text.c_str(), "%lf,%lf%c", &recipe.level, &recipe.seconds, &rest) != 2) {
    return Error{"--blow-out: found \"" + text + "\", expected auto, off, or LEVEL,SECONDS such as 1.5,0.3"};
  }
  const auto fits = check(Extinction{.level = recipe.level, .seconds = recipe.seconds}, 1, 0);
  if (!fits) return Error{"--blow-out: " + fits.error().message};
  return recipe;
}

Result<void> run_learn_outline(const Arguments& arguments, Terminal& terminal) {
  const auto extinction = extinction_recipe(arguments);
  if (!extinction) return extinction.error();
  OutlineRecipe recipe{.extinction = *extinction};
  if (auto ok = read_recipe(arguments, recipe); !ok) return ok;
  recipe.name = model_name(arguments);
  const auto recordings = outline_recordings(arguments.positionals(), arguments, terminal);
  if (!recordings) return recordings.error();
  return hand_over(wisp::learn(*recordings, recipe, terminal.progress()), arguments, terminal);
}

struct Preset {
  const char* extinction;
  const char* flame;
};

Command learn(std::string name, std::string summary, const Preset& preset, std::vector<Example> examples) {
  const std::vector<Flag> flags = {
      output_flag(),
      {"blow-out", Kind::kText, "auto|off|LEVEL,SECONDS", preset.extinction,
       "what wind puts it out: learned where the recordings have it and else twice the strong wind of training "
       "(auto), nothing (off), or any wind of LEVEL (1: the 95th percentile of training) for SECONDS"},
      {"skip-bad", Kind::kSwitch, "", "", "leave bad recordings out, listing them, instead of stopping at the first"},
  };
  return {std::move(name),
          std::move(summary),
          {{"CLIP_OR_REC", "clips, folders of images, or recordings (.csv)", true}},
          flags_of({flags, recipe_flags(OutlineRecipe{}), capture_flags(preset.flame)}),
          std::move(examples),
          run_learn_outline};
}

}  // namespace

Command learn_outline_command() {
  return learn("learn outline", "Learns how an outline moves, by itself and driven by its inputs.", {"off", "0"},
               {{"wisp learn outline flag.mp4 --dark --points 12 -o flag.wisp", "Straight from a clip"}});
}

Command learn_flame_command() {
  return learn(
      "learn flame", "Learns a flame: `learn outline` with a flame's settings.", {"auto", "1"},
      {{"wisp learn flame candle.csv -o flame.wisp", "From a captured recording"},
       {"wisp learn flame candle.mp4 --points 16 -o flame.wisp", "Straight from a clip, sixteen control points"},
       {"wisp learn flame candle.csv --blow-out 1.5,0.3 -o flame.wisp",
        "A flame that wind of one and a half times the training's blows out in 0.3 seconds"}});
}

}  // namespace wisp::cli
