// `wisp simulate candle`: simulates a clip with sound from physics, with its ground truth.

#include <filesystem>

#include "commands/commands.hpp"
#include "flags/recordings.hpp"
#include "terminal.hpp"
#include "wisp/draw/video_writer.hpp"
#include "wisp/record/csv.hpp"
#include "wisp/simulate/candle_clip.hpp"

namespace wisp::cli {
namespace {

Result<CandleClipOptions> options_from(const Arguments& arguments) {
  CandleClipOptions options;
  options.seconds = arguments.number("seconds");
  options.rig.rate_hz = arguments.number("rate");
  const auto seed = static_cast<std::uint64_t>(arguments.integer("seed"));
  const auto chance = static_cast<std::uint64_t>(arguments.integer(arguments.has("chance") ? "chance" : "seed"));
  options.wind.seed = seed;
  options.microphone.seed = options.camera.seed = chance;
  if (arguments.has("blow-out")) options.wind.blow_out_at = arguments.number("blow-out");
  options.wind.puff_every = arguments.number("puffs");
  const std::string& wind = arguments.text("wind");
  if (wind == "calm") {
    options.wind.kind = WindKind::kDraughts;
  } else if (wind != "gusts") {
    Arguments of_table;  // without --rate, which is the film's
    if (arguments.has("unpacked")) of_table.set("unpacked", arguments.text("unpacked"));
    auto recording = read_table(wind, of_table, {.rate_hz = options.rig.rate_hz});
    if (!recording) return recording.error();
    options.wind_recording = std::move(*recording);
  }
  return options;
}

// Returns the path of the ground truth: CLIP.truth.csv for CLIP.mp4.
std::filesystem::path truth_path(std::filesystem::path clip) { return clip.replace_extension(".truth.csv"); }

// Simulates and encodes frame by frame; writes clip and ground truth, each atomically. Returns the ground truth.
Result<Recording> write_clip(const std::filesystem::path& path, const CandleClipOptions& options, Terminal& terminal) {
  auto film = VideoWriter::create(path, {.width = options.camera.width,
                                         .height = options.camera.height,
                                         .rate_hz = options.rig.rate_hz,
                                         .crf = 12,  // keeps the sensor's noise, so that frames of a calm flame differ
                                         .sound_rate_hz = static_cast<int>(options.microphone.rate_hz)});
  if (!film) return film.error();
  CandleClipOutputs outputs;
  outputs.on_frame = [&](const CandleFrame& frame) {
    return film->write(Image::from_rgb(frame.picture, frame.width, frame.height));
  };
  outputs.on_sound = [&](std::span<const float> sound) { return film->write_sound(sound); };
  outputs.on_progress = [&](double share) { terminal.progress("simulating", share); };
  auto truth = simulate_candle(options, outputs);
  if (!truth) return truth;
  if (auto ok = film->finish(); !ok) return ok.error();
  if (auto ok = write_csv(truth_path(path), *truth); !ok) return ok.error();
  return truth;
}

Result<void> run_simulate_candle(const Arguments& arguments, Terminal& terminal) {
  const auto options = options_from(arguments);
  if (!options) return options.error();
  const std::filesystem::path path = arguments.text("output");
  if (path.extension() != ".mp4") return Error{"--output " + path.string() + ": expected a name that ends in .mp4"};
  const auto truth = write_clip(path, *options, terminal);
  if (!truth) return truth.error();
  const double seconds = terminal.seconds();
  terminal.add("frames", truth->rows());
  terminal.add("rate_hz", truth->rate_hz);
  terminal.add("seed", options->wind.seed);
  terminal.add("output", path.string());
  terminal.add("truth", truth_path(path).string());
  terminal.add("seconds", seconds);
  terminal.say("wrote " + path.string() + " and " + truth_path(path).string() + ": " + std::to_string(truth->rows()) +
               " frames, seed " + std::to_string(options->wind.seed) + ", in " + shown(seconds) + " s");
  return {};
}

}  // namespace

Command simulate_candle_command() {
  return {
      "simulate candle",
      "Simulates a candle in wind, films it and listens to it: a clip with sound, and CLIP.truth.csv beside it.",
      {},
      {
          {"output", Kind::kOutput, "CLIP.mp4", "", "where to write the clip", {}, true, {}, {".truth.csv"}},
          ranged({"seconds", Kind::kNumber, "S", "60", "its length"}, 0.001, 86400),
          {"rate", Kind::kNumber, "HZ", "60", "frames a second"},
          {"wind", Kind::kText, "W", "gusts",
           "gusts, calm (a closed room's draughts), or a recording whose input is the wind in m/s"},
          {"blow-out", Kind::kNumber, "T", "", "blow the flame out after T seconds, and light it again"},
          {"puffs", Kind::kNumber, "S", "0",
           "every S seconds a puff of 1.2 to 4 m/s that may blow the flame out, which is lit again where it did"},
          {"seed", Kind::kInteger, "N", "1", "of the wind, and of all other chance"},
          {"chance", Kind::kInteger, "N", "",
           "of the camera's and the microphone's noise, if it is not to be the seed: another take in the same wind"},
      },
      {{"wisp simulate candle -o clip.mp4 --seconds 60 --wind gusts", "A minute of a candle in gusts"}},
      run_simulate_candle,
  };
}

}  // namespace wisp::cli
