#include "films/looped.hpp"

#include <filesystem>

#include "films/candle_pictures.hpp"
#include "flags/wind_input.hpp"
#include "wisp/draw/video_writer.hpp"
#include "wisp/record/csv.hpp"

namespace wisp::cli {
namespace {

Result<void> write_film(const Model& model, const Take& taken, const std::string& path, Terminal& terminal) {
  if (!std::holds_alternative<OutlineView>(model.view)) {
    return Error{path + ": only a loop of an outline is a film; write its numbers (.csv), or export a .glb"};
  }
  constexpr int kPoints = 96;
  CandlePictures pictures(model, static_cast<int>(taken.instances), kPoints);
  auto film =
      VideoWriter::create(path, {.width = pictures.width(), .height = pictures.height(), .rate_hz = taken.rate_hz});
  if (!film) return film.error();
  for (std::size_t frame = 0; frame < taken.frames; ++frame) {
    std::vector<float> outlines;
    for (std::size_t k = 0; k < taken.instances; ++k) {
      const auto outline = outline_of(model, taken, frame, k, kPoints);
      outlines.insert(outlines.end(), outline.begin(), outline.end());
    }
    if (auto ok = film->write(pictures.draw(outlines)); !ok) return ok;
    terminal.progress("drawing", static_cast<double>(frame + 1) / static_cast<double>(taken.frames));
  }
  return film->finish();
}

}  // namespace

Flag loop_flag() {
  return {"loop", Kind::kNumber, "S", "",
          "a loop of that many seconds, whose last frame meets its first in value and in speed; a leaf's loop leads "
          "on by `travel`"};
}

Result<Take> take_from(const Model& model, const Arguments& arguments, Terminal& terminal, bool round) {
  const auto track = InputTrack::from(model, arguments);
  if (!track) return track.error();
  TakeOptions options{.loop = arguments.has("loop"),
                      .instances = arguments.integer("instances"),
                      .seed = static_cast<std::uint64_t>(arguments.integer("seed")),
                      .noise = arguments.text("noise") == "on",
                      .round = round};
  options.seconds = arguments.number(options.loop ? "loop" : "seconds");
  options.inputs.assign(model.inputs.size(), arguments.number("wind"));
  for (std::size_t frame = 0; frame < track->rows(); ++frame) {
    for (const float value : track->at(frame)) options.schedule.push_back(value);
  }
  if (arguments.has("input")) options.seconds = static_cast<double>(track->rows()) / model.rate_hz;
  auto taken = take(model, options, terminal.progress());
  if (!taken) return Error{arguments.positional() + ": " + taken.error().message};
  terminal.add("frames", taken->frames);
  terminal.add("instances", taken->instances);
  terminal.add("rate_hz", taken->rate_hz);
  terminal.add("loop", taken->loop);
  ReportList travel;
  for (const auto& way : taken->travel) travel.push_back(ReportList(way.begin(), way.end()));
  if (!travel.empty()) terminal.add("travel", std::move(travel));
  return taken;
}

Result<void> write_loop(const Model& model, const Arguments& arguments, Terminal& terminal) {
  auto constant =
      refuse(arguments, {"frames", "input", "relight", "steer", "clip", "camera", "orbit", "wind-direction"},
             "does not go with --loop, a loop of so many seconds in a constant wind");
  if (!constant) return constant;
  const std::string& path = arguments.text("output");
  const std::string extension = std::filesystem::path(path).extension().string();
  if (extension != ".csv" && extension != ".mp4") {
    return Error{path + ": a loop cannot be written so, expected a name that ends in .csv or .mp4 (or wisp export)"};
  }
  const auto taken = take_from(model, arguments, terminal);
  if (!taken) return taken.error();
  Recording numbers = recording_of(model, *taken, arguments.number("wind"), arguments.text("seed"));
  numbers.attributes.push_back({"loop", arguments.text("loop")});
  auto written = extension == ".csv" ? write_csv(path, numbers) : write_film(model, *taken, path, terminal);
  if (!written) return written;
  terminal.add("seed", arguments.integer("seed"));
  terminal.add("output", path);
  terminal.say("wrote " + path + ": a loop of " + std::to_string(taken->frames) + " frames at " +
               shown(taken->rate_hz, 5) + " a second, seed " + arguments.text("seed"));
  return {};
}

Recording recording_of(const Model& model, const Take& taken, double wind, const std::string& seed) {
  const auto instances = static_cast<int>(taken.instances);
  Recording recording = played_channels(model, instances, seed);
  for (std::size_t frame = 0; frame < taken.frames; ++frame) {
    std::size_t channel = 0;
    while (channel < model.inputs.size()) recording.channels[channel++].samples.push_back(wind);
    for (std::size_t k = 0; k < taken.instances; ++k) {
      for (const float value : taken.at(frame, k)) recording.channels[channel++].samples.push_back(value);
    }
  }
  return are_bodies(model, instances) ? one_after_the_other(recording, model, instances, seed) : recording;
}

Recording played_channels(const Model& model, int instances, const std::string& seed) {
  Recording recording;
  recording.rate_hz = model.rate_hz;
  recording.attributes = {{"model", model.name}, {"seed", seed}};
  if (const auto* outline = std::get_if<OutlineView>(&model.view)) {
    set_numbers_attribute(recording, "knots", outline->knots);
  }
  for (const Input& input : model.inputs) recording.channels.push_back({input.name, input.unit, Role::kInput, {}});
  for (int k = 0; k < instances; ++k) {
    const std::string prefix = instances == 1 ? "" : "i" + std::to_string(k) + ".";
    for (const Output& output : model.outputs) {
      recording.channels.push_back({prefix + output.name, output.unit, Role::kOutput, {}});
    }
  }
  return recording;
}

Recording one_after_the_other(const Recording& side_by_side, const Model& model, int instances,
                              const std::string& seed) {
  const std::size_t inputs = model.inputs.size(), outputs = model.outputs.size();
  Recording recording = played_channels(model, 1, seed);
  for (int k = 0; k < instances; ++k) {
    for (std::size_t c = 0; c < recording.channels.size(); ++c) {
      const std::size_t from = c < inputs ? c : c + static_cast<std::size_t>(k) * outputs;
      const std::vector<double>& samples = side_by_side.channels[from].samples;
      recording.channels[c].samples.insert(recording.channels[c].samples.end(), samples.begin(), samples.end());
    }
    recording.episode_ids.insert(recording.episode_ids.end(), side_by_side.rows(), k);
  }
  return recording;
}

bool are_bodies(const Model& model, int instances) {
  return instances > 1 && std::holds_alternative<ChainModel>(model.dynamics);
}

}  // namespace wisp::cli
