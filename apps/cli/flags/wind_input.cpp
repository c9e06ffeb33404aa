#include "flags/wind_input.hpp"

#include <algorithm>
#include <cmath>

#include "flags/recordings.hpp"
#include "terminal.hpp"
#include "wisp/capture/capture.hpp"
#include "wisp/learn/validate.hpp"

namespace wisp::cli {

namespace {

// Resamples a channel by linear interpolation; missing samples repeat the last one before them, 0 at the start.
std::vector<float> at_rate(const std::vector<double>& samples, double from_hz, double to_hz) {
  std::vector<double> held(samples.size());
  double last = 0;
  for (std::size_t k = 0; k < samples.size(); ++k)
    held[k] = last = std::isnan(samples[k]) ? last : std::clamp(samples[k], -1e30, 1e30);
  if (held.empty()) return {};
  std::vector<float> out;
  const auto count =
      static_cast<std::size_t>(std::floor(static_cast<double>(held.size() - 1) * to_hz / from_hz + 1e-9)) + 1;
  for (std::size_t k = 0; k < count; ++k) {
    const double place = static_cast<double>(k) * from_hz / to_hz;
    const auto before = std::min(static_cast<std::size_t>(place), held.size() - 1);
    const auto after = std::min(before + 1, held.size() - 1);
    const double share = place - static_cast<double>(before);
    out.push_back(static_cast<float>(held[before] + share * (held[after] - held[before])));
  }
  return out;
}

// Returns the measure of sound that drives an input, by the input's name in captures; for other names wind speed.
WindMeasure measure_of(const Input& input) {
  for (const WindMeasure measure : {WindMeasure::kHeard, WindMeasure::kRms}) {
    if (input.name == wind_channel_name(measure)) return measure;
  }
  return WindMeasure::kSpeed;
}

// Returns the divisor from a measure of sound to an input: the training's scale for an RMS, 1 for the other measures.
Result<double> scale_of(const Model& model, std::size_t input) {
  if (measure_of(model.inputs[input]) != WindMeasure::kRms) return 1.0;
  if (input < model.training.inputs.size()) return model.training.inputs[input].scale;
  return Error{model.name + ": does not say what its input " + model.inputs[input].name +
               " was in recordings, expected a model that was learned from some; learn it with this program"};
}

// Returns the columns of the model's inputs: those of --inputs in order, or those with the model's names.
Result<std::vector<std::string>> input_names(const Model& model, const Arguments& arguments) {
  std::vector<std::string> names = arguments.names("inputs");
  if (names.empty()) {
    for (const Input& input : model.inputs) names.push_back(input.name);
  }
  if (names.size() == model.inputs.size()) return names;
  return Error{"--inputs names " + std::to_string(names.size()) + " columns, the model has " +
               std::to_string(model.inputs.size()) + " inputs: name one for each, in the model's order"};
}

// Checks that a model without inputs gets none.
Result<void> check_drive(const Model& model, const Arguments& arguments) {
  const bool table = arguments.has("input");
  if (table && arguments.given("wind")) return Error{"--wind is constant, and --input is not: leave one of them out"};
  if (!model.inputs.empty() || (!table && arguments.number("wind") == 0)) return {};
  return Error{
      std::string(table ? "--input" : "--wind") + " drives a model's inputs, and " + arguments.positional() +
      " has none: learn it from recordings with an input (a leaf's: from a windy recording and its calm twin)"};
}

constexpr double kMaxFrames = 1e9;

}  // namespace

Result<InputTrack> InputTrack::heard(const Model& model, const std::string& path) {
  const auto wind = hear_wind(path, model.rate_hz);
  if (!wind) return wind.error();
  if (wind->frames.empty()) return Error{path + ": wind " + wind->note + "; expected the sound of blowing"};
  InputTrack track;
  track.rows_ = wind->frames.size();
  for (std::size_t k = 0; k < model.inputs.size(); ++k) {
    const auto scale = scale_of(model, k);
    if (!scale) return scale.error();
    std::vector<float>& samples = track.tracks_.emplace_back();
    for (const WindFrame& frame : wind->frames) {
      samples.push_back(static_cast<float>(wind_value(frame, measure_of(model.inputs[k])) / *scale));
    }
  }
  return track;
}

Result<InputTrack> InputTrack::from(const Model& model, const Arguments& arguments) {
  if (auto ok = check_drive(model, arguments); !ok) return ok.error();
  InputTrack track;
  if (!arguments.has("input")) {
    track.tracks_.assign(model.inputs.size(), {static_cast<float>(arguments.number("wind"))});
    return track;
  }
  const std::string& path = arguments.text("input");
  if (!is_table(path)) {
    auto of_table = refuse(arguments, {"own-gain", "inputs", "columns", "rate", "dt"},
                           "is of a table; " + path + " is a sound, whose wind has the model's scale");
    if (!of_table) return of_table.error();
    return heard(model, path);
  }
  const auto names = input_names(model, arguments);
  if (!names) return names.error();
  auto recording = read_table(path, arguments, {.rate_hz = model.rate_hz, .inputs = *names});
  if (recording) recording = in_model_units(model, *std::move(recording), *names, arguments.on("own-gain"));
  if (!recording) return recording.error();
  if (std::holds_alternative<PlainView>(model.view) &&
      std::abs(recording->rate_hz - model.rate_hz) > 1e-3 * model.rate_hz) {
    return Error{path + ": has " + shown(recording->rate_hz) + " samples a second, the model " + shown(model.rate_hz) +
                 ": resample it, or learn the model at that rate"};
  }
  const double frames = static_cast<double>(recording->rows()) * model.rate_hz / recording->rate_hz;
  if (!(frames <= kMaxFrames)) {
    return Error{path + ": at " + shown(recording->rate_hz) + " samples a second lasts " + shown(frames) +
                 " frames of the model, expected at most " + shown(kMaxFrames) + ": is the rate right?"};
  }
  for (const std::string& name : *names) {
    const auto& samples = recording->channels[*find_channel(*recording, name)].samples;
    track.tracks_.push_back(at_rate(samples, recording->rate_hz, model.rate_hz));
    track.rows_ = std::max(track.rows_, track.tracks_.back().size());
  }
  return track;
}

std::vector<float> InputTrack::at(std::size_t frame) const {
  std::vector<float> values;
  for (const auto& samples : tracks_)
    values.push_back(samples.empty() ? 0.0F : samples[std::min(frame, samples.size() - 1)]);
  return values;
}

}  // namespace wisp::cli
