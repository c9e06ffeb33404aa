// `wisp run`: plays a model as numbers, as a picture, or as a film.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "commands/commands.hpp"
#include "films/candle_pictures.hpp"
#include "films/leaf_film.hpp"
#include "films/looped.hpp"
#include "flags/recipe_flags.hpp"
#include "flags/recordings.hpp"
#include "flags/wind_input.hpp"
#include "terminal.hpp"
#include "wisp/capture/capture.hpp"
#include "wisp/describe/text.hpp"
#include "wisp/draw/flame.hpp"
#include "wisp/draw/plot.hpp"
#include "wisp/draw/video_writer.hpp"
#include "wisp/model/file.hpp"
#include "wisp/record/csv.hpp"
#include "wisp/run/bank.hpp"
#include "wisp/run/chain_facet.hpp"
#include "wisp/run/extinction_facet.hpp"

namespace wisp::cli {
namespace {

constexpr double kReach = 4;  // maximum reach of steering, in standard deviations of unsteered walks

// Parses a target of steering, X,Y,Z@S: a position in metres, and the seconds until the walk is to be there.
Result<SteerTarget> target_from(const std::string& text) {
  SteerTarget target;
  double seconds = 0;
  char rest = 0;
  const int found = std::sscanf(text.c_str(), "%f,%f,%f@%lf%c", &target.position[0], &target.position[1],
                                &target.position[2], &seconds, &rest);
  bool sound = found == 4 && seconds > 0 && seconds <= 10'000;
  for (float x : target.position) sound &= std::abs(x) < 1e6F;
  if (!sound) {
    return Error{"--steer: found \"" + text +
                 "\", expected X,Y,Z@S: three numbers in metres and seconds above 0, such as 1,0.5,-6@8"};
  }
  target.in = std::chrono::nanoseconds(std::llround(seconds * 1e9));
  return target;
}

// Parses --steer, the target of a chain's walk; empty without the flag.
// Errors: a model that cannot be steered; text of another form; a number out of range.
Result<std::optional<SteerTarget>> steer_target_from(const Model& model, const Arguments& arguments) {
  if (!arguments.has("steer")) return std::optional<SteerTarget>();
  const auto* chain = std::get_if<ChainModel>(&model.dynamics);
  if (!chain) return Error{"--steer is for segment chains, which this model is not"};
  auto target = target_from(arguments.text("steer"));
  if (!target) return target.error();
  if (!chain->drift)
    return Error{"the model can't be steered: it does not say where its segments lead; learn it again"};
  return std::optional(*target);
}

// Warns of a target farther from the mean fall than kReach standard deviations of unsteered walks.
void warn_of_target(const Model& model, const std::optional<SteerTarget>& target, Terminal& terminal) {
  if (!target) return;
  const ChainDrift& drift = *std::get<ChainModel>(model.dynamics).drift;
  const double seconds = std::chrono::duration<double>(target->in).count();
  const auto& to = target->position;
  const auto beyond = [&](std::size_t axis) { return to[axis] - drift.drift[axis] * seconds; };
  const double reach_ground = kReach * std::sqrt(2 * drift.spread_ground * seconds) + target->near;
  const double reach_height = kReach * std::sqrt(drift.spread_height * seconds) + target->near;
  const double away = std::hypot(beyond(0), beyond(1)), off_height = std::abs(beyond(2));
  if (away <= reach_ground && off_height <= reach_height) return;
  terminal.warn("--steer: the target lies out of reach: after " + shown(seconds, 3) + " s falls are " +
                shown(-drift.drift[2] * seconds, 3) + " m lower, give or take " + shown(reach_height, 2) +
                " m, and within " + shown(reach_ground, 2) + " m over ground; what is out of reach is not reached");
}

// Steers every living instance to the target, if there is one.
void steer_all(const std::optional<SteerTarget>& target, Bank& bank) {
  ChainFacet* chain = bank.chain();
  if (!chain || !target) return;
  for (int slot = 0; slot < bank.slots(); ++slot) chain->steer(bank.at(slot), *target);
}

constexpr double kMaxNumbers = 5e8;  // maximum inputs and outputs of a run, over all frames: 4 GB in memory

struct Play {
  Model model;
  InputTrack input;
  std::size_t frames = 0;
  std::uint64_t seed = 1;
  Camera camera;                      // --camera, for a flame played as a body
  double orbit = 0;                   // seconds per revolution of the camera; 0: fixed
  double toward = 0;                  // degrees: wind blows to the right of a camera at this azimuth
  std::vector<std::size_t> relit;     // frames before which all extinguished instances are lit again, ascending
  std::optional<FilmedFlame> film{};  // film on whose candle the flame is drawn
};

// Steps a bank frame by frame: relights, sets the inputs, and records extinctions.
class Player {
 public:
  Player(const Play& play, Bank& bank) : play_(play), bank_(bank), burnt_(bank.size(), true) {}

  std::vector<float> step() {
    ExtinctionFacet* extinction = bank_.extinction();
    if (extinction && std::binary_search(play_.relit.begin(), play_.relit.end(), frame_)) {
      for (int slot = 0; slot < bank_.slots(); ++slot) extinction->relight(bank_.at(slot));
    }
    std::vector<float> inputs = turned(play_.input.at(frame_));
    bank_.set_common_inputs(inputs);
    bank_.step();
    for (int slot = 0; extinction && slot < bank_.slots(); ++slot) note(*extinction, slot);
    ++frame_;
    return inputs;
  }

  bool burns(int slot) const { return burnt_[slot]; }

  // Returns the wind that carries smoke: the input of the extinction rule; of a body, the wind to the camera's right.
  float wind(const std::vector<float>& inputs) const {
    const auto& rule = play_.model.extinction;
    if (!rule) return 0.0F;
    return bank_.body() ? to_the_right(camera(), inputs[0], inputs[1]) : inputs[rule->input];
  }

  Camera camera() const {
    Camera camera = play_.camera;
    if (play_.orbit > 0) camera.azimuth += 360 * static_cast<double>(frame_) / (play_.orbit * play_.model.rate_hz);
    return camera;
  }

  // Returns the table of extinctions: instance and frame.
  const ReportTable& deaths() const { return deaths_; }

 private:
  // Splits a scalar wind into a body's two components by --wind-direction; other inputs stay as they are.
  std::vector<float> turned(std::vector<float> inputs) const {
    if (inputs.size() != 1 || bank_.input_count() != 2) return inputs;
    const double angle = play_.toward * 3.14159265358979323846 / 180;
    return {static_cast<float>(inputs[0] * std::cos(angle)), static_cast<float>(-inputs[0] * std::sin(angle))};
  }

  void note(const ExtinctionFacet& extinction, int slot) {
    const bool lit = extinction.state_of(bank_.at(slot))->lit;
    if (burnt_[slot] && !lit) deaths_.rows.push_back({slot, frame_});
    burnt_[slot] = lit;
  }

  const Play& play_;
  Bank& bank_;
  std::vector<bool> burnt_;
  ReportTable deaths_{"went_out", "", {{"instance", ""}, {"frame", ""}}, {}};
  std::size_t frame_ = 0;
};

Result<Bank> make_bank(const Play& play, const std::optional<SteerTarget>& target, const Arguments& arguments) {
  const int instances = arguments.integer("instances");
  auto bank = Bank::create(play.model, {.capacity = instances, .seed = play.seed, .polyline_points = 96});
  if (!bank) return bank;
  bank->set_noise(arguments.text("noise") == "on" ? 1.0F : 0.0F);
  for (int k = 0; k < instances; ++k) bank->spawn();
  steer_all(target, *bank);
  return bank;
}

Recording record_run(const Play& play, const Bank& bank, Player& player) {
  Recording recording = played_channels(play.model, bank.size(), std::to_string(play.seed));
  for (int k = 0; play.model.extinction && k < bank.size(); ++k) {
    recording.flags.push_back({bank.size() == 1 ? "lit" : "i" + std::to_string(k) + ".lit", {}});
  }
  std::vector<float> outputs(static_cast<std::size_t>(bank.slots()) * bank.output_count());
  for (std::size_t frame = 0; frame < play.frames; ++frame) {
    const auto inputs = player.step();
    bank.outputs(outputs);
    std::size_t channel = 0;
    for (float input : inputs) recording.channels[channel++].samples.push_back(input);
    for (float output : outputs) recording.channels[channel++].samples.push_back(output);
    for (std::size_t k = 0; k < recording.flags.size(); ++k) {
      recording.flags[k].rows.push_back(player.burns(static_cast<int>(k)));
    }
  }
  return recording;
}

Result<void> write_film(const Play& play, const Bank& bank, Player& player, const std::string& path,
                        Terminal& terminal) {
  CandlePictures pictures(play.model, bank);
  if (play.film) pictures.draw_on(*play.film);
  auto film = VideoWriter::create(
      path, {.width = pictures.width(), .height = pictures.height(), .rate_hz = play.model.rate_hz});
  if (!film) return film.error();
  for (std::size_t frame = 0; frame < play.frames; ++frame) {
    pictures.blow(bank, player.wind(player.step()));
    if (auto ok = film->write(pictures.draw(bank, player.camera())); !ok) return ok;
    terminal.progress("drawing", static_cast<double>(frame + 1) / static_cast<double>(play.frames));
  }
  return film->finish();
}

Result<void> write_picture(const Play& play, const Bank& bank, Player& player, const std::string& path) {
  if (std::holds_alternative<OutlineView>(play.model.view)) {
    CandlePictures pictures(play.model, bank);
    if (play.film) pictures.draw_on(*play.film);
    for (std::size_t frame = 0; frame < play.frames; ++frame) pictures.blow(bank, player.wind(player.step()));
    return write_png(path, pictures.draw(bank, player.camera()));
  }
  const Recording recording = record_run(play, bank, player);
  Plot plot{.title = play.model.name, .x = {.label = "time, s"}, .y = {}};
  for (const Channel& channel : recording.channels) {
    PlotSeries series{.label = channel.name, .x = {}, .y = channel.samples};
    for (std::size_t row = 0; row < channel.samples.size(); ++row)
      series.x.push_back(static_cast<double>(row) / recording.rate_hz);
    plot.series.push_back(std::move(series));
  }
  return write_plots(path, {.title = "", .plots = {std::move(plot)}, .plot_width = 800});
}

Recording falls(const Play& play, const Bank& bank, Player& player) {
  return one_after_the_other(record_run(play, bank, player), play.model, bank.size(), std::to_string(play.seed));
}

Result<void> write_falls(const Play& play, const Bank& bank, Player& player, const std::string& path,
                         Terminal& terminal) {
  const auto& pose = std::get<PoseView>(play.model.view);
  LeafFilmOptions film{.max_seconds = static_cast<double>(play.frames) / play.model.rate_hz};
  // A leaf's long axis is the body's first axis, along which PoseView::half_width is measured.
  if (pose.half_width > 0) film.style.length = static_cast<float>(2 * pose.half_width);
  if (pose.half_length > 0) film.style.width = static_cast<float>(2 * pose.half_length);
  return write_leaf_film(path, falls(play, bank, player), film, terminal);
}

Result<void> write_run(const Play& play, const Bank& bank, Player& player, const std::string& path,
                       Terminal& terminal) {
  const std::string extension = std::filesystem::path(path).extension().string();
  if (extension == ".csv") {
    const bool bodies = are_bodies(play.model, bank.size());
    return write_csv(path, bodies ? falls(play, bank, player) : record_run(play, bank, player));
  }
  if (extension == ".png") return write_picture(play, bank, player, path);
  if (extension != ".mp4") return Error{path + ": cannot be written, expected a name that ends in .csv, .png or .mp4"};
  if (std::holds_alternative<PoseView>(play.model.view)) return write_falls(play, bank, player, path, terminal);
  if (!std::holds_alternative<OutlineView>(play.model.view)) {
    return Error{path + ": the model's outputs have no picture to film; write a .csv or a .png"};
  }
  return write_film(play, bank, player, path, terminal);
}

Result<std::vector<std::size_t>> relit_frames(const Model& model, const Arguments& arguments) {
  std::vector<std::size_t> frames;
  if (!arguments.has("relight")) return frames;
  if (!model.extinction)
    return Error{"the model never goes out, there is nothing to relight; learn it with --blow-out"};
  for (const std::string& word : arguments.names("relight")) {
    char* end = nullptr;
    const double seconds = std::strtod(word.c_str(), &end);
    if (word.empty() || *end != 0 || !(seconds >= 0 && seconds <= 1e6)) {
      return Error{"--relight: found \"" + word + "\", expected seconds from the start, separated by commas"};
    }
    frames.push_back(static_cast<std::size_t>(std::lround(seconds * model.rate_hz)));
  }
  std::sort(frames.begin(), frames.end());
  return frames;
}

// Warns of wind above the range of a chain's training, where its response is extrapolated and then clamped.
void warn_of_wind(const Play& play, Terminal& terminal) {
  if (!std::holds_alternative<ChainModel>(play.model.dynamics)) return;
  std::vector<float> most(play.model.inputs.size());
  for (std::size_t frame = 0; frame < play.frames; ++frame) {
    const auto inputs = play.input.at(frame);
    for (std::size_t k = 0; k < most.size(); ++k) most[k] = std::max(most[k], std::abs(inputs[k]));
  }
  for (std::size_t k = 0; k < most.size(); ++k) {
    const Input& input = play.model.inputs[k];
    const double learned = std::max(std::abs(input.lowest), std::abs(input.highest));
    const double clamped = learned + kRangeMargin * (input.highest - input.lowest);
    if (most[k] <= learned) continue;
    terminal.warn(input.name + " reaches " + shown(most[k], 3) + " " + input.unit +
                  ", and the model was learned up to " + shown(learned, 3) +
                  ": beyond that its response is a guess, and beyond " + shown(clamped, 3) + " it is clamped");
  }
}

// Checks the size of the data that a run holds until it is written.
Result<void> check_size(const Play& play, int instances) {
  const double columns =
      static_cast<double>(play.model.inputs.size()) + static_cast<double>(play.model.outputs.size()) * instances;
  if (static_cast<double>(play.frames) * columns <= kMaxNumbers) return {};
  return Error{"--frames " + std::to_string(play.frames) + " of " + std::to_string(instances) + " instances are " +
               shown(static_cast<double>(play.frames) * columns) + " numbers, expected at most " + shown(kMaxNumbers) +
               ": run it in parts with other seeds"};
}

// Applies --camera, --orbit and --wind-direction: converts the model to a body. Errors: a model without a body;
// a bad --camera or --orbit; --wind-direction alone.
Result<void> go_round(const Arguments& arguments, Play& play) {
  if (arguments.number("orbit") < 0)
    return Error{"--orbit: found " + arguments.text("orbit") + ", expected seconds above 0"};
  if (!arguments.has("camera") && arguments.number("orbit") == 0) {
    return refuse(arguments, {"wind-direction"}, "is of a flame seen from all sides: give --camera or --orbit too");
  }
  auto round = in_the_round(play.model);
  if (!round) return round.error();
  play.model = *std::move(round);
  play.toward = arguments.number("wind-direction");
  play.orbit = arguments.number("orbit");
  if (!arguments.has("camera")) return {};
  Camera& camera = play.camera;
  char comma = ',', end = 0;
  const int found =
      std::sscanf(arguments.text("camera").c_str(), "%lf%c%lf%c", &camera.azimuth, &comma, &camera.elevation, &end);
  const bool good = (found == 1 || found == 3) && comma == ',' && std::abs(camera.azimuth) <= 3600;
  if (good && std::abs(camera.elevation) <= 80) return {};
  return Error{"--camera: found \"" + arguments.text("camera") +
               "\", expected degrees round the flame, and degrees above the level up to 80, as 45 or 45,20"};
}

Result<Play> prepare(const Arguments& arguments) {
  auto model = read_model(arguments.positional());
  if (!model) return model.error();
  auto input = InputTrack::from(*model, arguments);
  if (!input) return input.error();
  auto relit = relit_frames(*model, arguments);
  if (!relit) return relit.error();
  Play play{std::move(*model), std::move(*input), 0, static_cast<std::uint64_t>(arguments.integer("seed")), {}, 0, 0,
            std::move(*relit)};
  if (auto ok = go_round(arguments, play); !ok) return ok.error();
  play.frames = arguments.has("frames") ? static_cast<std::size_t>(arguments.integer("frames")) : play.input.rows();
  if (play.frames == 0)
    return Error{"--frames is 0 or not given: give at least 1, or --input with a recording that says how many"};
  if (auto ok = check_size(play, arguments.integer("instances")); !ok) return ok.error();
  return play;
}

// Learns the look of the candle in the film of --clip, on which the flame is drawn.
Result<void> watch_film(const Arguments& arguments, Terminal& terminal, Play& play) {
  if (!arguments.has("clip")) return {};
  const std::string &path = arguments.text("clip"), &out = arguments.text("output");
  auto beside = refuse(arguments, {"camera", "orbit", "instances"},
                       "does not go with --clip: a film's candle carries one flame, seen from where it was filmed");
  if (!beside) return beside;
  if (out.ends_with(".csv")) return Error{"--clip draws pictures, and " + out + " has numbers; expected .png or .mp4"};
  if (!is_flame(play.model))
    return Error{"--clip draws a flame, and " + arguments.positional() + " is not one's model"};
  const auto curve = curve_of(play.model);
  if (!curve) return curve.error();
  const auto captured_from = [&]() -> Result<Recording> {
    if (is_table(path)) return read_csv(path);
    const double rate_hz = std::filesystem::is_directory(path) ? play.model.rate_hz : 0;
    auto captured = capture(path, {.flame = 1, .rate_hz = rate_hz, .curve = *curve}, terminal.progress());
    if (!captured) return captured.error();
    const ReportVerdict& verdict = *captured->report.verdict;
    if (!verdict.usable) return Error{path + ": its flame is not found: " + verdict.reason};
    return std::move(captured->recording);
  };
  const auto recording = captured_from();
  if (!recording) return recording.error();
  if (would_destroy(out, std::string(find_attribute(*recording, "source").value_or("")))) {
    return Error{"--output " + out + " is a file that is read, and would be lost: give another name"};
  }
  constexpr int kHeight = 720;
  auto film = filmed_flame(*recording, kHeight);
  if (!film) return film.error();
  play.film = *std::move(film);
  return {};
}

Result<void> run_run(const Arguments& arguments, Terminal& terminal) {
  if (arguments.has("loop")) {
    const auto model = read_model(arguments.positional());
    return model ? write_loop(*model, arguments, terminal) : model.error();
  }
  auto play = prepare(arguments);
  if (!play) return play.error();
  if (auto ok = watch_film(arguments, terminal, *play); !ok) return ok;
  const auto target = steer_target_from(play->model, arguments);
  if (!target) return target.error();
  warn_of_wind(*play, terminal);
  warn_of_target(play->model, *target, terminal);
  auto bank = make_bank(*play, *target, arguments);
  if (!bank) return bank.error();
  const std::string& path = arguments.text("output");
  Player player(*play, *bank);
  if (auto ok = write_run(*play, *bank, player, path, terminal); !ok) return ok;

  const auto clamped = bank->clamped();
  terminal.add("frames", play->frames);
  terminal.add("instances", bank->size());
  terminal.add("seed", play->seed);
  terminal.add("held_share",
               clamped.steps ? static_cast<double>(clamped.clamped) / static_cast<double>(clamped.steps) : 0.0);
  terminal.add("output", path);
  if (bank->extinction()) {
    const auto& deaths = player.deaths().rows;
    if (!deaths.empty()) {
      terminal.say("went out " + std::to_string(deaths.size()) + " times, first in frame " +
                   wisp::shown(deaths.front().back()));
    }
    terminal.add(player.deaths());
  }
  terminal.say("wrote " + path + ": " + std::to_string(play->frames) + " frames at " + shown(play->model.rate_hz, 5) +
               " a second, seed " + std::to_string(play->seed));
  return {};
}

std::vector<Flag> all_flags() {
  std::vector<Flag> flags{
      {"output", Kind::kOutput, "OUT", "", "what to write: OUT.csv, OUT.png or OUT.mp4", {}, true},
      {"frames", Kind::kInteger, "N", "", "frames at the model's rate; default: as many as --input has"},
      loop_flag(),
      {"input", Kind::kPath, "REC", "",
       "a recording, heard as validate hears it unless its column has the input's own unit, or a sound file of "
       "blowing: the inputs"},
      {"inputs", Kind::kNames, "A,B", "",
       "columns of --input that are the model's inputs, in its order, where they have other names"},
      {"own-gain", Kind::kSwitch, "", "",
       "input 1 is the recording's own 95th percentile, not as loud as in the training: another microphone"},
      {"columns", Kind::kNames, "A,B,…", "", "names of all columns of a plain table, in their order"},
      {"rate", Kind::kNumber, "HZ", "", "samples a second of a plain table; default: as the model's"},
      {"dt", Kind::kNumber, "S", "", "seconds between samples, instead of --rate"},
      {"wind", Kind::kNumber, "W", "0", "a constant value for every input, where there is no --input"},
      {"noise",
       Kind::kChoice,
       "on|off",
       "on",
       "the residual noise; off, a chain goes on with what is likeliest and joins best",
       {"on", "off"}},
      {"clip", Kind::kPath, "CLIP_OR_REC", "",
       "draw it on the candle of this film, in its light: the clip, or the recording captured from it"},
      {"camera", Kind::kNames, "AZIMUTH,ELEVATION", "",
       "see it from so many degrees round it, and above the level: a flame in the round, by rotational symmetry"},
      {"orbit", Kind::kNumber, "S", "0", "the camera goes once round it in so many seconds"},
      {"wind-direction", Kind::kNumber, "DEG", "0",
       "in the round: the wind blows to the right of a camera at that azimuth"},
      {"relight", Kind::kNames, "S,…", "", "light what is out again, that many seconds after the start"},
      ranged({"instances", Kind::kInteger, "K", "1", "how many at once, each with its own chance"}, 1, 10000),
      {"seed", Kind::kInteger, "N", "1", "of all chance; the same seed gives the same bytes"},
      {"steer", Kind::kText, "X,Y,Z@S", "",
       "be near this place (metres from where it starts, z up) after S seconds; a fall takes some 0.75 m of height a "
       "second"},
  };
  for (const char* of_table : {"inputs", "own-gain", "columns", "rate", "dt"})
    flag_named(flags, of_table).with = "input";
  return flags;
}

}  // namespace

Command run_command() {
  return {
      "run",
      "Plays a model and writes what it does: numbers (.csv), a picture (.png) or a film (.mp4).",
      {{"MODEL", "the model, a .wisp file"}},
      all_flags(),
      {
          {"wisp run flame.wisp --frames 600 -o flame.mp4",
           "Twenty seconds of a flame at 30 frames a second, as a film"},
          {"wisp run flame.wisp --frames 1000 --wind 0.5 --noise off -o steady.csv",
           "The noiseless response to steady wind, as numbers"},
          {"wisp run flame.wisp --loop 4 -o loop.mp4", "Four seconds of a flame that repeat without a seam, as a film"},
          {"wisp run flame.wisp --clip candle.mp4 --frames 600 -o flame.mp4", "The same on your own candle"},
          {"wisp run leaf.wisp --frames 1200 --instances 5 -o falls.mp4", "Five leaves that fall for ever, for 20 s"},
          {"wisp run flame.wisp --input puff.csv --frames 600 --relight 5 -o out.mp4",
           "A flame that a puff blows out, its smoke, and how it is lit again after five seconds"},
      },
      run_run,
  };
}

}  // namespace wisp::cli
