// predict(): the predictions of a recording by a model, row by row, with 95 % intervals.

#include <algorithm>
#include <cmath>

#include "learn/arx/plain_model.hpp"
#include "learn/judge/prediction.hpp"
#include "learn/markov/markov_rows.hpp"
#include "learn/numeric/constants.hpp"
#include "learn/outline/outline_inputs.hpp"
#include "learn/outline/outline_judgement.hpp"
#include "wisp/learn/prepare.hpp"
#include "wisp/learn/validate.hpp"

namespace wisp {
namespace {

using Series = std::vector<std::vector<double>>;  // one series per output

// Half width of the 95 % interval of every prediction. The initial state of a free run is taken as known, so row n of
// the run has the interval of an n-step prediction.
Series half_widths(const Series& sd, const Recording& recording, const Series& predicted, int steps) {
  Series widths(predicted.size(), std::vector<double>(recording.rows(), kMissing));
  for (std::size_t i = 0; i < predicted.size(); ++i) {
    for (const Episode& episode : episodes(recording)) {
      std::size_t run = 0;
      for (std::size_t row = episode.begin; row < episode.end; ++row) {
        run = std::isnan(predicted[i][row]) ? 0 : run + 1;
        if (run == 0) continue;
        const std::size_t ahead = steps == kFreeRun ? std::min(run, sd[i].size()) : static_cast<std::size_t>(steps);
        widths[i][row] = kNormal95 * sd[i][ahead - 1];
      }
    }
  }
  return widths;
}

// Measured inputs and outputs, with the prediction and, unless `widths` is empty, its interval beside every output.
Recording table_of(const Recording& measured, const ChannelChoice& channels, const Series& predicted,
                   const Series& widths) {
  Recording out;
  out.source = measured.source;
  out.rate_hz = measured.rate_hz;
  out.episode_ids = measured.episode_ids;
  const auto take = [&](const std::string& name, Role role) -> const Channel& {
    out.channels.push_back(measured.channels[*find_channel(measured, name)]);
    out.channels.back().role = role;
    return measured.channels[*find_channel(measured, name)];
  };
  for (const std::string& name : channels.inputs) take(name, Role::kInput);
  for (std::size_t i = 0; i < channels.outputs.size(); ++i) {
    const Channel& output = take(channels.outputs[i], Role::kOutput);
    out.channels.push_back({output.name + ".predicted", output.unit, Role::kOutput, predicted[i]});
    if (widths.empty()) continue;
    Channel low{output.name + ".low", output.unit, Role::kOutput, predicted[i]};
    Channel high{output.name + ".high", output.unit, Role::kOutput, predicted[i]};
    for (std::size_t row = 0; row < predicted[i].size(); ++row) {
      low.samples[row] -= widths[i][row];
      high.samples[row] += widths[i][row];
    }
    out.channels.push_back(std::move(low));
    out.channels.push_back(std::move(high));
  }
  return out;
}

int horizon_of(int steps) { return steps == kFreeRun ? kSettledSteps : steps; }

Result<Recording> predict_plain(const Model& model, const Recording& measured, const PredictionOptions& options) {
  const auto* modes = std::get_if<SwitchedArxModel>(&model.dynamics);
  if (modes && options.initial != InitialState::kMeasured) {
    return Error{model.name + ": is a switched model, whose free run starts from measured samples only"};
  }
  const auto prepared = prepare(measured, model.training.preparation);
  if (!prepared) return prepared.error();
  const Recording& recording = *prepared;
  if (auto ok = check_rate(model, recording); !ok) return ok.error();
  const ChannelChoice channels = arx::channels_of(model);
  if (const auto found = arx::sources_of({&recording, 1}, channels); !found) return found.error();
  if (modes) {
    const auto predicted = markov::predict(*modes, recording, channels, options.steps);
    if (!predicted) return predicted.error();
    return table_of(recording, channels, *predicted, {});
  }
  const auto& arx = std::get<ArxModel>(model.dynamics);
  std::vector<double> moved;
  const Recording seen = arx::seen_by(model, recording, &moved);
  auto predicted = predict(arx, seen, channels, {options.steps, options.initial});
  if (!predicted) return predicted.error();
  for (std::size_t i = 0; i < moved.size(); ++i) {
    for (double& y : (*predicted)[i]) y -= moved[i];
  }
  return table_of(recording, channels, *predicted,
                  half_widths(prediction_sd(arx, horizon_of(options.steps)), recording, *predicted, options.steps));
}

Result<Recording> predict_outline(const Model& model, const Recording& recording, const PredictionOptions& options) {
  if (options.initial != InitialState::kMeasured) {
    return Error{model.name + ": is a model of an outline, whose free run starts from measured samples only"};
  }
  const auto heard = at_trained_gain(model, recording);
  if (!heard) return heard.error();
  const auto found = judge_outline(model, *heard, {.steps = {options.steps}, .play_seconds = 0, .fidelity = false});
  if (!found) return found.error();
  ChannelChoice channels{input_names(*heard), {}};
  for (const Output& output : model.outputs) channels.outputs.push_back(output.name);
  const Recording& said = found->predicted.front().recording;
  Series predicted;
  for (const std::string& name : channels.outputs) predicted.push_back(samples_of(said, name));
  const OutlineDynamics dynamics{std::get<ArxModel>(model.dynamics), std::get<OutlineView>(model.view).shape};
  Series sd = outline_prediction_sd(dynamics, horizon_of(options.steps));
  for (auto& one : sd) {
    for (double& x : one) x *= found->pixels_per_unit;
  }
  return table_of(*heard, channels, predicted, half_widths(sd, *heard, predicted, options.steps));
}

}  // namespace

Result<Recording> predict(const Model& model, const Recording& recording, const PredictionOptions& options) {
  if (std::holds_alternative<ChainModel>(model.dynamics)) {
    return Error{model.name +
                 ": is a segment chain, which lives by chance and predicts no row; wisp validate compares "
                 "how it lives"};
  }
  if (auto ok = check_steps({&options.steps, 1}); !ok) return ok.error();
  const bool switched = std::holds_alternative<SwitchedArxModel>(model.dynamics);
  const bool outline = !switched && std::holds_alternative<OutlineView>(model.view);
  return outline ? predict_outline(model, recording, options) : predict_plain(model, recording, options);
}

}  // namespace wisp
