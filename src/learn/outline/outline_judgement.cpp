#include "learn/outline/outline_judgement.hpp"

#include <algorithm>
#include <cmath>

#include "learn/arx/plain_model.hpp"
#include "learn/numeric/constants.hpp"
#include "learn/outline/outline_inputs.hpp"
#include "learn/outline/outline_preparation.hpp"
#include "learn/outline/outline_shape.hpp"
#include "learn/outline/outline_synthesis.hpp"

namespace wisp {
namespace {

// A model known to be an outline with ARX dynamics.
struct OutlineModel {
  const Model& whole;
  OutlineDynamics dynamics;
  const OutlineView& view;
};

Result<OutlineModel> outline_model(const Model& model) {
  const auto* arx = std::get_if<ArxModel>(&model.dynamics);
  const auto* view = std::get_if<OutlineView>(&model.view);
  if (arx == nullptr || view == nullptr) return Error{model.name + ": is not an outline model"};
  return OutlineModel{model, {*arx, view->shape}, *view};
}

Result<void> check_match(const OutlineModel& model, const Recording& recording) {
  const auto layout = outline_layout(recording);
  if (!layout) return layout.error();
  const std::size_t points = model.whole.outputs.size() / 2;
  if (layout->points != points) {
    return Error{recording.source + ": has " + std::to_string(layout->points) + " control points, the model " +
                 std::to_string(points) + "; capture it with --points " + std::to_string(points)};
  }
  return check_rate(model.whole, recording);
}

Result<std::vector<OutlineInput>> inputs_of(const Model& model, const Recording& recording, bool own_scale) {
  std::vector<OutlineInput> inputs;
  for (const Input& input : model.inputs) {
    if (!find_channel(recording, input.name)) {
      return Error{recording.source + ": there is no input " + input.name + ", which the model is driven by"};
    }
    const auto trained = trained_scale(model, input.name);
    if (!trained) return trained.error();
    OutlineInput scaled{input.name, "", *trained, input.lowest, input.highest};
    if (own_scale) {
      auto own = scaled_input({&recording, 1}, input.name);
      if (own) scaled = *std::move(own);  // a calm recording has no scale
    }
    inputs.push_back(std::move(scaled));
  }
  return inputs;
}

RegressorShape shape_of(const Model& model) {
  RegressorShape shape;
  for (const Input& input : model.inputs) shape.powers |= has_powers(input.shape);
  return shape;
}

// The recording in pixels, with its outputs replaced by `series`, which has the model's units and knots.
Recording in_pixels(const PreparedOutlines& prepared, const Recording& original,
                    const std::vector<std::vector<double>>& series) {
  Recording units = prepared.recordings.front();
  for (std::size_t k = 0; k < series.size(); ++k) units.channels[prepared.layout.outputs[k]].samples = series[k];
  const auto pixels = to_pixels(units);
  Recording out = original;
  for (const std::string& name : prepared.channels.outputs) {
    out.channels[*find_channel(out, name)].samples = samples_of(*pixels, name);
  }
  out.attributes = pixels->attributes;
  return out;
}

Result<std::vector<PredictedOutlines>> predictions(const OutlineModel& model, const PreparedOutlines& prepared,
                                                   const Recording& original, const std::vector<int>& steps) {
  std::vector<PredictedOutlines> out;
  for (int k : steps) {
    const auto series = predict_outline(model.dynamics, prepared.recordings.front(), prepared, {.steps = k});
    if (!series) return series.error();
    out.push_back({k, in_pixels(prepared, original, *series)});
  }
  return out;
}

// Repeats the base's last position where the outline is missing, so that every played frame has a base.
void hold_base(Recording& recording) {
  for (const char* name : {"base.x", "base.y"}) {
    auto& samples = recording.channels[*find_channel(recording, name)].samples;
    const auto first = std::find_if(samples.begin(), samples.end(), [](double value) { return !std::isnan(value); });
    double last = first == samples.end() ? 0 : *first;
    for (double& value : samples) last = value = std::isnan(value) ? last : value;
  }
}

Result<Recording> played_along(const OutlineModel& model, const PreparedOutlines& prepared, const Recording& original,
                               const Recording& driving, std::uint64_t seed) {
  const auto play = synthesize(model.whole, {.rows = original.rows(), .seed = seed, .input = &driving});
  if (!play) return play.error();
  PreparedOutlines placed = prepared;
  hold_base(placed.recordings.front());
  std::vector<std::vector<double>> series;
  for (const Channel& channel : play->recording.channels) series.push_back(channel.samples);
  return in_pixels(placed, original, series);
}

double self_intersection_rate(const Recording& recording, const OutlineLayout& layout) {
  const OutlineCurve curve(layout.knots, 100);
  std::size_t crossed = 0;
  for (std::size_t row = 0; row < recording.rows(); ++row) {
    const std::vector<double> control = whole_row(recording, layout, row);
    crossed += !control.empty() && crosses_itself(curve.polyline(control)) ? 1 : 0;
  }
  return recording.rows() == 0 ? 0 : static_cast<double>(crossed) / static_cast<double>(recording.rows());
}

// Sets play missing in rows where the recording has no outline; those frames are not compared.
void hide_unseen(const Recording& recorded, const std::vector<std::string>& outputs, Recording& play) {
  for (const std::string& name : outputs) {
    const auto& seen = samples_of(recorded, name);
    auto& samples = play.channels[*find_channel(play, name)].samples;
    for (std::size_t row = 0; row < samples.size(); ++row) {
      if (std::isnan(seen[row % seen.size()])) samples[row] = kMissing;
    }
  }
}

// Compares a free play with noise with the recording, in the model's units.
Result<void> add_fidelity(const OutlineModel& model, const PreparedOutlines& prepared, const Recording& driving,
                          const ValidationOptions& options, OutlineJudgement& out) {
  const auto rows = static_cast<std::size_t>(std::ceil(options.play_seconds * model.whole.rate_hz));
  auto play = synthesize(model.whole, {.rows = rows, .seed = options.seed, .input = &driving});
  if (!play) return play.error();
  out.held_share = play->held_share;
  out.self_intersection_rate = self_intersection_rate(play->recording, prepared.layout);
  if (!model.whole.inputs.empty()) hide_unseen(prepared.recordings.front(), prepared.channels.outputs, play->recording);
  const FidelityOptions how{.channels = prepared.channels.outputs};
  auto found = fidelity(prepared.recordings, {&play->recording, 1}, how);
  if (found) {
    out.fidelity = *std::move(found);
  } else {
    out.warnings.push_back("no fidelity figures: " + found.error().message);
  }
  return {};
}

}  // namespace

Result<OutlineJudgement> judge_outline(const Model& model, const Recording& given, const ValidationOptions& options,
                                       const Progress& progress) {
  constexpr const char* kStage = "validating";
  const auto outline = outline_model(model);
  if (!outline) return outline.error();
  if (auto ok = check_match(*outline, given); !ok) return ok.error();
  auto heard = options.own_input_scale ? Result<Recording>(given) : at_trained_gain(model, given);
  if (!heard) return heard.error();
  heard->rate_hz = model.rate_hz;  // within the tolerance of check_rate()
  auto in_step = align_outline(*heard, options.align ? arx::channels_of(model).inputs : std::vector<std::string>());
  if (!in_step) return in_step.error();
  const Recording& recording = in_step->recording;
  auto inputs = inputs_of(model, recording, options.own_input_scale);
  if (!inputs) return inputs.error();
  const auto prepared =
      prepare_outlines({&recording, 1}, outline->view.knots, *inputs, shape_of(model), options.pixels_per_unit);
  if (!prepared) return prepared.error();
  const Recording driving = with_regressors(recording, *inputs, {});
  if (!go_on(progress, kStage, 0)) return Error{std::string(kStopped)};
  OutlineJudgement out;
  out.alignment = std::move(in_step->inputs);
  out.pixels_per_unit = prepared->pixels_per_unit.front();
  out.warnings = prepared->warnings;
  auto figures = outline_figures(outline->dynamics, prepared->recordings, *prepared, options.steps);
  if (!figures) return figures.error();
  out.figures = *std::move(figures);
  if (!go_on(progress, kStage, 0.4)) return Error{std::string(kStopped)};
  auto predicted = predictions(*outline, *prepared, recording, options.steps);
  if (!predicted) return predicted.error();
  out.predicted = *std::move(predicted);
  auto played = played_along(*outline, *prepared, recording, driving, options.seed);
  if (!played) return played.error();
  out.played = *std::move(played);
  out.driven = !inputs->empty();
  if (!options.fidelity) return out;
  if (!go_on(progress, kStage, 0.6)) return Error{std::string(kStopped)};
  if (auto ok = add_fidelity(*outline, *prepared, driving, options, out); !ok) return ok.error();
  return out;
}

}  // namespace wisp
