#include "learn/flame/extinction_learning.hpp"

#include <algorithm>

#include "learn/outline/outline_inputs.hpp"

namespace wisp {
namespace {

std::size_t unexplained(std::span<const ExtinctionEvidence> evidence) {
  std::size_t count = 0;
  for (const ExtinctionEvidence& each : evidence) {
    count += static_cast<std::size_t>(std::count_if(each.blow_outs.begin(), each.blow_outs.end(),
                                                    [](const BlowOut& blow_out) { return !blow_out.blown; }));
  }
  return count;
}

Result<std::vector<SizeCurve>> curves_of(std::span<const ExtinctionEvidence> evidence, SizeChange change) {
  std::vector<SizeCurve> all;
  for (const ExtinctionEvidence& each : evidence) {
    const auto sizes = flame_sizes(*each.recording, each.blow_outs);
    if (!sizes) return sizes.error();
    for (SizeCurve& curve : size_curves(*each.recording, *sizes, each.blow_outs, change)) {
      all.push_back(std::move(curve));
    }
  }
  return all;
}

// How long a change takes, where the recordings show it.
Result<std::optional<RampFit>> ramp_of(std::span<const ExtinctionEvidence> evidence, SizeChange change) {
  const auto curves = curves_of(evidence, change);
  if (!curves) return curves.error();
  return learn_ramp(change, *curves);
}

RampTraining set_ramp(const std::optional<RampFit>& fit, double& seconds) {
  if (!fit) return {};
  seconds = fit->seconds;
  return {Origin::kLearned, static_cast<std::uint32_t>(fit->events), fit->seconds_ci95, fit->error};
}

// A rule that the recipe gives is used as it is, without haste.
Extinction given_rule(const ExtinctionRecipe& recipe) {
  return {.level = recipe.level, .seconds = recipe.seconds, .haste = 0, .recovery = recipe.seconds};
}

Extinction choose_rule(const ExtinctionRecipe& recipe, std::span<const ExtinctionEvidence> evidence,
                       LearnedExtinction& out) {
  if (recipe.source == ExtinctionSource::kGiven) {
    out.origin = Origin::kGiven;
    return given_rule(recipe);
  }
  auto learned = learn_extinction(evidence);
  if (learned) {
    out.origin = Origin::kLearned;
    out.fit = *std::move(learned);
    return out.fit->rule;
  }
  const Extinction rule = extinction_beyond(evidence);
  if (agreement(rule, evidence).deaths > 0) out.warning = learned.error().message;
  return rule;
}

ExtinctionTraining training_of(const LearnedExtinction& found) {
  const auto count = [](std::size_t value) { return static_cast<std::uint32_t>(value); };
  return {.origin = found.origin,
          .deaths = count(found.agreement.deaths),
          .died = count(found.agreement.died),
          .gusts = count(found.agreement.gusts),
          .spared = count(found.agreement.spared)};
}

// The recording's value of the input that is 1 in the model.
Result<double> scale_for(const Model& model, const Recording& recording, std::span<const BlowOut> blow_outs,
                         bool own_scale) {
  const std::string& input = model.inputs[model.extinction->input].name;
  if (!own_scale) return trained_scale(model, input);
  const Recording burning = without_blow_outs(recording, blow_outs);
  const auto own = scaled_input({&burning, 1}, input);
  if (!own) return own.error();
  return own->scale;
}

}  // namespace

Result<ExtinguishedRecordings> ExtinguishedRecordings::find(std::vector<Recording> recordings,
                                                            const ExtinctionRecipe& recipe) {
  if (recipe.source == ExtinctionSource::kGiven) {
    if (auto ok = check(given_rule(recipe), 1); !ok) return Error{"the rule of extinction: " + ok.error().message};
  }
  ExtinguishedRecordings out;
  const auto inputs = channels_with_role(recordings.front(), Role::kInput);
  if (recipe.source != ExtinctionSource::kNone && !inputs.empty()) {
    out.input_ = recordings.front().channels[inputs.front()].name;
    for (const Recording& recording : recordings) {
      auto found = find_blow_outs(recording, out.input_);
      if (!found) return found.error();
      out.burning_.push_back(without_blow_outs(recording, *found));
      out.found_.push_back(*std::move(found));
    }
  } else {
    out.burning_ = recordings;
  }
  out.recordings_ = std::move(recordings);
  return out;
}

std::vector<ExtinctionEvidence> ExtinguishedRecordings::evidence(double scale, double decay) const {
  std::vector<ExtinctionEvidence> out;
  for (std::size_t k = 0; k < recordings_.size(); ++k) {
    out.push_back({&recordings_[k], input_, scale, found_[k], decay});
  }
  return out;
}

Result<std::optional<LearnedExtinction>> ExtinguishedRecordings::complete(Model& model,
                                                                          const ExtinctionRecipe& recipe) const {
  std::size_t index = 0;
  while (index < model.inputs.size() && model.inputs[index].name != input_) ++index;
  if (recipe.source == ExtinctionSource::kGiven && index == model.inputs.size()) {
    return Error{"the recordings have no input that could put it out; leave the rule of extinction away"};
  }
  if (recipe.source == ExtinctionSource::kNone || index == model.inputs.size()) {
    return std::optional<LearnedExtinction>();
  }
  const double scale = model.training.inputs[index].scale;
  const auto decay = ramp_of(evidence(scale, 0), SizeChange::kDecay);
  if (!decay) return decay.error();
  const auto re_ignition = ramp_of(evidence(scale, 0), SizeChange::kReIgnition);
  if (!re_ignition) return re_ignition.error();
  const auto seen = evidence(scale, *decay ? (*decay)->seconds : 0);
  LearnedExtinction out{.input = input_};
  Extinction rule = choose_rule(recipe, seen, out);
  rule.input = index;
  out.agreement = agreement(rule, seen);
  out.unexplained = unexplained(seen);
  model.extinction = rule;
  model.training.extinction = training_of(out);
  model.training.extinction->decay = set_ramp(*decay, model.extinction->decay);
  model.training.extinction->re_ignition = set_ramp(*re_ignition, model.extinction->re_ignition);
  return std::optional(std::move(out));
}

Result<std::optional<JudgedExtinction>> judge_extinction(const Model& model, const Recording& recording,
                                                         bool own_scale) {
  if (!model.extinction) return std::optional<JudgedExtinction>();
  const Extinction& rule = *model.extinction;
  const std::string& input = model.inputs[rule.input].name;
  auto blow_outs = find_blow_outs(recording, input);
  if (!blow_outs) return blow_outs.error();
  const auto scale = scale_for(model, recording, *blow_outs, own_scale);
  if (!scale) return scale.error();
  const ExtinctionEvidence evidence{&recording, input, *scale, *std::move(blow_outs), rule.decay};
  return std::optional(JudgedExtinction{agreement(rule, {&evidence, 1}), unexplained({&evidence, 1})});
}

Result<Recording> burning_part(const Model& model, const Recording& recording) {
  if (!model.extinction) return recording;
  const auto found = find_blow_outs(recording, model.inputs[model.extinction->input].name);
  if (!found) return found.error();
  return without_blow_outs(recording, *found);
}

}  // namespace wisp
