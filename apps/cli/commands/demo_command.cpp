// `wisp demo`: the whole job, as the very commands that a user would type.

#include <filesystem>
#include <fstream>

#include "commands/commands.hpp"
#include "terminal.hpp"
#include "wisp/base/file.hpp"

namespace wisp::cli {
namespace {

namespace fs = std::filesystem;

// One command of the demo: its positionals and the flags that differ from their defaults.
struct Step {
  Command command;
  std::vector<std::string> positionals;
  std::vector<std::pair<std::string, std::string>> flags;
};

std::string line_of(const Step& step) {
  std::string line = "wisp " + step.command.name;
  for (const std::string& positional : step.positionals) line += " " + positional;
  for (const auto& [name, value] : step.flags)
    line += (name == "output" ? " -o" : " --" + name) + (value == "on" ? "" : " " + value);
  return line;
}

Arguments arguments_of(const Step& step) {
  Arguments arguments;
  for (const Flag& flag : step.command.flags) {
    if (!flag.fallback.empty()) arguments.set(flag.name, flag.fallback);
  }
  for (const auto& [name, value] : step.flags) arguments.set(name, value);
  arguments.set_positionals(step.positionals);
  return arguments;
}

// Runs one step; its figures go into the demo's result under `name`.
Result<void> run_step(const std::string& name, const Step& step, Terminal& terminal) {
  terminal.say("\n$ " + line_of(step));
  Json all = std::move(terminal.result());
  terminal.result() = {{"warnings", Json::array()}};
  auto outcome = step.command.run(arguments_of(step), terminal);
  all[name] = std::move(terminal.result());
  all[name]["command"] = line_of(step);
  terminal.result() = std::move(all);
  return outcome;
}

struct Places {
  fs::path folder;
  std::string at(const char* name) const { return (folder / name).string(); }
};

// What the model is learned from, and what it is held against.
struct Clips {
  std::string learn;
  std::string validate;
  std::string truth{};  // of the clip to validate, where it is simulated
};

Result<Clips> simulate_clips(const Places& places, const Arguments& arguments, Terminal& terminal) {
  const Clips clips{places.at("training.mp4"), places.at("validation.mp4"), places.at("validation.truth.csv")};
  const auto seed = arguments.integer("seed");
  const auto simulate = [&](const std::string& name, const std::string& path, const char* seconds, int clip_seed) {
    return run_step(
        name,
        {simulate_candle_command(), {}, {{"output", path}, {"seconds", seconds}, {"seed", std::to_string(clip_seed)}}},
        terminal);
  };
  if (auto ok = simulate("simulate_training", clips.learn, "40", seed); !ok) return ok.error();
  if (auto ok = simulate("simulate_validation", clips.validate, "20", seed + 1); !ok) return ok.error();
  return clips;
}

Result<void> run_steps(const Places& places, const Clips& clips, const Arguments& arguments, Terminal& terminal) {
  const std::string& points = arguments.text("points");
  std::vector<std::pair<std::string, std::string>> capture{{"output", places.at("recording.csv")}, {"points", points}};
  if (arguments.has("rate")) capture.push_back({"rate", arguments.text("rate")});
  const std::string model = places.at("flame.wisp");
  if (auto ok = run_step("capture", {capture_flame_command(), {clips.learn}, capture}, terminal); !ok) return ok;
  const Step learn{learn_flame_command(), {places.at("recording.csv")}, {{"output", model}}};
  if (auto ok = run_step("learn", learn, terminal); !ok) return ok;

  Step validate{validate_command(), {model, clips.validate}, {}};
  if (arguments.has("rate")) validate.flags.push_back({"rate", arguments.text("rate")});
  if (!clips.truth.empty()) validate.flags.push_back({"truth", clips.truth});
  validate.flags.push_back({"overlay", places.at("overlay.mp4")});
  validate.flags.push_back({"film-strip", places.at("film-strip.png")});
  validate.flags.push_back({"figures", places.at("figures")});
  if (auto ok = run_step("validate", validate, terminal); !ok) return ok;

  const std::string frames =
      std::to_string(std::max(1, static_cast<int>(20 * terminal.result()["learn"]["rate_hz"].get<double>())));
  Step film{run_command(), {model}, {{"frames", frames}, {"output", places.at("flame.mp4")}}};
  if (!terminal.result()["learn"]["inputs"].empty()) film.flags.push_back({"input", places.at("recording.csv")});
  return run_step("run", film, terminal);
}

void say_what_next(const Places& places, Terminal& terminal) {
  terminal.say("\nIn " + places.folder.string() + ":");
  terminal.say("  flame.wisp      the model");
  terminal.say("  overlay.mp4     the clip with the captured and the predicted outline over it");
  terminal.say("  film-strip.png  the clip above, the learned flame below");
  terminal.say("  flame.mp4       twenty seconds of new flame");
  terminal.say("  figures/        plots: noise, fit, spectra");
  terminal.say("  summary.json    all figures");
  terminal.say("What to try next:");
  terminal.say("  wisp demo YOUR_CLIP.mp4 --points 16                 a clip of your own, finer");
  terminal.say("  wisp run " + places.at("flame.wisp") + " --frames 600 --instances 5 -o cake.mp4   five candles");
  terminal.say("  wisp info " + places.at("flame.wisp") + "             what the file holds and what a frame costs");
  terminal.say("  wisp play " + places.at("flame.wisp") + "             blow on it, live, in a window");
  terminal.say("  script/web serve                      the same in a browser; drop flame.wisp onto the page");
}

Result<void> run(const Arguments& arguments, Terminal& terminal) {
  const Places places{arguments.text("output")};
  std::error_code code;
  fs::create_directories(places.folder, code);
  if (code) return Error{places.folder.string() + ": cannot be made: " + code.message()};
  Clips clips;
  if (arguments.positionals().empty()) {
    auto simulated = simulate_clips(places, arguments, terminal);
    if (!simulated) return simulated.error();
    clips = *simulated;
  } else {
    clips = {arguments.positional(), arguments.positional()};
  }
  if (auto ok = run_steps(places, clips, arguments, terminal); !ok) return ok;
  if (auto ok = write_file(places.at("summary.json"), terminal.result().dump(1) + "\n"); !ok) return ok;
  say_what_next(places, terminal);
  if (!arguments.on("window")) return {};
  return run_step("play", {play_command(), {places.at("flame.wisp")}, {}}, terminal);
}

}  // namespace

Command demo_command() {
  return {
      "demo",
      "The whole job: from a clip of a flame to a model and its pictures. Without a clip it simulates one.",
      {{"CLIP", "a video of a flame, or a folder of numbered images", false, true}},
      {
          {"output", Kind::kPath, "DIR", "out/demo", "the folder for all that is made"},
          {"points", Kind::kInteger, "N", "8", "control points of the outline"},
          {"rate", Kind::kNumber, "HZ", "", "frames a second of a folder of images"},
          {"window", Kind::kSwitch, "", "", "opens the window with the model at the end, as wisp play does"},
          {"seed", Kind::kInteger, "N", "1", "of all chance"},
      },
      {{"wisp demo candle.mp4", "A film of a candle to a living model, in out/demo"},
       {"wisp demo", "The same without a camera: the candle is simulated"}},
      run,
  };
}

}  // namespace wisp::cli
