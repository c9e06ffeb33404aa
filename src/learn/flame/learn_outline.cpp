#include "learn/flame/learn_outline.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "base/statistics.hpp"
#include "learn/flame/extinction_learning.hpp"
#include "learn/outline/outline_fit.hpp"
#include "learn/outline/outline_inputs.hpp"
#include "learn/outline/report/outline_report.hpp"
#include "record/number_text.hpp"
#include "record/verdict.hpp"

namespace wisp {
namespace {

ReportSection gain_section(const std::vector<double>& factors) {
  if (factors.empty()) return {"", {{"gain", {}, "", ""}}};
  return {"Gain of the inputs", {{"gain.factors", factors, "winds on one scale, times", ""}}};
}

// Returns whether alignments were computed and no input of any recording correlates significantly with the motion.
bool driven_by_nothing(const OutlineSummary& summary) {
  const auto stands_out = [](const InputAlignment& one) {
    return one.found.chance > 0 && std::abs(one.found.correlation) >= one.found.chance;
  };
  return !summary.alignment.empty() && std::none_of(summary.alignment.begin(), summary.alignment.end(), stands_out);
}

// Inputs that are 0 or missing throughout all recordings.
std::vector<std::string> silent_inputs(std::span<const Recording> recordings) {
  std::vector<std::string> names = input_names(recordings.front());
  const auto is_heard = [](double u) { return std::abs(u) > 0; };
  for (const Recording& recording : recordings) {
    for (const auto& [name, unit, role, samples] : recording.channels)
      if (std::any_of(samples.begin(), samples.end(), is_heard)) std::erase(names, name);
  }
  return names;
}

// Leaves out silent inputs beside others that are not (where all are silent, keeps them), and warns of inputs that are
// not learned since the first recording lacks them.
void drop_inputs(std::vector<Recording>& recordings, std::vector<std::string>& warnings) {
  for (const Recording& one : recordings) {
    for (const std::string& name : input_names(one)) {
      if (find_channel(recordings.front(), name)) continue;
      warnings.push_back(one.source + ": its input " + name + " is left out: " + recordings.front().source +
                         ", the first recording, has none");
    }
  }
  const std::vector<std::string> silent = silent_inputs(recordings);
  if (silent == input_names(recordings.front())) return;
  for (const std::string& name : silent) {
    warnings.push_back(recordings.front().source + ": its input " + name + " is 0 throughout: left out");
    for (Recording& one : recordings) std::erase_if(one.channels, [&](const Channel& c) { return c.name == name; });
  }
}

Result<OutlineFit> fit_flicker(std::span<const Recording> recordings, OutlineRecipe recipe, const std::string& why,
                               const Progress& progress) {
  recipe.inputs.emplace();
  auto fit = fit_outline(recordings, recipe, progress);
  if (fit) {
    fit->summary.warnings.push_back(why +
                                    ": learned without it, so that the model flickers but does not answer to wind; to "
                                    "teach it that, blow while you record");
  }
  return fit;
}

// Fits an outline with its inputs. Unless the caller named inputs, fits without them if all are silent, if none is
// related to the motion, or if they do not predict held-out motion: most films have sound but no blowing, speech may be
// taken for wind, and an input may seem to help by chance.
Result<OutlineFit> fit_what_drives(std::span<const Recording> recordings, const OutlineRecipe& recipe,
                                   const Progress& progress) {
  const std::vector<std::string> inputs = input_names(recordings.front());
  const bool open = !recipe.inputs && !inputs.empty();
  if (open && silent_inputs(recordings) == inputs)
    return fit_flicker(recordings, recipe, "nothing was heard as wind", progress);
  auto fit = fit_outline(recordings, recipe, progress);
  if (!open || !fit) return fit;
  const bool unrelated = driven_by_nothing(fit->summary);
  if (!unrelated && !(followed_percent(fit->summary) < kMinFollowedPercent)) return fit;
  const std::string why = unrelated ? "has nothing in common with the motion" : "does not predict the motion";
  auto flicker = fit_flicker(recordings, recipe, "what was heard as wind " + why, progress);
  if (!flicker) return flicker.error().message == kStopped ? flicker : fit;
  flicker->summary.alignment = std::move(fit->summary.alignment);
  return flicker;
}

// First row with an outline, and one past the last.
std::pair<std::size_t, std::size_t> seen_rows(const Recording& recording) {
  const auto layout = outline_layout(recording);
  std::size_t first = 0, last = recording.rows();
  const auto unseen = [&](std::size_t row) { return !layout || whole_row(recording, *layout, row).empty(); };
  while (first < last && unseen(first)) ++first;
  while (first < last && unseen(last - 1)) --last;
  return {first, last};
}

// Fits the recordings. If a single film without inputs is refused because its play moves much more or less (a flame
// lit, shaded or blown at in part of the film), fits parts of it: three quarters of its rows, at start, middle and end,
// then halves. Of the first length with usable parts, takes the part whose play keeps its spread best.
Result<OutlineFit> fit_steady(std::span<const Recording> recordings, const OutlineRecipe& recipe,
                              const Progress& progress) {
  auto whole = fit_what_drives(recordings, recipe, progress);
  const bool refused = whole && (whole->summary.code == "still" || whole->summary.code == "wild");
  if (!refused || recordings.size() > 1 || !whole->summary.inputs.empty()) return whole;
  OutlineRecipe without_inputs = recipe;
  without_inputs.inputs.emplace();
  const auto [begin, end] = seen_rows(recordings.front());
  const auto rows = static_cast<double>(end - begin);
  const auto off = [](const OutlineFit& fit) { return std::abs(std::log(median(fit.summary.trial.sd_ratio))); };
  std::optional<OutlineFit> best;
  for (const double share : {0.75, 0.5}) {
    for (const double place : {0.0, 0.5, 1.0}) {
      const auto first = begin + static_cast<std::size_t>(place * (1 - share) * rows);
      const auto last = first + static_cast<std::size_t>(share * rows);
      const Recording part = slice(recordings.front(), first, last);
      auto fit = fit_outline({&part, 1}, without_inputs, progress);
      if (!fit && fit.error().message == kStopped) return fit;
      if (!fit || !fit->summary.usable.verdict || (best && off(*best) <= off(*fit))) continue;
      fit->summary.usable.reason += "; learned from frames " + std::to_string(first + 1) + " to " +
                                    std::to_string(last) + " of " + std::to_string(recordings.front().rows()) +
                                    " alone: learned from all, it moves " +
                                    number_text(median(whole->summary.trial.sd_ratio), 2) + " times as much";
      best = *std::move(fit);
    }
    if (best) break;
  }
  if (!best) return whole;
  best->summary.alignment = std::move(whole->summary.alignment);
  best->summary.warnings = std::move(whole->summary.warnings);
  best->model.training.usable = best->summary.usable;
  return *std::move(best);
}

// Adds to the verdict which events the recordings lack, so that play borrows them from a simulated candle.
void note_what_is_borrowed(OutlineFit& fit) {
  if (!fit.model.extinction || !fit.summary.usable.verdict) return;
  const bool dying = fit.model.extinction->dying.empty(), catching = fit.model.extinction->catching.empty();
  if (!dying && !catching) return;
  fit.summary.usable.reason += std::string("; how it ") + (dying ? "goes out" : "") +
                               (dying && catching ? " and " : "") + (catching ? "catches" : "") +
                               " is borrowed from a simulated candle";
  fit.model.training.usable = fit.summary.usable;
}

// Checks that rates agree within 0.1 %: clocks and rounded periods may differ by that much.
Result<void> check_same_rate(const Recording& one, const Recording& first) {
  if (std::abs(one.rate_hz - first.rate_hz) <= 1e-3 * first.rate_hz) return {};
  return Error{one.source + ": has " + number_text(one.rate_hz, 6) + " frames a second, " + first.source + " " +
               number_text(first.rate_hz, 6) + ": learn from films of one rate"};
}

// Stores the first visible candle of the films: its width in flame heights, and its colour.
void keep_candle(std::span<const Recording> recordings, Training& training) {
  for (const Recording& recording : recordings) {
    const auto look = numbers_attribute(recording, "candle");
    if (!look || !*look || (*look)->size() != 4) continue;
    for (std::size_t k = 0; k < 4; ++k) training.figures.push_back({kCandleFigures[k], (**look)[k]});
    return;
  }
}

}  // namespace

Result<Fit> learn_outline(std::span<const Recording> recordings, const OutlineRecipe& recipe,
                          const Progress& progress) {
  if (recordings.empty()) return Error{"there is no recording to learn from; expected at least one"};
  for (const Recording& one : recordings) {
    if (auto ok = check_same_rate(one, recordings.front()); !ok) return ok.error();
  }
  const auto factors = common_gain_factors(recordings);
  if (!factors) return factors.error();
  auto on_one_scale = at_common_gain({recordings.begin(), recordings.end()});
  if (!on_one_scale) return on_one_scale.error();
  Report report;
  for (Recording& recording : *on_one_scale) {
    recording.rate_hz = recordings.front().rate_hz;  // within the tolerance of check_same_rate()
    const std::size_t removed = remove_jumps(recording);
    if (removed == 0) continue;
    report.warnings.push_back(recording.source + ": " + std::to_string(removed) +
                              " outlines lie far from those around them, as nothing moves: left out");
  }
  if (!recipe.inputs) drop_inputs(*on_one_scale, report.warnings);
  const auto seen = ExtinguishedRecordings::find(*std::move(on_one_scale), recipe);
  if (!seen) return seen.error();
  auto fit = fit_steady(seen->burning(), recipe, progress);
  if (!fit) return fit.error();
  const auto extinction = seen->complete(fit->model, recipe.extinction);
  if (!extinction) return extinction.error();
  note_what_is_borrowed(*fit);
  keep_candle(recordings, fit->model.training);
  if (const auto why = refused_by_capture(recordings)) {
    fit->summary.usable = fit->model.training.usable = {false, *why};
    fit->summary.code = "capture";
  }
  report.verdict = ReportVerdict{fit->summary.usable.verdict, fit->summary.usable.reason, fit->summary.code};
  for (const std::string& warning : fit->summary.warnings) report.warnings.push_back(warning);
  if (*extinction && (*extinction)->warning) report.warnings.push_back(*(*extinction)->warning);
  report.sections = report_sections(*fit);
  report.sections.push_back(gain_section(*factors));
  if (find_attribute(recordings[0], "azimuths"))
    report.sections.push_back({"Symmetry", {symmetry_entry(recordings[0])}});
  report.sections.push_back(extinction_section(fit->model, *extinction));
  return Fit{std::move(fit->model), std::move(report)};
}

}  // namespace wisp
