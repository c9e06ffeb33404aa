#include "learn/outline/learn_outline.hpp"

#include "learn/flame/extinction_learning.hpp"
#include "learn/flame/extinction_report.hpp"
#include "learn/flame/wind_gain.hpp"
#include "learn/outline/outline_fit.hpp"
#include "learn/outline/outline_report.hpp"
#include "record/verdict.hpp"

namespace wisp {
namespace {

ReportSection gain_section(const WindGain& gain) {
  if (gain.factors.empty()) return {"", {{"gain", {}, "", ""}}};
  return {"Gain of the inputs",
          {{"gain.one", gain.common, "", ""},
           {"gain.factors", gain.factors, "", ""},
           {"gain.held_out_error.one", gain.common_error, "", ""},
           {"gain.held_out_error.own", gain.own_error, "", ""},
           {"gain.reason", gain.reason, "chosen as", ""}}};
}

// What is learned from: all recordings on one scale, or each on its own.
Result<ExtinguishedRecordings> on_chosen_scale(std::span<const Recording> recordings, const OutlineRecipe& recipe,
                                               const Progress& progress, WindGain& gain) {
  auto own = ExtinguishedRecordings::find({recordings.begin(), recordings.end()}, recipe.extinction);
  if (!own) return own.error();
  auto chosen = choose_wind_gain(own->burning(), recipe, progress);
  if (!chosen) return chosen.error();
  gain = *std::move(chosen);
  if (!gain.common) return own;
  auto common = at_common_gain({recordings.begin(), recordings.end()});
  if (!common) return common.error();
  return ExtinguishedRecordings::find(*std::move(common), recipe.extinction);
}

// However well a model follows an outline, it is no better than the outline.
void refuse_what_capture_refused(std::span<const Recording> recordings, OutlineFit& fit) {
  for (const Recording& recording : recordings) {
    const auto verdict = verdict_of(recording);
    if (!verdict || verdict->usable) continue;
    fit.summary.usable = {false, recording.source + " was captured as not usable: " + verdict->reason};
    fit.model.training.usable = fit.summary.usable;
    return;
  }
}

}  // namespace

Result<Fit> learn_outline(std::span<const Recording> recordings, const OutlineRecipe& recipe,
                          const Progress& progress) {
  if (recordings.empty()) return Error{"there is no recording to learn from; expected at least one"};
  WindGain gain;
  const auto seen = on_chosen_scale(recordings, recipe, progress, gain);
  if (!seen) return seen.error();
  auto fit = fit_outline(seen->burning(), recipe, progress);
  if (!fit) return fit.error();
  const auto extinction = seen->complete(fit->model, recipe.extinction);
  if (!extinction) return extinction.error();
  refuse_what_capture_refused(recordings, *fit);
  Report report;
  report.verdict = ReportVerdict{fit->summary.usable.verdict, fit->summary.usable.reason};
  report.warnings = fit->summary.warnings;
  if (*extinction && (*extinction)->warning) report.warnings.push_back(*(*extinction)->warning);
  report.sections = report_sections(*fit);
  report.sections.push_back(gain_section(gain));
  report.sections.push_back(extinction_section(fit->model, *extinction));
  return Fit{std::move(fit->model), std::move(report)};
}

}  // namespace wisp
