#include "learn/outline/outline_fit.hpp"

#include <algorithm>

#include "base/statistics.hpp"
#include "base/verdict.hpp"
#include "learn/numeric/constants.hpp"
#include "record/loudness.hpp"
#include "record/number_text.hpp"

namespace wisp {
namespace {

// Median fit over channels for the k-th number of steps.
double typical_fit(const OutlineFigures& figures, std::size_t k) {
  std::vector<double> fits;
  for (const OutlineChannelFigures& channel : figures.channels) fits.push_back(channel.fit_percent[k]);
  return median(std::move(fits));
}

const OutlineFigures& judged_of(const OutlineSummary& summary) {
  return summary.held_out ? *summary.held_out : summary.learned;
}

// Position of a distance between its floor (0) and its ceiling (1); NaN if the ceiling is not above the floor.
double share_of_way(const std::optional<Bounded>& distance) {
  if (!distance || !(distance->ceiling > distance->floor)) return kMissing;
  return (distance->value - distance->floor) / (distance->ceiling - distance->floor);
}

// Returns the RMS of sound at which an input is 1, if all recordings state the same; else 0.
double common_one_rms(std::span<const Recording> recordings, const std::string& input) {
  double common = 0;
  for (const Recording& recording : recordings) {
    const auto rms = one_rms(recording, input);
    if (!rms || !*rms || (common > 0 && **rms != common)) return 0;
    common = **rms;
  }
  return common;
}

std::optional<bool> common_underside(std::span<const Recording> recordings) {
  const auto first = follows_underside(recordings.front());
  const bool all = std::all_of(recordings.begin(), recordings.end(),
                               [&](const Recording& one) { return follows_underside(one) == first; });
  return all ? first : std::nullopt;
}

std::vector<Criterion> criteria_of(const OutlineSummary& summary) {
  const OutlineTrial& trial = summary.trial;
  const auto rows = static_cast<double>(summary.rows_learned + summary.rows_held_out);
  const double spread = median(trial.sd_ratio);
  return {
      {rows, Bound::kAtLeast, 50,
       "learned from {figure} frames; at least {limit} are needed to tell flicker from chance: record longer", 0,
       "short"},
      {100 * trial.unsteadiness, Bound::kAtMost, 50,
       "neighbouring frames differ by {figure} % of what frames picked at random do, at most {limit}: the outline is "
       "more noise than movement; film it larger, sharper or at a higher rate",
       0, "noise"},
      // A few clamped frames are invisible: plays without foreign shapes (below) had up to 21 in 1000. A divergent play
      // has hundreds.
      {1000 * trial.held_share, Bound::kAtMost, 50,
       "playing freely it is clamped to its range in {figure} of 1000 frames, at most {limit}: record longer", 1,
       "clamped"},
      // The spread of play should be 0.8 to 1.25 of the recording's; two plays of a short recording differ by 0.1.
      {spread, Bound::kAtLeast, 0.7,
       "playing freely it moves {figure} times as much as the recording, at least {limit}: use a steady part, --frames",
       2, "still"},
      {spread, Bound::kAtMost, 1.4,
       "playing freely it moves {figure} times as much as the recording does, at most {limit}: record longer", 2,
       "wild"},
      {100 * (trial.crossed - trial.crossed_recorded), Bound::kAtMost, 1,
       "playing freely its outline crosses itself in {figure} % of frames more than in the recording, at most {limit}: "
       "film it larger, or with fewer control points",
       1, "crossed"},
      {100 * trial.outside, Bound::kAtMost, 15,
       "{figure} % of the outlines that it plays are shapes that the recording has not, at most {limit}: record longer",
       0, "foreign"},
      {share_of_way(trial.half_second), Bound::kAtMost, 1,
       "over half a second it plays no more like the recording than the recording's frames in random order do "
       "({figure} of the way from the recording's halves to those, at most {limit}): record longer",
       2, "unlike"},
      {share_of_way(trial.two_seconds), Bound::kAtMost, 1,
       "over two seconds it plays no more like the recording than the recording's frames in random order do ({figure} "
       "of the way from the recording's halves to those, at most {limit}): record longer",
       2, "unlike"},
      {followed_percent(summary), Bound::kAtLeast, kMinFollowedPercent,
       "simulated from its inputs alone the tip is followed hardly better than by its mean (fit {figure} %, at least "
       "{limit}): learn without inputs, or check their timing",
       1, "deaf"},
  };
}

}  // namespace

double followed_percent(const OutlineSummary& summary) {
  if (summary.inputs.empty()) return kMissing;
  return at_steps(judged_of(summary).steps, judged_of(summary).tip_fit_percent, kFreeRun);
}

Usable outline_verdict(const OutlineSummary& summary, std::string* code) {
  if (const auto why = first_missed(criteria_of(summary), code)) return {false, *why};
  const OutlineTrial& trial = summary.trial;
  std::string reason = "playing freely it moves " + number_text(median(trial.sd_ratio), 2) +
                       " times as much as the recording, " + number_text(100 * trial.outside, 2) +
                       " % of its outlines are shapes that the recording has not, and " +
                       number_text(100 * trial.crossed, 2) + " % cross themselves";
  if (summary.inputs.empty()) return {true, reason};
  return {true, reason + "; from the wind alone it follows the tip of " +
                    (summary.held_out ? "held-out data" : "what it learned") + " with a fit of " +
                    number_text(followed_percent(summary), 3) + " %"};
}

Training outline_training(std::span<const Recording> recordings, const OutlineRecipe& recipe,
                          const OutlineSummary& summary) {
  Training out;
  for (const Recording& recording : recordings) out.sources.push_back(recording.source);
  const OutlineTrial& trial = summary.trial;
  out.recipe = {{"paper", std::to_string(recipe.paper)}, {"holdout", number_text(recipe.holdout, 3)}};
  const OutlineFigures& judged = judged_of(summary);
  out.figures = {{"radius", summary.radius},
                 {"rows_learned", static_cast<double>(summary.rows_learned)},
                 {"rows_held_out", static_cast<double>(summary.rows_held_out)},
                 {"held_share", trial.held_share},
                 {"sd_ratio", median(trial.sd_ratio)},
                 {"crossed_share", trial.crossed},
                 {"outside_share", trial.outside},
                 {"pixels_per_unit", summary.pixels_per_unit}};
  if (trial.half_second) {
    out.figures.push_back({"play_distance", trial.half_second->value});
    out.figures.push_back({"play_distance.shuffled", trial.half_second->ceiling});
  }
  for (const OutlineInput& input : summary.inputs) {
    out.inputs.push_back({input.scale, common_one_rms(recordings, input.name)});
  }
  out.residual_sd = summary.residual_sd;
  out.underside = common_underside(recordings);
  for (std::size_t k = 0; k < judged.steps.size(); ++k) {
    const std::string steps = judged.steps[k] == kFreeRun ? "inf" : std::to_string(judged.steps[k]);
    out.figures.push_back({"fit." + steps, typical_fit(judged, k)});
    out.figures.push_back({"tip_fit." + steps, judged.tip_fit_percent[k]});
    out.figures.push_back({"overlap." + steps, judged.overlap[k]});
  }
  out.usable = summary.usable;
  return out;
}

}  // namespace wisp
