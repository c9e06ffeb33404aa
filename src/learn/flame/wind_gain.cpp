#include "learn/flame/wind_gain.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <numeric>
#include <utility>

#include "learn/arx/judge/held_out.hpp"
#include "learn/outline/outline_inputs.hpp"
#include "record/loudness.hpp"
#include "record/number_text.hpp"
#include "wisp/learn/validate.hpp"

namespace wisp {
namespace {

constexpr double kSame = 0.02;  // factors nearer to 1 than this are no choice

// The inputs that say in every recording how loud they are, and the loudest of each.
struct Loudest {
  std::string input;
  double rms = 0;
};

Result<std::vector<Loudest>> loudest_inputs(std::span<const Recording> recordings) {
  std::vector<Loudest> out;
  for (std::size_t c : channels_with_role(recordings.front(), Role::kInput)) {
    Loudest one{recordings.front().channels[c].name, 0};
    bool all = true;
    for (const Recording& recording : recordings) {
      const auto rms = one_rms(recording, one.input);
      if (!rms) return rms.error();
      all = all && *rms;
      one.rms = std::max(one.rms, rms->value_or(0));
    }
    if (all) out.push_back(std::move(one));
  }
  return out;
}

// What the first of these inputs is multiplied by, recording by recording.
std::vector<double> factors_of(std::span<const Recording> recordings, const Loudest& loudest) {
  std::vector<double> out;
  for (const Recording& recording : recordings) {
    out.push_back(*factor_at(recording, loudest.input, loudest.rms));  // says how loud it was: loudest_inputs()
  }
  return out;
}

// What free simulation of held-out data says of a model.
struct HeldOut {
  double error = 0;       // mean over control points, model units
  Eigen::MatrixXd parts;  // squared, part by part
};

// Nothing where too little is held out.
Result<std::optional<HeldOut>> held_out_error(std::span<const Recording> recordings, OutlineRecipe recipe,
                                              const Progress& progress) {
  recipe.refit = false;
  recipe.noise = OutlineNoise::kIndependent;  // is not judged here
  recipe.match_variance = false;
  const auto fit = fit_outline(recordings, recipe, progress);
  if (!fit) return fit.error();
  const Eigen::MatrixXd& parts = fit->summary.free_run_parts;
  if (!fit->summary.held_out || parts.size() == 0) return std::optional<HeldOut>();
  const std::vector<double>& free = fit->summary.held_out->j.back();
  return std::optional(
      HeldOut{std::accumulate(free.begin(), free.end(), 0.0) / static_cast<double>(free.size()), parts});
}

std::string scale_words(const std::vector<double>& factors, bool common) {
  const auto [min, max] = std::minmax_element(factors.begin(), factors.end());
  if (!common) return "per-recording gain: the wind of every recording on a scale of its own";
  return "common gain: the winds of all recordings on one scale, as one microphone hears them (times " +
         number_text(*min, 3) + " to " + number_text(*max, 3) + ")";
}

Result<void> compare(std::span<const Recording> recordings, const OutlineRecipe& recipe, const Progress& progress,
                     WindGain& gain) {
  const auto together = at_common_gain({recordings.begin(), recordings.end()});
  if (!together) return together.error();
  const auto common = held_out_error(*together, recipe, progress);
  if (!common) return common.error();
  const auto own = held_out_error(recordings, recipe, progress);
  if (!own) return own.error();
  if (!*common || !*own) {
    gain.reason = "; too little is held out to compare it with per-recording gain";
    return {};
  }
  gain.common_error = (*common)->error;
  gain.own_error = (*own)->error;
  const auto relative = [&](const HeldOut& one) { return arx::relative_errors(one.parts, (*common)->parts); };
  const double sureness = arx::standard_errors_below(relative(**own), relative(**common));
  gain.common = gain.common_error <= gain.own_error || sureness < arx::kSurelyBetter;
  gain.reason = "; free simulation of held-out data errs by " + number_text(gain.common_error, 3) +
                " with the common gain, by " + number_text(gain.own_error, 3) + " with per-recording gain" +
                (gain.common && gain.own_error < gain.common_error ? ", which is not surely better" : "");
  return {};
}

// What of a recording's channel is 1 in an input; 1 where neither says.
Result<double> value_of_one(const Model& model, std::size_t input, const Recording& recording, const Channel& heard,
                            bool own_gain) {
  if (!heard.unit.empty() && heard.unit == model.inputs[input].unit) return 1.0;
  if (own_gain) {
    if (!std::holds_alternative<OutlineView>(model.view)) return 1.0;
    const auto own = scaled_input({&recording, 1}, heard.name);
    return own ? own->scale : 1.0;  // in a calm one
  }
  if (input >= model.training.inputs.size()) return 1.0;
  const InputTraining& trained = model.training.inputs[input];
  if (trained.one_rms == 0) return trained.scale;
  const auto factor = factor_at(recording, heard.name, trained.one_rms);
  if (!factor) return factor.error();
  return trained.scale / *factor;
}

// Divides a channel, and says how loud its 1 is then.
Result<void> divide(Recording& recording, Channel& channel, double one) {
  if (one == 1) return {};
  for (double& value : channel.samples) value /= one;
  const auto rms = one_rms(recording, channel.name);
  if (!rms) return rms.error();
  if (*rms) set_one_rms(recording, channel.name, **rms * one * one);
  return {};
}

}  // namespace

Result<std::vector<Recording>> at_common_gain(std::vector<Recording> recordings) {
  const auto inputs = loudest_inputs(recordings);
  if (!inputs) return inputs.error();
  for (const Loudest& loudest : *inputs) {
    for (Recording& recording : recordings) {
      auto heard = heard_at(std::move(recording), loudest.input, loudest.rms);
      if (!heard) return heard.error();
      recording = *std::move(heard);
    }
  }
  return recordings;
}

Result<WindGain> choose_wind_gain(std::span<const Recording> recordings, const OutlineRecipe& recipe,
                                  const Progress& progress) {
  WindGain gain{.common = recipe.gain != InputGain::kPerRecording, .factors = {}, .reason = {}};
  const auto inputs = loudest_inputs(recordings);
  if (!inputs) return inputs.error();
  if (inputs->empty() || (recipe.inputs && recipe.inputs->empty())) return gain;
  gain.factors = factors_of(recordings, inputs->front());
  if (*std::min_element(gain.factors.begin(), gain.factors.end()) > 1 - kSame) {
    gain.factors.clear();
    return gain;
  }
  if (recipe.gain != InputGain::kAuto) {
    gain.reason = ", as given";
  } else if (auto ok = compare(recordings, recipe, progress, gain); !ok) {
    return ok.error();
  }
  gain.reason = scale_words(gain.factors, gain.common) + gain.reason;
  return gain;
}

Result<double> factor_to_trained_gain(const Model& model, const Recording& recording) {
  for (std::size_t k = 0; k < model.training.inputs.size(); ++k) {
    const double trained = model.training.inputs[k].one_rms;
    if (trained > 0) return factor_at(recording, model.inputs[k].name, trained);
  }
  return 1.0;
}

Result<Recording> at_trained_gain(const Model& model, Recording recording) {
  for (std::size_t k = 0; k < model.training.inputs.size(); ++k) {
    const double trained = model.training.inputs[k].one_rms;
    if (trained == 0) continue;
    auto heard = heard_at(std::move(recording), model.inputs[k].name, trained);
    if (!heard) return heard.error();
    recording = *std::move(heard);
  }
  return recording;
}

Result<Recording> in_model_units(const Model& model, Recording recording, std::span<const std::string> names,
                                 bool own_gain) {
  for (std::size_t k = 0; k < model.inputs.size(); ++k) {
    const auto found = find_channel(recording, names[k]);
    if (!found) return Error{recording.source + ": has no channel " + names[k] + ", which the model takes as input"};
    Channel& channel = recording.channels[*found];
    const auto one = value_of_one(model, k, recording, channel, own_gain);
    if (!one) return one.error();
    if (auto ok = divide(recording, channel, *one); !ok) return ok.error();
    channel.unit = model.inputs[k].unit;
  }
  return recording;
}

}  // namespace wisp
