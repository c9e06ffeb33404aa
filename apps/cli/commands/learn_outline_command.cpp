// `wisp learn outline` and its preset `wisp learn flame`: a model of an outline, from clips or recordings.

#include <chrono>
#include <filesystem>

#include "commands/commands.hpp"
#include "flags/capture_flags.hpp"
#include "reports/blow_out_learning.hpp"
#include "reports/curve_learning.hpp"
#include "reports/learned_model.hpp"
#include "reports/outline_learning.hpp"
#include "terminal.hpp"

namespace wisp::cli {
namespace {

// What is learned from: all recordings on one scale, or each on its own, as asked for or as held-out data say.
Result<BlowOuts> heard_blow_outs(std::vector<Recording> recordings, const BlowOutWish& wish,
                                 const OutlineOptions& options, const Arguments& arguments, Terminal& terminal) {
  auto own = BlowOuts::find(recordings, wish);
  if (!own) return own.error();
  const auto gain = choose_wind_gain(own->burning(), options, wanted_gain(arguments));
  if (!gain) return gain.error();
  report_gain(*gain, terminal);
  if (!gain->one) return own;
  auto together = at_one_gain(std::move(recordings));
  if (!together) return together.error();
  return BlowOuts::find(*std::move(together), wish);
}

Result<void> run(const Arguments& arguments, Terminal& terminal) {
  const auto start = std::chrono::steady_clock::now();
  const auto wish = blow_out_wish(arguments);
  if (!wish) return wish.error();
  const std::string& path = arguments.text("output");
  const auto options = outline_options(arguments, std::filesystem::path(path).stem().string());
  if (!options) return options.error();
  auto recordings = outline_recordings(arguments.positionals(), arguments, terminal);
  if (!recordings) return recordings.error();
  const auto blow_outs = heard_blow_outs(*std::move(recordings), *wish, *options, arguments, terminal);
  if (!blow_outs) return blow_outs.error();
  auto fit = learn_outline(blow_outs->burning(), *options);
  if (!fit) return fit.error();
  fit->model.training.program = "wisp " WISP_VERSION;
  for (const std::string& warning : fit->summary.warnings) terminal.warn(warning);
  if (auto ok = blow_outs->complete(*fit, *wish, terminal); !ok) return ok;
  if (auto ok = write_learned(path, fit->model); !ok) return ok;
  report_outline(*fit, terminal);
  terminal.say("wrote " + path);
  terminal.result()["output"] = path;
  terminal.result()["seconds"] = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return {};
}

// What differs between the presets.
struct Preset {
  const char* blow_out;
  const char* input_curve;
};

Command learn(std::string name, std::string summary, const Preset& preset, std::vector<Example> examples) {
  std::vector<Flag> flags = {{"output", Kind::kPath, "M.wisp", "", "where to write the model", {}, true},
                             blow_out_flag(preset.blow_out),
                             curve_flag(preset.input_curve, "")};
  for (auto* more : {&outline_flags, &capture_flags}) {
    for (Flag& flag : (*more)()) flags.push_back(std::move(flag));
  }
  return {
      std::move(name),  std::move(summary),  {{"CLIP_OR_REC", "clips, folders of images, or recordings (.csv)", true}},
      std::move(flags), std::move(examples), run};
}

}  // namespace

Command learn_outline_command() {
  return learn("learn outline", "Learns how an outline moves, by itself and driven by its inputs.", {"off", "0"},
               {{"wisp learn outline flag.mp4 --dark --points 12 -o flag.wisp", "Straight from a clip"}});
}

Command learn_flame_command() {
  return learn(
      "learn flame", "Learns a flame: `learn outline` with a flame's settings.", {"auto", "auto"},
      {{"wisp learn flame candle.csv -o flame.wisp", "From a captured recording"},
       {"wisp learn flame candle.mp4 --points 16 -o flame.wisp", "Straight from a clip, sixteen control points"},
       {"wisp learn flame candle.csv --blow-out 1.5,0.3 -o flame.wisp",
        "A flame that wind of one and a half times the training's blows out in 0.3 seconds"}});
}

}  // namespace wisp::cli
