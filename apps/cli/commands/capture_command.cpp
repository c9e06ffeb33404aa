// `wisp capture outline` and its preset `wisp capture flame`: from a clip to a recording.

#include <chrono>

#include "commands/commands.hpp"
#include "flags/capture_flags.hpp"
#include "terminal.hpp"
#include "wisp/record/csv.hpp"

namespace wisp::cli {
namespace {

Result<void> run(const Arguments& arguments, Terminal& terminal) {
  const auto start = std::chrono::steady_clock::now();
  const auto options = capture_options(arguments);
  if (!options) return options.error();
  const auto clip = capture(arguments.positional(), *options, terminal.progress());
  if (!clip) return clip.error();
  const std::string& path = arguments.text("output");
  if (auto ok = write_csv(path, clip->recording); !ok) return ok;
  terminal.show(clip->report);
  terminal.say("wrote " + path);
  terminal.add("output", path);
  terminal.add("seconds", std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  return {};
}

Command capturing(std::string name, const std::string& flame, std::string summary, std::vector<Example> examples) {
  std::vector<Flag> flags = {{"output", Kind::kOutput, "REC.csv", "", "where to write the recording", {}, true}};
  for (Flag& flag : capture_flags(flame)) flags.push_back(std::move(flag));
  return {std::move(name),  std::move(summary),  {{"CLIP", "a video file, or a folder of numbered images"}},
          std::move(flags), std::move(examples), run};
}

}  // namespace

Command capture_outline_command() {
  return capturing("capture outline", "0",
                   "Finds the outline of a moving thing in a clip, frame by frame, and writes it as a recording.",
                   {{"wisp capture outline flag.mp4 --dark --points 12 -o flag.csv", "A dark flag on a light ground"},
                    {"wisp capture outline frames/ --rate 30 -o flame.csv", "A folder of numbered images"}});
}

Command capture_flame_command() {
  return capturing(
      "capture flame", "1", "Finds the outline of a flame in a clip: `capture outline` with a flame's settings.",
      {{"wisp capture flame candle.mp4 -o candle.csv", "The outline of a candle's flame, eight control points"},
       {"wisp capture flame candle.mp4 --points 16 --frames 1:300 -o candle.csv",
        "Finer, and only the first 300 frames"}});
}

}  // namespace wisp::cli
