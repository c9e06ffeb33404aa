#include "learn/outline/wind_gain.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "learn/outline/outline_inputs.hpp"
#include "record/loudness.hpp"
#include "record/number_text.hpp"
#include "wisp/learn/validate.hpp"

namespace wisp {
namespace {

constexpr double kSame = 0.02;  // factors closer to 1 than this count as 1

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

Result<std::vector<double>> common_gain_factors(std::span<const Recording> recordings) {
  const auto inputs = loudest_inputs(recordings);
  if (!inputs) return inputs.error();
  if (inputs->empty()) return std::vector<double>();
  std::vector<double> factors = factors_of(recordings, inputs->front());
  if (*std::min_element(factors.begin(), factors.end()) > 1 - kSame) factors.clear();
  return factors;
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
