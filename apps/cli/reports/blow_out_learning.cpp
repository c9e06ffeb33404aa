#include "reports/blow_out_learning.hpp"

#include <cstdlib>

#include "reports/figures_json.hpp"
#include "reports/flame_modes.hpp"
#include "wisp/learn/validation.hpp"
#include "wisp/run/cost.hpp"

namespace wisp::cli {
namespace {

Json json_of(const ExtinctionAgreement& found) {
  return {{"deaths", found.deaths},
          {"died", found.died},
          {"gusts", found.gusts},
          {"spared", found.spared},
          {"median_off_ms", number(1000 * found.median_off())},
          {"strongest_survived", number(found.strongest_survived)}};
}

std::string sentence_of(const ExtinctionAgreement& found) {
  return std::to_string(found.died) + " of " + std::to_string(found.deaths) + " deaths" +
         (found.died ? " (within " + shown(1000 * found.median_off(), 2) + " ms in the middle)" : "") + ", " +
         std::to_string(found.spared) + " of " + std::to_string(found.gusts) + " gusts survived";
}

double scale_of(const OutlineSummary& summary, const std::string& input) {
  for (const OutlineInput& each : summary.inputs) {
    if (each.name == input) return each.scale;
  }
  return 1;
}

std::size_t index_of(const Model& model, const std::string& input) {
  std::size_t index = 0;
  while (index < model.inputs.size() && model.inputs[index].name != input) ++index;
  return index;
}

// Missing in a recording without anyone having blown.
std::size_t unexplained(const std::vector<ExtinctionEvidence>& evidence) {
  std::size_t count = 0;
  for (const ExtinctionEvidence& each : evidence) {
    for (const BlowOut& blow_out : each.blow_outs) count += blow_out.blown ? 0 : 1;
  }
  return count;
}

// A rule and where it comes from.
struct Chosen {
  Extinction rule;
  Origin origin;
  std::optional<ExtinctionFit> fit;

  std::string source() const {
    return origin == Origin::kLearned ? "learned" : origin == Origin::kGiven ? "given" : "default";
  }
};

Chosen choose(const BlowOutWish& wish, const std::vector<ExtinctionEvidence>& evidence, Terminal& terminal) {
  if (wish.source == BlowOutSource::kGiven) return {wish.given, Origin::kGiven, {}};
  auto learned = learn_extinction(evidence);
  if (learned) return {learned->rule, Origin::kLearned, *learned};
  const Extinction rule = extinction_beyond(evidence);
  if (agreement(rule, evidence).deaths > 0) terminal.warn(learned.error().message);
  return {rule, Origin::kDefault, {}};
}

}  // namespace

Flag blow_out_flag(const std::string& fallback) {
  return {"blow-out", Kind::kText, "auto|off|LEVEL,SECONDS", fallback,
          "what wind puts it out: learned where the recordings have it and else twice the strong wind of training "
          "(auto), nothing (off), or any wind of LEVEL (1: the 95th percentile of training) for SECONDS"};
}

Result<BlowOutWish> blow_out_wish(const Arguments& arguments) {
  const std::string& text = arguments.text("blow-out");
  if (text == "off") return BlowOutWish{};
  if (text == "auto") return BlowOutWish{BlowOutSource::kAuto, {}};
  BlowOutWish wish{BlowOutSource::kGiven, {.haste = 0}};
  char* end = nullptr;
  wish.given.level = std::strtod(text.c_str(), &end);
  const bool comma = end != text.c_str() && *end == ',';
  const char* second = comma ? end + 1 : end;
  if (comma) wish.given.seconds = std::strtod(second, &end);
  if (!comma || end == second || *end != 0) {
    return Error{"--blow-out: found \"" + text + "\", expected auto, off, or LEVEL,SECONDS such as 1.5,0.3"};
  }
  wish.given.recovery = wish.given.seconds;
  if (auto ok = check(wish.given, 1); !ok) return Error{"--blow-out: " + ok.error().message};
  return wish;
}

Result<BlowOuts> BlowOuts::find(std::vector<Recording> recordings, const BlowOutWish& wish) {
  BlowOuts out;
  const auto inputs = channels_with_role(recordings.front(), Role::kInput);
  if (wish.source != BlowOutSource::kOff && !inputs.empty()) {
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

std::vector<ExtinctionEvidence> BlowOuts::evidence(double scale, double dying) const {
  std::vector<ExtinctionEvidence> out;
  for (std::size_t k = 0; k < recordings_.size(); ++k) {
    out.push_back({&recordings_[k], input_, scale, found_[k], dying});
  }
  return out;
}

Result<void> BlowOuts::complete(OutlineFit& fit, const BlowOutWish& wish, Terminal& terminal) const {
  terminal.result()["extinction"] = nullptr;
  const std::size_t index = index_of(fit.model, input_);
  if (wish.source == BlowOutSource::kGiven && index == fit.model.inputs.size()) {
    return Error{"the recordings have no input that could blow it out; leave --blow-out away"};
  }
  if (wish.source == BlowOutSource::kOff || index == fit.model.inputs.size()) return {};
  const double scale = scale_of(fit.summary, input_);
  const auto ramps = learn_ramps(evidence(scale, 0));
  if (!ramps) return ramps.error();
  const auto seen = evidence(scale, ramps->dying ? ramps->dying->seconds : 0);
  Chosen chosen = choose(wish, seen, terminal);
  chosen.rule.input = index;
  fit.model.extinction = chosen.rule;
  const ExtinctionAgreement found = agreement(chosen.rule, seen);
  const auto count = [](std::size_t value) { return static_cast<std::uint32_t>(value); };
  fit.model.training.extinction = ExtinctionTraining{.origin = chosen.origin,
                                                     .deaths = count(found.deaths),
                                                     .died = count(found.died),
                                                     .gusts = count(found.gusts),
                                                     .spared = count(found.spared)};
  set_ramps(*ramps, fit.model);
  const auto cost = count_operations(fit.model);
  if (!cost) return cost.error();
  fit.summary.cost = *cost;

  Json json = cli::json_of(fit.model.extinction, fit.model);
  json["source"] = chosen.source();
  json["agreement"] = json_of(found);
  json["unexplained"] = unexplained(seen);
  if (chosen.fit) {
    json["level_range"] = {number(chosen.fit->level_range[0]), number(chosen.fit->level_range[1])};
    json["seconds_range"] = {number(chosen.fit->seconds_range[0]), number(chosen.fit->seconds_range[1])};
  }
  terminal.result()["extinction"] = std::move(json);
  terminal.say("blow-out (" + chosen.source() + "): " + cli::sentence_of(chosen.rule) + "; it gets " +
               sentence_of(found));
  for (const std::string& line : mode_lines(fit.model)) terminal.say("mode " + line);
  return {};
}

Result<Recording> burning_part(const Model& model, const Recording& recording) {
  if (!model.extinction) return recording;
  const auto found = find_blow_outs(recording, model.inputs[model.extinction->input].name);
  if (!found) return found.error();
  return without_blow_outs(recording, *found);
}

Result<Json> judged_extinction(const Model& model, const Recording& recording, bool own_scale) {
  if (!model.extinction) return Json(nullptr);
  const std::string& input = model.inputs[model.extinction->input].name;
  auto blow_outs = find_blow_outs(recording, input);
  if (!blow_outs) return blow_outs.error();
  const auto trained = trained_scale(model, input);
  if (!trained) return trained.error();
  double scale = *trained;
  if (own_scale) {
    const Recording burning = without_blow_outs(recording, *blow_outs);
    const auto own = scaled_input(std::span(&burning, 1), input);
    if (!own) return own.error();
    scale = own->scale;
  }
  const ExtinctionEvidence evidence{&recording, input, scale, *std::move(blow_outs), model.extinction->dying};
  Json json = json_of(agreement(*model.extinction, std::span(&evidence, 1)));
  const auto ramps = judged_ramps(*model.extinction, evidence);
  if (!ramps) return ramps.error();
  json.update(*ramps);
  json["unexplained"] = unexplained({evidence});
  return json;
}

Json json_of(const std::optional<Extinction>& rule, const Model& model) {
  if (!rule) return nullptr;
  return {{"input", model.inputs[rule->input].name}, {"level", number(rule->level)},
          {"seconds", number(rule->seconds)},        {"haste", number(rule->haste)},
          {"recovery", number(rule->recovery)},      {"modes", modes_of(model)}};
}

std::string sentence_of(const Extinction& rule) {
  const double twice = rule.seconds / (1 + rule.haste);
  return "wind of " + shown(rule.level) + " puts it out in " + shown(rule.seconds, 2) + " s" +
         (rule.haste > 0 ? ", of twice that in " + shown(twice, 2) + " s" : "");
}

}  // namespace wisp::cli
