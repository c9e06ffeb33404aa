#include "learn/flame/extinction_report.hpp"

#include "record/number_text.hpp"

namespace wisp {
namespace {

const char* word_of(Origin origin) {
  return origin == Origin::kLearned ? "learned" : origin == Origin::kGiven ? "given" : "default";
}

std::string sentence_of(const Extinction& rule) {
  const double twice = rule.seconds / (1 + rule.haste);
  return "wind of " + number_text(rule.level, 3) + " puts it out in " + number_text(rule.seconds, 2) + " s" +
         (rule.haste > 0 ? ", of twice that in " + number_text(twice, 2) + " s" : "");
}

// The fields of a mode whose size is a ramp: seconds, events, seconds_ci95, error.
std::vector<ReportValue> ramp_cells(double seconds, const RampTraining& made) {
  if (made.origin != Origin::kLearned) return {seconds, {}, {}, {}};
  return {seconds, made.events, ReportList{made.seconds_ci95[0], made.seconds_ci95[1]}, made.error};
}

std::vector<ReportValue> mode_row(const char* name, const char* moves, ReportValue source,
                                  const std::vector<ReportValue>& ramp, const char* starts, std::string ends) {
  std::vector<ReportValue> row{name, moves, std::move(source)};
  row.insert(row.end(), ramp.begin(), ramp.end());
  row.insert(row.end(), {starts, std::move(ends)});
  return row;
}

ReportTable modes_of(const Model& model) {
  const Extinction& rule = *model.extinction;
  const ExtinctionTraining made = model.training.extinction.value_or(ExtinctionTraining{});
  const std::vector<ReportValue> none(4);
  ReportTable table{"extinction.modes",
                    "modes",
                    {{"name", "mode"},
                     {"moves", "what moves"},
                     {"source", "source"},
                     {"seconds", "takes", "s"},
                     {"events", "events"},
                     {"seconds_ci95", "95 %", "s"},
                     {"error", ""},
                     {"starts", "starts"},
                     {"ends", "ends"}},
                    {}};
  table.rows = {
      mode_row("burning", "the dynamics", word_of(made.origin), none, "in full size", sentence_of(rule)),
      mode_row("dying", "its size, in a straight line to nothing", word_of(made.decay.origin),
               ramp_cells(rule.decay, made.decay), "in the shape of its last step", "with nothing left"),
      mode_row("out", "nothing", {}, none, "with nothing left", "when it is lit"),
      mode_row("catching", "the dynamics, its size in a straight line to all of it", word_of(made.re_ignition.origin),
               ramp_cells(rule.re_ignition, made.re_ignition), "from rest and unharmed", "in full size")};
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

}  // namespace

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
  if (learned->fit) {
    const auto& level = learned->fit->level_range;
    const auto& seconds = learned->fit->seconds_range;
    section.entries.push_back({"extinction.level_range", ReportList{level[0], level[1]}, "levels that do as well", ""});
    section.entries.push_back(
        {"extinction.seconds_range", ReportList{seconds[0], seconds[1]}, "durations that do as well", "s"});
  }
  return section;
}

ReportSection extinction_section(const std::optional<JudgedExtinction>& judged) {
  if (!judged) return {"", {{"extinction", {}, "", ""}}};
  ReportSection section{"Extinction"};
  add_agreement(judged->agreement, "extinction", section);
  section.entries.push_back({"extinction.unexplained", judged->unexplained, "", ""});
  return section;
}

}  // namespace wisp
