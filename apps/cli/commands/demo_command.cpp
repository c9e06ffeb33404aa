// `wisp demo`: the whole job, with the commands that would do it by hand.

#include <algorithm>
#include <array>
#include <cctype>
#include <cstring>
#include <filesystem>
#include <functional>
#include <utility>

#include "commands/commands.hpp"
#include "films/simulated_clip.hpp"
#include "films/validation_pictures.hpp"
#include "flags/capture_flags.hpp"
#include "reports/learned_model.hpp"
#include "terminal.hpp"
#include "wisp/base/file.hpp"
#include "wisp/capture/capture.hpp"
#include "wisp/describe/json.hpp"
#include "wisp/learn/learn.hpp"
#include "wisp/model/file.hpp"
#include "wisp/record/csv.hpp"

namespace wisp::cli {
namespace {

namespace fs = std::filesystem;

// A step's result as a part of the whole: under its name.
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

// Does one step of the demo below the line that would do it by hand; its figures go into the result under `name`.
Result<void> step(const std::string& name, const std::string& line, Terminal& terminal,
                  const std::function<Result<void>()>& work) {
  terminal.say("\n$ wisp " + line);
  Report all = std::exchange(terminal.result(), {});
  auto outcome = work();
  all.append(part_of_whole(name, line, std::move(terminal.result())));
  terminal.result() = std::move(all);
  return outcome;
}

struct Places {
  fs::path folder;
  std::string at(const char* name) const { return (folder / name).string(); }
};

// A name as a shell takes it.
std::string quoted(const std::string& name) {
  const auto plain = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || std::strchr("/._-+=:,@%", c) != nullptr;
  };
  if (!name.empty() && std::all_of(name.begin(), name.end(), plain)) return name;
  std::string text = "'";
  for (const char c : name) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

// Flags of capture that the demo takes, and those of them that were given, as words.
constexpr std::array kCaptureFlags{"points", "channel", "flame", "region", "frames", "rate"};

std::string capture_words(const Arguments& arguments) {
  std::string words;
  for (const char* flag : kCaptureFlags) {
    if (arguments.has(flag)) words += " --" + std::string(flag) + " " + quoted(arguments.text(flag));
  }
  return words;
}

// What the model is learned from, and what it is validated on.
struct Clips {
  std::string learn;
  std::string validate;
};

Result<void> simulate(const std::string& path, double seconds, std::uint64_t seed, Terminal& terminal) {
  CandleClipOptions options;
  options.seconds = seconds;
  options.wind.seed = options.microphone.seed = options.camera.seed = seed;
  const auto truth = write_simulated_clip(path, options, terminal);
  if (!truth) return truth.error();
  terminal.add("frames", truth->rows());
  return {};
}

Result<Clips> simulate_clips(const Places& places, std::uint64_t seed, Terminal& terminal) {
  const Clips clips{places.at("training.mp4"), places.at("validation.mp4")};
  const auto one = [&](const std::string& name, const std::string& path, int seconds, std::uint64_t clip_seed) {
    const std::string line = "simulate candle -o " + quoted(path) + " --seconds " + std::to_string(seconds) +
                             " --seed " + std::to_string(clip_seed);
    return step(name, line, terminal, [&] { return simulate(path, seconds, clip_seed, terminal); });
  };
  if (auto ok = one("simulate_training", clips.learn, 40, seed); !ok) return ok.error();
  if (auto ok = one("simulate_validation", clips.validate, 20, seed + 1); !ok) return ok.error();
  return clips;
}

Result<Recording> capture_step(const Places& places, const std::string& clip, const ClipCapture& options,
                               const std::string& words, Terminal& terminal) {
  const std::string path = places.at("recording.csv");
  Recording recording;
  const std::string line = "capture flame " + quoted(clip) + " -o " + quoted(path) + words;
  auto ok = step("capture", line, terminal, [&]() -> Result<void> {
    auto captured = capture(clip, options, terminal.progress());
    if (!captured) return captured.error();
    terminal.show(captured->report);
    recording = std::move(captured->recording);
    if (auto written = write_csv(path, recording); !written) return written;
    const auto& verdict = captured->report.verdict;
    if (!verdict || verdict->usable) return {};
    return Error{clip + ": no flame is learned from it: " + verdict->reason};
  });
  if (!ok) return ok.error();
  return recording;
}

Result<Model> learn_step(const Places& places, const Recording& recording, Terminal& terminal) {
  const std::string path = places.at("flame.wisp");
  Model model;
  auto ok = step("learn", "learn flame " + quoted(places.at("recording.csv")) + " -o " + quoted(path), terminal,
                 [&]() -> Result<void> {
                   FlameRecipe recipe;
                   recipe.name = "flame";
                   auto fit = learn(recording, recipe, terminal.progress());
                   if (!fit) return fit.error();
                   model = std::move(fit->model);
                   terminal.show(fit->report);
                   return write_model(path, model);
                 });
  if (!ok) return ok.error();
  return model;
}

Result<void> validate(const Places& places, const Clips& clips, const Model& model, ClipCapture options,
                      Terminal& terminal) {
  const auto curve = curve_of(model);
  if (!curve) return curve.error();
  options.curve = *curve;
  auto captured = capture(clips.validate, options, terminal.progress());
  if (!captured) return captured.error();
  for (const std::string& warning : captured->report.warnings) terminal.warn(warning);
  const auto found = validate_outline(model, captured->recording, {}, terminal.progress());
  if (!found) return found.error();
  terminal.show(found->report);
  ValidationSubject subject{
      std::move(captured->recording), {clips.validate, options.rate_hz}, std::move(captured->report)};
  if (options.frames) subject.clip.first_frame = static_cast<std::size_t>(options.frames->first - 1);
  return draw_validation(*found, model, subject,
                         {places.at("overlay.mp4"), places.at("film-strip.png"), places.at("figures")}, terminal);
}

Result<void> validate_step(const Places& places, const Clips& clips, const Model& model, const ClipCapture& options,
                           const std::string& words, Terminal& terminal) {
  const std::string line = "validate " + quoted(places.at("flame.wisp")) + " " + quoted(clips.validate) + words +
                           " --overlay " + quoted(places.at("overlay.mp4")) + " --film-strip " +
                           quoted(places.at("film-strip.png")) + " --figures " + quoted(places.at("figures"));
  return step("validate", line, terminal, [&] { return validate(places, clips, model, options, terminal); });
}

// A command with its defaults and these flags.
Result<void> run_command_with(const Command& command, const std::vector<std::pair<std::string, std::string>>& flags,
                              const std::string& model, Terminal& terminal) {
  Arguments arguments;
  for (const Flag& flag : command.flags) {
    if (!flag.fallback.empty()) arguments.set(flag.name, flag.fallback);
  }
  for (const auto& [name, value] : flags) arguments.set(name, value);
  arguments.set_positionals({model});
  return command.run(arguments, terminal);
}

Result<void> film_step(const Places& places, const Model& model, Terminal& terminal) {
  const std::string frames = std::to_string(std::max(1, static_cast<int>(20 * model.rate_hz)));
  std::vector<std::pair<std::string, std::string>> flags{{"frames", frames}, {"output", places.at("flame.mp4")}};
  if (!model.inputs.empty()) flags.push_back({"input", places.at("recording.csv")});
  std::string line = "run " + quoted(places.at("flame.wisp")) + " --frames " + frames;
  if (!model.inputs.empty()) line += " --input " + quoted(places.at("recording.csv"));
  return step("run", line + " -o " + quoted(places.at("flame.mp4")), terminal,
              [&] { return run_command_with(run_command(), flags, places.at("flame.wisp"), terminal); });
}

Result<void> all_steps(const Places& places, const Clips& clips, const Arguments& arguments, Terminal& terminal) {
  const auto options = capture_options(arguments);
  if (!options) return options.error();
  const std::string words = capture_words(arguments);
  const auto recording = capture_step(places, clips.learn, *options, words, terminal);
  if (!recording) return recording.error();
  const auto model = learn_step(places, *recording, terminal);
  if (!model) return model.error();
  if (auto ok = validate_step(places, clips, *model, *options, words, terminal); !ok) return ok;
  return film_step(places, *model, terminal);
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

// All of the demo, into a folder that is there.
Result<void> fill(const Places& places, const Arguments& arguments, Terminal& terminal) {
  Clips clips;
  if (arguments.positionals().empty()) {
    auto simulated = simulate_clips(places, static_cast<std::uint64_t>(arguments.integer("seed")), terminal);
    if (!simulated) return simulated.error();
    clips = *simulated;
  } else {
    clips = {arguments.positional(), arguments.positional()};
  }
  if (auto ok = all_steps(places, clips, arguments, terminal); !ok) return ok;
  if (auto ok = write_file(places.at("summary.json"), to_json(terminal.result(), 1) + "\n"); !ok) return ok;
  say_what_next(places, terminal);
  if (!arguments.on("window")) return {};
  return step("play", "play " + quoted(places.at("flame.wisp")), terminal,
              [&] { return run_command_with(play_command(), {}, places.at("flame.wisp"), terminal); });
}

// The outermost of a folder and those that it lies in that is not there; empty where all are.
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
    // What was made for it goes, as long as nothing is in it.
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
