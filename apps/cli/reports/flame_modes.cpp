#include "reports/flame_modes.hpp"

#include "reports/blow_out_learning.hpp"

namespace wisp::cli {
namespace {

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

RampTraining set_ramp(const std::optional<RampFit>& fit, double& seconds) {
  if (!fit) return {};
  seconds = fit->seconds;
  return {Origin::kLearned, static_cast<std::uint32_t>(fit->events), fit->seconds_ci95, fit->error};
}

const char* word_of(Origin origin) {
  return origin == Origin::kLearned ? "learned" : origin == Origin::kGiven ? "given" : "default";
}

Json ramp_json(const char* name, const char* moves, double seconds, const RampTraining& made) {
  Json out = {{"name", name}, {"moves", moves}, {"seconds", number(seconds)}, {"source", word_of(made.origin)}};
  if (made.origin != Origin::kLearned) return out;
  out["events"] = made.events;
  out["seconds_ci95"] = {number(made.seconds_ci95[0]), number(made.seconds_ci95[1])};
  out["error"] = number(made.error);
  return out;
}

std::string origin_of(const Json& ramp, const char* events) {
  if (ramp["source"] != "learned") return "the default";
  return "learned from " + ramp["events"].dump() + " " + events + ": " +
         shown(ramp["seconds_ci95"][0].get<double>(), 2) + " to " + shown(ramp["seconds_ci95"][1].get<double>(), 2) +
         " s";
}

Json judged_ramp(SizeChange change, double seconds, double usual, std::span<const SizeCurve> curves) {
  return {{"events", curves.size()},
          {"error", number(ramp_error(change, seconds, curves))},
          {"default_error", number(ramp_error(change, usual, curves))}};
}

}  // namespace

Result<LearnedRamps> learn_ramps(std::span<const ExtinctionEvidence> evidence) {
  const auto dying = curves_of(evidence, SizeChange::kDying);
  if (!dying) return dying.error();
  const auto catching = curves_of(evidence, SizeChange::kCatching);
  if (!catching) return catching.error();
  return LearnedRamps{learn_ramp(SizeChange::kDying, *dying), learn_ramp(SizeChange::kCatching, *catching)};
}

void set_ramps(const LearnedRamps& ramps, Model& model) {
  model.training.extinction->dying = set_ramp(ramps.dying, model.extinction->dying);
  model.training.extinction->catching = set_ramp(ramps.catching, model.extinction->catching);
}

Json modes_of(const Model& model) {
  const Extinction& rule = *model.extinction;
  const ExtinctionTraining made = model.training.extinction.value_or(ExtinctionTraining{});
  Json dying = ramp_json("dying", "its size, in a straight line to nothing", rule.dying, made.dying);
  Json catching =
      ramp_json("catching", "the dynamics, its size in a straight line to all of it", rule.catching, made.catching);
  dying.update({{"starts", "in the shape of its last step"}, {"ends", "with nothing left"}});
  catching.update({{"starts", "from rest and unharmed"}, {"ends", "in full size"}});
  return {{{"name", "burning"},
           {"moves", "the dynamics"},
           {"source", word_of(made.origin)},
           {"starts", "in full size"},
           {"ends", sentence_of(rule)}},
          std::move(dying),
          {{"name", "out"}, {"moves", "nothing"}, {"starts", "with nothing left"}, {"ends", "when it is lit"}},
          std::move(catching)};
}

std::vector<std::string> mode_lines(const Model& model) {
  const Json modes = modes_of(model);
  const auto ramp = [](const Json& mode, const char* does, const char* events) {
    return mode["name"].get<std::string>() + ": " + does + " in " + shown(mode["seconds"].get<double>(), 2) + " s (" +
           origin_of(mode, events) + "), " + mode["starts"].get<std::string>();
  };
  return {"burning: until it is blown out (" +
              (modes[0]["source"] == "learned"
                   ? "learned from " + std::to_string(model.training.extinction->deaths) + " deaths"
                   : modes[0]["source"].get<std::string>()) +
              ")",
          ramp(modes[1], "shrinks to nothing", "deaths"), "out: until it is lit",
          ramp(modes[3], "grows to its full size", "lightings")};
}

Result<Json> judged_ramps(const Extinction& rule, const ExtinctionEvidence& evidence) {
  const Extinction usual;
  const auto dying = curves_of(std::span(&evidence, 1), SizeChange::kDying);
  if (!dying) return dying.error();
  const auto catching = curves_of(std::span(&evidence, 1), SizeChange::kCatching);
  if (!catching) return catching.error();
  return Json{{"dying", judged_ramp(SizeChange::kDying, rule.dying, usual.dying, *dying)},
              {"catching", judged_ramp(SizeChange::kCatching, rule.catching, usual.catching, *catching)}};
}

}  // namespace wisp::cli
