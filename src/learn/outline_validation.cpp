#include "wisp/learn/outline_validation.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numeric>

#include "outline_preparation.hpp"
#include "wisp/learn/outline_synthesis.hpp"

namespace wisp {
namespace {

Result<OutlineLayout> matching_layout(const Model& model, const Recording& recording) {
  const auto* view = std::get_if<OutlineView>(&model.view);
  if (!view) return Error{"the model is not one of an outline"};
  auto layout = outline_layout(recording);
  if (!layout) return layout;
  if (layout->points * 2 != model.outputs.size()) {
    return Error{recording.source + ": has " + std::to_string(layout->points) + " control points, the model has " +
                 std::to_string(model.outputs.size() / 2) + "; capture it with --points " +
                 std::to_string(model.outputs.size() / 2)};
  }
  // Rates of one clip may differ in the last bits of a fraction such as 30000/1001.
  if (std::abs(recording.rate_hz - model.rate_hz) > 1e-3 * model.rate_hz) {
    return Error{recording.source + ": has " + std::to_string(recording.rate_hz) + " frames a second, the model " +
                 std::to_string(model.rate_hz)};
  }
  return layout;
}

// "0.85 m/s" is a scale of 0.85 for recordings in m/s.
double scale_in_unit(const std::string& unit_of_one, const std::string& recorded_unit) {
  double scale = 0;
  const char* const end = unit_of_one.data() + unit_of_one.size();
  const auto [next, code] = std::from_chars(unit_of_one.data(), end, scale);
  if (code != std::errc() || !(scale > 0)) return 0;
  const std::string unit(next == end ? next : next + 1, end);
  return unit == recorded_unit ? scale : 0;
}

Result<std::vector<OutlineInput>> inputs_of(const Model& model, const Recording& recording) {
  std::vector<OutlineInput> inputs;
  for (const Input& input : model.inputs) {
    auto scaled = scaled_input({&recording, 1}, input.name);
    if (!scaled) return scaled.error();
    const double known = scale_in_unit(input.unit, scaled->unit);
    if (known > 0) scaled->scale = known;
    inputs.push_back(std::move(*scaled));
  }
  return inputs;
}

// The recording's inputs in the model's units, as a bank takes them; a missing sample holds the one before it.
Recording driver_of(const Recording& recording, const std::vector<OutlineInput>& inputs) {
  Recording driver{.rate_hz = recording.rate_hz};
  for (const OutlineInput& input : inputs) {
    Channel channel = recording.channels[*find_channel(recording, input.name)];
    double last = 0;
    for (double& sample : channel.samples) sample = last = std::isnan(sample) ? last : sample / input.scale;
    driver.channels.push_back(std::move(channel));
  }
  return driver;
}

// Predicted control points in the clip's pixels, around where the base was in each frame.
Result<std::vector<std::vector<double>>> predicted_rows(const ArxModel& arx, const PreparedOutlines& prepared,
                                                        int steps) {
  const Recording& units = prepared.recordings.front();
  const auto series = predict(arx, units, prepared.channels, {.steps = steps});
  if (!series) return series.error();
  const auto base_x = find_channel(units, "base.x"), base_y = find_channel(units, "base.y");
  std::vector<std::vector<double>> rows(units.rows());
  for (std::size_t row = 0; row < units.rows(); ++row) {
    const OutlineFrame frame{units.channels[*base_x].samples[row], units.channels[*base_y].samples[row],
                             prepared.pixels_per_unit.front()};
    std::vector<double> control;
    for (const auto& samples : *series) control.push_back(samples[row]);
    const bool missing = std::isnan(frame.base_x) || std::isnan(frame.base_y) ||
                         std::any_of(control.begin(), control.end(), [](double value) { return std::isnan(value); });
    if (!missing) rows[row] = to_pixels(control, frame);
  }
  return rows;
}

Result<Synthesis> live(const Model& model, const Recording& recording, const std::vector<OutlineInput>& inputs,
                       std::uint64_t seed) {
  // Long enough that the figures of likeness are those of the model, not of one short life.
  constexpr double kLeastSeconds = 60;
  const Recording driver = driver_of(recording, inputs);
  SynthesisOptions options{
      .rows = std::max(recording.rows(), static_cast<std::size_t>(kLeastSeconds * recording.rate_hz)), .seed = seed};
  if (!inputs.empty()) {
    options.input = &driver;
    options.warm_up_seconds = 0;  // so that row for row it meets the recording's wind
  }
  return synthesize(model, options);
}

}  // namespace

Result<OutlineValidation> validate_outline(const Model& model, const Recording& recording,
                                           const OutlineValidationOptions& options) {
  auto layout = matching_layout(model, recording);
  if (!layout) return layout.error();
  auto inputs = inputs_of(model, recording);
  if (!inputs) return inputs.error();
  const bool split = !model.inputs.empty() && model.inputs.front().shape == InputShape::kSplitSign;
  const auto prepared = prepare_outline(recording, *layout, *inputs, split, 0);
  if (!prepared) return prepared.error();
  const auto& arx = std::get<ArxModel>(model.dynamics);

  OutlineValidation out{.layout = *layout, .pixels_per_unit = prepared->pixels_per_unit.front()};
  auto figures = outline_figures(arx, prepared->recordings, prepared->channels, prepared->layout, options.steps);
  if (!figures) return figures.error();
  out.figures = std::move(*figures);
  out.predicted_steps = model.inputs.empty() ? options.shown_steps : kFreeRun;
  auto predicted = predicted_rows(arx, *prepared, out.predicted_steps);
  if (!predicted) return predicted.error();
  out.predicted = std::move(*predicted);
  auto life = live(model, recording, *inputs, options.seed);
  if (!life) return life.error();
  out.synthesized = std::move(life->recording);
  out.synthesized_layout = *layout;
  std::iota(out.synthesized_layout.outputs.begin(), out.synthesized_layout.outputs.end(), std::size_t{0});
  out.held_share = life->held_share;
  auto likeness = fidelity(prepared->recordings, {&out.synthesized, 1},
                           {.channels = prepared->channels.outputs, .seed = options.seed});
  if (!likeness) return likeness.error();
  out.fidelity = std::move(*likeness);
  return out;
}

}  // namespace wisp
