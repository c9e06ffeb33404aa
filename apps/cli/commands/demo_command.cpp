// `wisp demo`: capture, learning and validation in one command, by the commands that a user would type.

#include <algorithm>
#include <array>
#include <cctype>
#include <cstring>
#include <filesystem>
#include <utility>

#include "commands/commands.hpp"
#include "flags/capture_flags.hpp"
#include "terminal.hpp"
#include "wisp/base/file.hpp"
#include "wisp/describe/json.hpp"
#include "wisp/draw/flame.hpp"
#include "wisp/model/file.hpp"

namespace wisp::cli {
namespace {

namespace fs = std::filesystem;

// Converts a step's report to a part of the summary: the step's name prefixes the ids of its figures and tables.
Report part_of_whole(const std::string& name, const std::string& line, Report step) {
  step.add("").entries = {{"command", "wisp " + line, "", ""},
                          {"warnings", ReportList(step.warnings.begin(), step.warnings.end()), "", ""}};
  if (step.verdict) {
    step.add("").entries = {{"usable.verdict", step.verdict->usable, "", ""},
                            {"usable.reason", step.verdict->reason, "", ""}};
  }
  step.verdict.reset();
  step.warnings.clear();
  for (ReportSection& section : step.sections) {
    for (ReportTable& table : section.tables) table.id = name + "." + table.id;
    for (ReportEntry& entry : section.entries) {
      if (!entry.id.empty()) entry.id = name + "." + entry.id;
    }
  }
  return step;
}

struct Places {
  fs::path folder;
  std::string at(const char* name) const { return (folder / name).string(); }
};

// Returns a file name for the shell, quoted if necessary.
std::string quoted(const std::string& name) {
  const auto plain = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || std::strchr("/._-+=:,@%", c) != nullptr;
  };
  if (!name.empty() && std::all_of(name.begin(), name.end(), plain)) return name;
  std::string text = "'";
  for (const char c : name) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

// A command with its arguments and flags; other flags have their defaults.
struct Step {
  std::string name;  // prefix of the step's figures in the summary
  Command command;
  std::vector<std::string> files;
  std::vector<std::pair<std::string, std::string>> flags;
};

// Returns the command line that runs a step by hand.
std::string line_of(const Step& step) {
  std::string line = step.command.name;
  for (const std::string& file : step.files) line += " " + quoted(file);
  for (const auto& [flag, value] : step.flags) line += (flag == "output" ? " -o " : " --" + flag + " ") + quoted(value);
  return line;
}

Result<void> run(const Step& step, Terminal& terminal) {
  const std::string line = line_of(step);
  terminal.say("\n$ wisp " + line);
  Arguments arguments;
  for (const Flag& flag : step.command.flags) {
    if (!flag.fallback.empty()) arguments.set_default(flag.name, flag.fallback);
  }
  for (const auto& [flag, value] : step.flags) arguments.set(flag, value);
  arguments.set_positionals(step.files);
  Report all = std::exchange(terminal.result(), {});
  terminal.begin();
  auto outcome = check_outputs(step.command, arguments);
  if (outcome) outcome = step.command.run(arguments, terminal);
  const auto verdict = terminal.result().verdict;
  all.append(part_of_whole(step.name, line, std::move(terminal.result())));
  terminal.result() = std::move(all);
  if (!outcome || step.name != "capture" || !verdict || verdict->usable) return outcome;
  return Error{step.files.front() + ": no flame is learned from it: " + verdict->reason};
}

// Flags of capture accepted by the demo.
constexpr std::array kCaptureFlags{"points", "channel", "flame", "region", "frames", "rate"};

struct Clips {
  std::string learn;
  std::string validate;
};

Result<Clips> simulate_clips(const Places& places, int seed, Terminal& terminal) {
  const Clips clips{places.at("training.mp4"), places.at("validation.mp4")};
  const auto simulate = [&](const char* name, const std::string& clip, const char* seconds, int own_seed) {
    const std::string number = std::to_string(own_seed);
    return run({name, simulate_candle_command(), {}, {{"output", clip}, {"seconds", seconds}, {"seed", number}}},
               terminal);
  };
  if (auto ok = simulate("simulate_training", clips.learn, "40", seed); !ok) return ok.error();
  if (auto ok = simulate("simulate_validation", clips.validate, "20", seed + 1); !ok) return ok.error();
  return clips;
}

Result<void> all_steps(const Places& places, const Clips& clips, const Arguments& arguments, Terminal& terminal) {
  const std::string recording = places.at("recording.csv"), path = places.at("flame.wisp");
  Step capture{"capture", capture_flame_command(), {clips.learn}, {{"output", recording}}};
  Step validate{"validate",
                validate_command(),
                {path, clips.validate},
                {{"overlay", places.at("overlay.mp4")},
                 {"film-strip", places.at("film-strip.png")},
                 {"figures", places.at("figures")}}};
  for (const std::string flag : kCaptureFlags) {
    if (!arguments.has(flag)) continue;
    capture.flags.push_back({flag, arguments.text(flag)});
    if (flag != "points") validate.flags.push_back(capture.flags.back());  // validate takes the number from the model
  }
  if (auto ok = run(capture, terminal); !ok) return ok;
  if (auto ok = run({"learn", learn_flame_command(), {recording}, {{"output", path}}}, terminal); !ok) return ok;
  if (auto ok = run(validate, terminal); !ok) return ok;
  const auto model = read_model(path);
  if (!model) return model.error();
  const std::string frames = std::to_string(std::max(1, static_cast<int>(20 * model->rate_hz)));
  Step film{"run", run_command(), {path}, {{"output", places.at("flame.mp4")}, {"frames", frames}}};
  if (!model->inputs.empty()) film.flags.push_back({"input", recording});
  // Draws on the clip's own candle, unless capture found none (a flame on black).
  const auto seen = [](const Figure& figure) { return figure.name == kCandleFigures[0]; };
  if (is_flame(*model) && std::ranges::any_of(model->training.figures, seen)) film.flags.push_back({"clip", recording});
  return run(film, terminal);
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
  terminal.say("  wisp run " + quoted(places.at("flame.wisp")) +
               " --frames 600 --instances 5 -o cake.mp4   five candles");
  terminal.say("  wisp info " + quoted(places.at("flame.wisp")) +
               "             what the file holds and what a frame costs");
  terminal.say("  wisp play " + quoted(places.at("flame.wisp")) + "             blow on it, live, in a window");
  terminal.say("  script/web serve                      the same in a browser; drop flame.wisp onto the page");
}

// Runs the demo into an existing folder.
Result<void> fill(const Places& places, const Arguments& arguments, Terminal& terminal) {
  Clips clips;
  if (arguments.positionals().empty()) {
    auto simulated = simulate_clips(places, arguments.integer("seed"), terminal);
    if (!simulated) return simulated.error();
    clips = *simulated;
  } else {
    clips = {arguments.positional(), arguments.positional()};
  }
  if (auto ok = all_steps(places, clips, arguments, terminal); !ok) return ok;
  if (auto ok = write_file(places.at("summary.json"), to_json(terminal.result(), 1) + "\n"); !ok) return ok;
  say_what_next(places, terminal);
  if (!arguments.on("window")) return {};
  return run({"play", play_command(), {places.at("flame.wisp")}, {}}, terminal);
}

// Returns the outermost missing folder of a path; empty if all exist.
fs::path first_missing(fs::path folder) {
  fs::path missing;
  std::error_code ignored;
  for (; !folder.empty() && !fs::exists(folder, ignored); folder = folder.parent_path()) missing = folder;
  return missing;
}

Result<void> run_demo(const Arguments& arguments, Terminal& terminal) {
  const Places places{arguments.text("output")};
  const fs::path missing = first_missing(places.folder);
  std::error_code code;
  fs::create_directories(places.folder, code);
  if (code) return Error{places.folder.string() + ": cannot be made: " + code.message()};
  auto filled = fill(places, arguments, terminal);
  if (!filled && !missing.empty()) {
    // On failure, removes those of the folders just created that are empty.
    for (fs::path folder = places.folder; fs::remove(folder, code) && folder != missing;) folder = folder.parent_path();
  }
  return filled;
}

}  // namespace

Command demo_command() {
  std::vector<Flag> flags{
      {"output",
       Kind::kOutput,
       "DIR",
       "out/demo",
       "the folder for all that is made",
       {},
       false,
       {},
       {"recording.csv", "flame.wisp", "overlay.mp4", "film-strip.png", "flame.mp4", "summary.json"}}};
  for (Flag& flag : capture_flags("1")) {
    if (std::find(kCaptureFlags.begin(), kCaptureFlags.end(), flag.name) != kCaptureFlags.end())
      flags.push_back(std::move(flag));
  }
  flags.push_back({"window", Kind::kSwitch, "", "", "opens the window with the model at the end, as wisp play does"});
  flags.push_back({"seed", Kind::kInteger, "N", "1", "of all chance"});
  return {
      "demo",
      "The whole job: from a clip of a flame to a model and its pictures. Without a clip it simulates one.",
      {{"CLIP", "a video of a flame, or a folder of numbered images", false, true}},
      std::move(flags),
      {{"wisp demo candle.mp4", "A film of a candle to a living model, in out/demo"},
       {"wisp demo candle.mp4 --region 300,100,200,400", "Looking only at one of the candles"},
       {"wisp demo", "The same without a camera: the candle is simulated"}},
      run_demo,
  };
}

}  // namespace wisp::cli
