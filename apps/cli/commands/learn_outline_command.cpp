// `wisp learn outline` and its preset `wisp learn flame`: a model of an outline, from clips or recordings.

#include <chrono>
#include <filesystem>

#include "commands/commands.hpp"
#include "flags/capture_flags.hpp"
#include "flags/outline_flags.hpp"
#include "reports/learned_model.hpp"
#include "terminal.hpp"
#include "wisp/learn/learn.hpp"

namespace wisp::cli {
namespace {

Result<void> run_learn_outline(const Arguments& arguments, Terminal& terminal) {
  const auto start = std::chrono::steady_clock::now();
  const std::string path = model_path(arguments);
  const auto recipe = outline_recipe(arguments, model_name(arguments));
  if (!recipe) return recipe.error();
  const auto recordings = outline_recordings(arguments.positionals(), arguments, terminal);
  if (!recordings) return recordings.error();
  const auto fit = wisp::learn(*recordings, *recipe, terminal.progress());
  if (!fit) return fit.error();
  return hand_over(*fit, path, start, terminal);
}

// What differs between the presets.
struct Preset {
  const char* extinction;
  const char* flame;
};

Command learn(std::string name, std::string summary, const Preset& preset, std::vector<Example> examples) {
  std::vector<Flag> flags = {output_flag(), extinction_flag(preset.extinction)};
  for (const std::vector<Flag>& more : {outline_flags(), capture_flags(preset.flame)}) {
    flags.insert(flags.end(), more.begin(), more.end());
  }
  return {
      std::move(name),  std::move(summary),  {{"CLIP_OR_REC", "clips, folders of images, or recordings (.csv)", true}},
      std::move(flags), std::move(examples), run_learn_outline};
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
