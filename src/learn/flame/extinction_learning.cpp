#include "learn/flame/extinction_learning.hpp"

#include <algorithm>

#include "base/statistics.hpp"
#include "learn/outline/outline_inputs.hpp"
#include "record/number_text.hpp"

namespace wisp {
namespace {

std::string sentence_of(const Extinction& rule) {
  const double twice = rule.seconds / (1 + rule.haste);
  return "wind of " + number_text(rule.level, 3) + " puts it out in " + number_text(rule.seconds, 2) + " s" +
         (rule.haste > 0 ? ", of twice that in " + number_text(twice, 2) + " s" : "");
}

// Table of the events that a model replays: recorded, or borrowed from a simulated candle.
ReportTable modes_of(const Model& model) {
  const Extinction& rule = *model.extinction;
  ReportTable table{"extinction.modes",
                    "modes",
                    {{"name", "mode"}, {"source", "source"}, {"seconds", "takes", "s"}, {"events", "events"}},
                    {}};
  const auto add = [&](const char* name, const FlameEvents& own, const FlameEvents& played) {
    std::vector<double> seconds;
    for (std::size_t k = 0; k < played.ends.size(); ++k) {
      seconds.push_back((played.ends[k] - (k > 0 ? played.ends[k - 1] : 0)) / model.rate_hz);
    }
    table.rows.push_back({name, own.empty() ? "borrowed from a simulated candle" : "recorded",
                          median(std::move(seconds)), own.empty() ? ReportValue() : own.ends.size()});
  };
  add("dying", rule.dying, dying_of(rule, model.rate_hz));
  add("catching", rule.catching, catching_of(rule, model.rate_hz));
  return table;
}

void add_agreement(const ExtinctionAgreement& found, const std::string& id, ReportSection& section) {
  section.entries.insert(
      section.entries.end(),
      {{id + ".deaths", found.deaths, "extinctions recorded", ""},
       {id + ".died", found.died, "extinctions reproduced", "", {}, "of those recorded, within half a second"},
       {id + ".gusts", found.gusts, "gusts survived in the recording", ""},
       {id + ".spared", found.spared, "gusts survived by the rule too", ""},
       {id + ".median_off_ms", 1000 * found.median_off(), found.died > 0 ? "median timing error" : "", "ms"},
       {id + ".strongest_survived", found.strongest_survived, "strongest wind survived", "", {}, "mean over 0.15 s"}});
}

std::size_t unexplained(std::span<const ExtinctionEvidence> evidence) {
  std::size_t count = 0;
  for (const ExtinctionEvidence& each : evidence) {
    count += static_cast<std::size_t>(std::count_if(each.blow_outs.begin(), each.blow_outs.end(),
                                                    [](const BlowOut& blow_out) { return !blow_out.blown; }));
  }
  return count;
}

// Returns the rule given by the recipe, without haste and with recovery as slow as extinction.
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
  Extinction rule = extinction_beyond(evidence);
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

// The input's value in the recording that equals 1 in the model.
Result<double> scale_for(const Model& model, const Recording& recording, std::span<const BlowOut> blow_outs,
                         bool own_scale) {
  const std::string& input = model.inputs[model.extinction->input].name;
  const Recording burning = without_blow_outs(recording, blow_outs);
  const auto own = scaled_input({&burning, 1}, input);
  if (!own_scale || !own) return trained_scale(model, input);  // a calm recording has no scale
  return own->scale;
}

}  // namespace

const char* word_of(Origin origin) {
  return origin == Origin::kLearned ? "learned" : origin == Origin::kGiven ? "given" : "default";
}

ReportSection extinction_section(const Model& model) {
  if (!model.extinction) return {"", {{"extinction", {}, "", ""}}};
  const Extinction& rule = *model.extinction;
  return {"Extinction",
          {{"", sentence_of(rule), "rule", ""},
           {"extinction.input", model.inputs[rule.input].name, "", ""},
           {"extinction.level", rule.level, "", ""},
           {"extinction.seconds", rule.seconds, "", ""},
           {"extinction.haste", rule.haste, "", ""},
           {"extinction.recovery", rule.recovery, "", ""}},
          {modes_of(model)}};
}

ReportSection extinction_section(const Model& model, const std::optional<LearnedExtinction>& learned) {
  ReportSection section = extinction_section(model);
  if (!learned) return section;
  section.entries.push_back({"extinction.source", word_of(learned->origin), "source of the rule", ""});
  add_agreement(learned->agreement, "extinction.agreement", section);
  section.entries.push_back({"extinction.unexplained", learned->unexplained, "", ""});
  if (!learned->fit) return section;
  const auto& level = learned->fit->level_range;
  section.entries.push_back({"extinction.level_range", ReportList{level[0], level[1]}, "levels that do as well", ""});
  return section;
}

ReportSection extinction_section(const std::optional<JudgedExtinction>& judged) {
  if (!judged) return {"", {{"extinction", {}, "", ""}}};
  ReportSection section{"Extinction"};
  add_agreement(judged->agreement, "extinction", section);
  section.entries.push_back({"extinction.unexplained", judged->unexplained, "", ""});
  return section;
}

Result<ExtinguishedRecordings> ExtinguishedRecordings::find(std::vector<Recording> recordings,
                                                            const OutlineRecipe& outline) {
  const ExtinctionRecipe& recipe = outline.extinction;
  if (recipe.source == ExtinctionSource::kGiven) {
    if (auto ok = check(given_rule(recipe), 1, 0); !ok) return Error{"the rule of extinction: " + ok.error().message};
  }
  ExtinguishedRecordings out;
  out.pixels_per_unit_ = outline.pixels_per_unit;
  const auto inputs = channels_with_role(recordings.front(), Role::kInput);
  if (recipe.source != ExtinctionSource::kNone && !inputs.empty()) {
    const bool named =
        outline.inputs && !outline.inputs->empty() && find_channel(recordings.front(), outline.inputs->front());
    out.input_ = named ? outline.inputs->front() : recordings.front().channels[inputs.front()].name;
    const bool flicker = outline.inputs && outline.inputs->empty();
    for (const Recording& recording : recordings) {
      const bool unheard = flicker && !find_channel(recording, out.input_);
      auto found = unheard ? Result(std::vector<BlowOut>()) : find_blow_outs(recording, out.input_);
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

std::vector<ExtinctionEvidence> ExtinguishedRecordings::evidence(double scale, double vanishing) const {
  std::vector<ExtinctionEvidence> out;
  for (std::size_t k = 0; k < recordings_.size(); ++k) {
    out.push_back({&recordings_[k], input_, scale, found_[k], vanishing, pixels_per_unit_});
  }
  return out;
}

Result<std::optional<LearnedExtinction>> ExtinguishedRecordings::complete(Model& model,
                                                                          const ExtinctionRecipe& recipe) const {
  std::size_t index = 0;
  while (index < model.inputs.size() && model.inputs[index].name != input_) ++index;
  if (recipe.source == ExtinctionSource::kGiven && index == model.inputs.size()) {
    return Error{
        (input_.empty() ? "the recordings have" : input_ + " does not move the outline, so that the model has") +
        std::string(" no input that could put it out; leave the rule of extinction away")};
  }
  if (recipe.source == ExtinctionSource::kNone || index == model.inputs.size()) {
    return std::optional<LearnedExtinction>();
  }
  const double scale = model.training.inputs[index].scale;
  auto* view = std::get_if<OutlineView>(&model.view);
  auto events = recorded_events(evidence(scale, 0), view ? *view : OutlineView{});
  if (!events) return events.error();
  const auto seen = evidence(scale, events->vanishing_seconds);
  LearnedExtinction out;
  Extinction rule = choose_rule(recipe, seen, out);
  rule.input = index;
  out.agreement = agreement(rule, seen);
  out.unexplained = unexplained(seen);
  if (!events->catching.scale.empty()) make_room(events->catching, view->shape);
  rule.dying = std::move(events->dying);
  rule.catching = std::move(events->catching);
  model.extinction = std::move(rule);
  model.training.extinction = training_of(out);
  model.training.extinction->vanishing_seconds = events->vanishing_seconds;
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
  const ExtinctionEvidence evidence{&recording, input, *scale, *std::move(blow_outs),
                                    model.training.extinction ? model.training.extinction->vanishing_seconds : 0};
  return std::optional(JudgedExtinction{agreement(rule, {&evidence, 1}), unexplained({&evidence, 1})});
}

Result<Recording> burning_part(const Model& model, const Recording& recording) {
  if (!model.extinction) return recording;
  const auto found = find_blow_outs(recording, model.inputs[model.extinction->input].name);
  if (!found) return found.error();
  return without_blow_outs(recording, *found);
}

}  // namespace wisp
