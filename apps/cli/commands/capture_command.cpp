// `wisp capture outline` and its preset `wisp capture flame`: from a clip to a recording.

#include <chrono>

#include "commands/commands.hpp"
#include "flags/capture_flags.hpp"
#include "terminal.hpp"
#include "wisp/record/csv.hpp"

namespace wisp::cli {
namespace {

Json wind_json(const CapturedClip& clip) {
  return {{"heard", clip.wind_heard}, {"background", number(clip.wind_background)}, {"reason", clip.wind_note}};
}

void report(const CapturedClip& clip, Terminal& terminal) {
  const CaptureReport& found = clip.report;
  Json& result = terminal.result();
  result["frames"] = found.frames;
  result["tracked"] = found.tracked;
  result["duplicates"] = found.duplicates;
  result["filled"] = found.filled;
  result["dropped"] = Json::array();
  for (const DroppedFrame& dropped : found.dropped) {
    result["dropped"].push_back({{"frame", dropped.frame}, {"reason", dropped.reason}});
  }
  result["flames"] = found.flames;
  result["out_at"] = found.out_at ? Json(*found.out_at + 1) : Json();
  result["usable"] = {{"verdict", found.usable}, {"reason", found.reason}};
  result["rate_hz"] = number(found.rate_hz);
  result["points"] = found.points;
  result["threshold"] = number(found.threshold);
  result["channel"] = std::string(channel_name(found.channel));
  result["wind"] = wind_json(clip);
  result["separation"] = number(found.separation);
  result["residual_px"] = number(found.residual);
  result["knots_placed"] = found.knots_placed;
  terminal.say((found.usable ? "usable: " : "not usable: ") + found.reason);
  terminal.say(std::to_string(found.frames) + " frames: " + std::to_string(found.tracked) + " tracked, " +
               std::to_string(found.duplicates) + " duplicates, " + std::to_string(found.filled) + " filled, " +
               std::to_string(found.dropped.size()) + " dropped");
  terminal.say("channel " + std::string(channel_name(found.channel)) + ", threshold " + shown(found.threshold) +
               ", edge points within " + shown(found.residual, 2) + " px of the curve");
  terminal.say("wind " + clip.wind_note);
}

Result<void> run(const Arguments& arguments, Terminal& terminal) {
  const auto start = std::chrono::steady_clock::now();
  const auto clip = capture_clip(arguments.positional(), arguments, terminal);
  if (!clip) return clip.error();
  for (const std::string& warning : clip->report.warnings) terminal.warn(warning);
  const std::string& path = arguments.text("output");
  if (auto ok = write_csv(path, clip->recording); !ok) return ok;
  report(*clip, terminal);
  terminal.say("wrote " + path);
  terminal.result()["output"] = path;
  terminal.result()["seconds"] = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return {};
}

Command capture(std::string name, std::string summary, std::vector<Example> examples) {
  std::vector<Flag> flags = {{"output", Kind::kPath, "REC.csv", "", "where to write the recording", {}, true}};
  for (Flag& flag : capture_flags()) flags.push_back(std::move(flag));
  return {std::move(name),  std::move(summary),  {{"CLIP", "a video file, or a folder of numbered images"}},
          std::move(flags), std::move(examples), run};
}

}  // namespace

Command capture_outline_command() {
  return capture("capture outline",
                 "Finds the outline of a moving thing in a clip, frame by frame, and writes it as a recording.",
                 {{"wisp capture outline flag.mp4 --dark --points 12 -o flag.csv", "A dark flag on a light ground"},
                  {"wisp capture outline frames/ --rate 30 -o flame.csv", "A folder of numbered images"}});
}

Command capture_flame_command() {
  return capture(
      "capture flame", "Finds the outline of a flame in a clip: `capture outline` with a flame's settings.",
      {{"wisp capture flame candle.mp4 -o candle.csv", "The outline of a candle's flame, eight control points"},
       {"wisp capture flame candle.mp4 --points 16 --frames 1:300 -o candle.csv",
        "Finer, and only the first 300 frames"}});
}

}  // namespace wisp::cli
