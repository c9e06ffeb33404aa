// `wisp play`: plays a model live in a window.

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "commands/commands.hpp"
#include "terminal.hpp"
#include "wisp/model/file.hpp"
#ifdef WISP_HAS_PLAYER
#include "window/window.hpp"
#endif

namespace wisp::cli {
namespace {

#ifdef WISP_HAS_PLAYER

namespace fs = std::filesystem;
using window::PlayOptions;
using window::PlayReport;
using window::SceneKind;

// Model listed first, as on the web page: a flame learned with the default recipe.
constexpr const char* kFirst = "flame.wisp";

// Returns the rank in the list of models: kFirst, falling bodies, other outlines, then plain models.
int rank(const fs::path& path, const View& view) {
  if (path.filename() == kFirst) return 0;
  if (std::holds_alternative<PlainView>(view)) return 3;
  return std::holds_alternative<OutlineView>(view) ? 2 : 1;
}

std::vector<fs::path> models_in(const fs::path& folder) {
  std::vector<std::pair<int, fs::path>> found;
  std::error_code code;
  for (const auto& entry : fs::directory_iterator(folder, code)) {
    if (entry.path().extension() != ".wisp") continue;
    if (const auto model = read_model(entry.path())) found.push_back({rank(entry.path(), model->view), entry.path()});
  }
  std::sort(found.begin(), found.end());
  std::vector<fs::path> paths;
  paths.reserve(found.size());
  for (auto& [order, path] : found) paths.push_back(path);
  return paths;
}

// Returns the folders searched for models, in this order: $WISP_MODELS; share/wisp/models beside the installed program;
// the source tree of the build; out/demo, where `wisp demo` writes its model.
std::vector<fs::path> model_folders() {
  std::vector<fs::path> folders;
  if (const char* named = std::getenv("WISP_MODELS")) folders.emplace_back(named);
  std::error_code code;
  const fs::path program = fs::read_symlink("/proc/self/exe", code);
  if (!code) folders.push_back(program.parent_path().parent_path() / "share/wisp/models");
  folders.emplace_back(WISP_MODELS_FOLDER);
  folders.emplace_back("out/demo");
  return folders;
}

// Returns the models of the first folder that has any, by rank and then by name. Skips files that are no models.
std::vector<fs::path> shipped_models() {
  for (const fs::path& folder : model_folders()) {
    if (auto models = models_in(folder); !models.empty()) return models;
  }
  return {};
}

// Number of the signal received, or 0. The player finishes its frame before it stops, so that pictures are complete.
volatile int interrupted = 0;

void interrupt(int signal) { interrupted = signal; }

Result<void> set_size(const std::string& text, window::PlayerOptions& player) {
  int width = 0, height = 0;
  char end = 0;
  if (std::sscanf(text.c_str(), "%5dx%5d%c", &width, &height, &end) != 2 || width < 64 || height < 64 || width > 8192 ||
      height > 8192) {
    return Error{"--size: found \"" + text + "\", expected WIDTHxHEIGHT in pixels, each 64 to 8192, such as 1280x800"};
  }
  player.width = width;
  player.height = height;
  return {};
}

std::optional<SceneKind> scene_of(const Arguments& arguments) {
  if (!arguments.has("scene")) return {};
  const std::string& word = arguments.text("scene");
  return word == "candle" ? SceneKind::kCandle : word == "cake" ? SceneKind::kCake : SceneKind::kLeaves;
}

// Returns the models that come with Wisp, beginning with those that the scene can show. Errors: no model is found.
Result<std::vector<std::filesystem::path>> models_of_our_own(std::optional<SceneKind> scene) {
  auto models = shipped_models();
  if (models.empty()) {
    std::string looked;
    for (const auto& folder : model_folders()) looked += (looked.empty() ? "" : ", ") + folder.string();
    return Error{"no model was given and none is in " + looked +
                 "; name one, wisp play MODEL.wisp, or make one with wisp demo"};
  }
  if (!scene) return models;
  const auto fits = [&](const std::filesystem::path& path) {
    const auto model = read_model(path);
    const bool flame = model && std::holds_alternative<OutlineView>(model->view);
    const bool plain = model && std::holds_alternative<PlainView>(model->view);
    return *scene == SceneKind::kLeaves ? model && !flame && !plain : flame;
  };
  std::stable_partition(models.begin(), models.end(), fits);
  return models;
}

Result<PlayOptions> options_of(const Arguments& arguments) {
  PlayOptions options;
  options.player.scene = scene_of(arguments);
  options.player.seed = static_cast<std::uint64_t>(arguments.integer("seed"));
  if (auto ok = set_size(arguments.text("size"), options.player); !ok) return ok.error();
  options.microphone = !arguments.has("sound") || arguments.text("sound") != "none";
  if (arguments.has("sound") && options.microphone) options.sound = arguments.text("sound");
  if (arguments.has("script")) options.script = arguments.text("script");
  if (arguments.has("png")) options.pictures = arguments.text("png");
  options.interrupted = &interrupted;
  options.player.hints = !options.script && !arguments.has("frames");
  if (arguments.has("frames")) {
    options.frames = arguments.integer("frames");
    if (options.frames < 1) return Error{"--frames: found \"0\", expected at least 1"};
  } else if (options.pictures && !options.script) {
    return Error{"--png: pictures are taken by --frames N, or by a --script that says when"};
  }
  if (!arguments.positionals().empty()) {
    options.player.models = {arguments.positional()};
  } else {
    auto models = models_of_our_own(options.player.scene);
    if (!models) return models.error();
    options.player.models = std::move(*models);
  }
  return options;
}

void tell(const PlayReport& report, const PlayOptions& options, Terminal& terminal) {
  const auto& figures = report.figures;
  terminal.add("model", options.player.models.front().string());
  terminal.add("seed", options.player.seed);
  terminal.add("frames", figures.frames);
  terminal.add("went_out", figures.went_out);
  terminal.add("relit", figures.relit);
  terminal.add("held_share",
               figures.steps ? static_cast<double>(figures.clamped) / static_cast<double>(figures.steps) : 0.0);
  terminal.add("frame_ms.mean", report.draw_ms);
  terminal.add("frame_ms.worst", report.worst_draw_ms);
  if (!report.renderer.empty()) terminal.add("renderer", report.renderer);
  terminal.add("state", report.state);
  terminal.add("said", ReportList(report.said.begin(), report.said.end()));
  ReportTable pictures{"pictures", "", {{"name", ""}, {"frame", ""}, {"state", ""}}, {}};
  for (const auto& picture : report.pictures) pictures.rows.push_back({picture.name, picture.frame, picture.state});
  terminal.add(std::move(pictures));
  terminal.say(std::to_string(report.figures.frames) + " frames, " + shown(report.draw_ms) +
               " ms of the processor each; seed " + std::to_string(options.player.seed));
  if (!report.pictures.empty())
    terminal.say("wrote " + std::to_string(report.pictures.size()) + " pictures to " + options.pictures->string());
}

Result<void> run_play(const Arguments& arguments, Terminal& terminal) {
  const auto options = options_of(arguments);
  if (!options) return options.error();
  std::signal(SIGINT, interrupt);
  std::signal(SIGTERM, interrupt);
  const auto report = options->frames > 0 ? window::play_without_display(*options) : window::play_in_window(*options);
  if (!report) return report.error();
  for (const std::string& line : report->said) terminal.warn(line);
  tell(*report, *options, terminal);
  if (interrupted == 0 || options->frames == 0) return {};
  // Not all requested frames were drawn: the exit status reports the signal, as in other programs.
  terminal.finish();
  std::fflush(stdout);
  std::signal(interrupted, SIG_DFL);
  std::raise(interrupted);
  return {};
}

#else

Result<void> run_play(const Arguments&, Terminal&) {
  return Error{"this build has no window: it was made with -DWISP_BUILD_WINDOW=OFF"};
}

#endif

}  // namespace

Command play_command() {
  return {
      "play",
      "A model, live, in a window: blow into the microphone, move the pointer, press H for help.",
      {{"MODEL", "the model, a .wisp file; default: those that come with Wisp, Tab goes from one to the next", false,
        true}},
      {
          {"scene",
           Kind::kChoice,
           "WORD",
           "",
           "candle, cake or leaves; default: what the model is",
           {"candle", "cake", "leaves"}},
          {"size", Kind::kText, "WxH", "1280x800", "of the window, or of pictures without one"},
          {"sound", Kind::kPath, "FILE", "", "a sound file in place of the microphone; none: it is off, M turns it on"},
          {"frames", Kind::kInteger, "N", "", "no window: N frames of 1/60 s, the same for the same seed"},
          {"png", Kind::kOutput, "DIR", "", "the folder for pictures: every frame, or those that --script takes"},
          {"script", Kind::kPath, "FILE", "",
           "events with times, as docs/reference/window.md describes, in place of a person"},
          {"seed", Kind::kInteger, "N", "1", "of all chance"},
      },
      {
          {"wisp play", "A candle that you blow out; Tab: leaves"},
          {"wisp play out/demo/flame.wisp --scene cake", "A cake, its flames learned from your clip"},
          {"wisp play flame.wisp --sound breath.wav --frames 300 --png frames",
           "What a recorded breath does to it, as 300 pictures, without a window"},
      },
      run_play,
  };
}

}  // namespace wisp::cli
