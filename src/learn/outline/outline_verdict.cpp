#include "learn/outline/outline_verdict.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "record/loudness.hpp"

namespace wisp {
namespace {

constexpr std::size_t kMinRows = 50;
// Per cent, one step ahead: a tip whose noise has half the variance of its movement comes to 100(1 − √⅓) = 42 at best.
constexpr double kMinTipFit = 40;
constexpr double kMaxUnsteadiness = 0.5;  // films of flames have 0.02 to 0.3; noise as strong as the movement 0.55
constexpr double kMinFollowed = 5;        // per cent: a short simulation fits a little by where it starts
constexpr double kMaxClamped = 1e-3;
constexpr double kMaxLossGrown = 1.2;  // of a repaired model, in variance: beyond it is another model
constexpr double kMaxSpread = 2;       // playing freely over recorded, of the typical channel, either way

std::string rounded(double value, int digits) {
  char out[64];
  std::snprintf(out, sizeof out, "%.*f", digits, value);
  return out;
}

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// The median channel's fit for a number of steps.
double typical_fit(const OutlineFigures& figures, int steps) {
  const auto at = std::find(figures.steps.begin(), figures.steps.end(), steps) - figures.steps.begin();
  std::vector<double> fits;
  for (const OutlineChannelFigures& channel : figures.channels) fits.push_back(channel.fit_percent[at]);
  return median(std::move(fits));
}

double tip_fit(const OutlineFigures& figures, int steps) {
  const auto at = std::find(figures.steps.begin(), figures.steps.end(), steps) - figures.steps.begin();
  return figures.tip_fit_percent[at];
}

double tip_absolute_fit(const OutlineFigures& figures, int steps) {
  const auto at = std::find(figures.steps.begin(), figures.steps.end(), steps) - figures.steps.begin();
  return figures.tip_absolute_fit_percent[at];
}

const char* coupling_name(OutlineCoupling coupling) {
  switch (coupling) {
    case OutlineCoupling::kCoordinate:
      return "coordinate";
    case OutlineCoupling::kPoint:
      return "point";
    case OutlineCoupling::kBand:
      return "band";
    case OutlineCoupling::kFull:
      return "full";
  }
  return "";
}

const char* noise_name(OutlineNoise noise) {
  switch (noise) {
    case OutlineNoise::kIndependent:
      return "independent";
    case OutlineNoise::kResidual:
      return "residual";
    case OutlineNoise::kMatched:
      return "matched";
    case OutlineNoise::kResampled:
      return "resampled";
  }
  return "";
}

std::vector<Note> notes(const OutlineRecipe& options, const OutlineSummary& summary) {
  const OutlineChoice& choice = summary.choice;
  return {{"order", std::to_string(choice.taken().order)},
          {"delay", std::to_string(choice.taken().delay)},
          {"order_and_delay", choice.reason},
          {"coupling", coupling_name(*options.coupling)},
          {"input_curve", std::to_string(summary.curve_choice.knots)},
          {"one_sided", options.one_sided ? "yes" : "no"},
          {"holdout", rounded(options.holdout, 3)},
          {"refit", options.refit ? "yes" : "no"},
          {"noise", noise_name(*options.noise)},
          {"shared_shocks", std::to_string(options.shared_shocks)},
          {"match_variance", options.match_variance ? "yes" : "no"}};
}

// How loud it was at 1 in all of the recordings; 0 where they differ, or one does not say.
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

// What its predictions of the next frame say against it; nothing: an empty string.
std::string unpredicted(const OutlineFigures& judged) {
  if (const double next = typical_fit(judged, 1); next <= 0) {
    return "it predicts the next frame no better than the mean does (median fit " + rounded(next, 1) + " %)";
  }
  const double typical = tip_absolute_fit(judged, 1);
  const double squared = tip_fit(judged, 1);
  if (typical >= kMinTipFit && squared >= 0) return "";
  return "it hardly predicts where the tip is next (fit " + rounded(typical, 1) + " % by absolute errors, at least " +
         rounded(kMinTipFit, 0) + ", and " + rounded(squared, 1) +
         " % by squared ones, at least 0): the tip is more noise than movement; film it larger, sharper or at a higher "
         "rate";
}

}  // namespace

int max_coefficients(const ArxOrders& orders) {
  int most = 0;
  for (int i = 0; i < orders.outputs(); ++i) most = std::max(most, orders.row_size(i));
  return most;
}

Usable outline_verdict(const ArxSummary& fit, const OutlineSummary& summary) {
  const std::size_t rows = summary.rows_learned + (summary.refitted ? summary.rows_held_out : 0);
  const OutlineFigures& judged = summary.held_out ? *summary.held_out : summary.learned;
  if (!fit.usable.verdict) return fit.usable;
  if (rows < kMinRows) {
    return {false, "learned from " + std::to_string(rows) + " frames; at least " + std::to_string(kMinRows) +
                       " are needed to tell flicker from chance: record longer"};
  }
  if (rows < static_cast<std::size_t>(kMinRowsACoefficient) * max_coefficients(summary.orders)) {
    return {false, std::to_string(max_coefficients(summary.orders)) + " coefficients an output from " +
                       std::to_string(rows) + " frames describe chance more than the thing; at least " +
                       std::to_string(kMinRowsACoefficient) +
                       " frames a coefficient are needed: record longer, or try a lower order or less coupling"};
  }
  if (summary.unsteadiness > kMaxUnsteadiness) {
    return {false, "neighbouring frames are hardly more alike than frames picked at random (they differ by " +
                       rounded(100 * summary.unsteadiness, 0) + " % of what those do, at most " +
                       rounded(100 * kMaxUnsteadiness, 0) +
                       "): the outline is more noise than movement; film it larger, sharper or at a higher rate"};
  }
  if (fit.stable.changed && fit.stable.loss_factor > kMaxLossGrown) {
    return {false, "the estimate was unstable (radius " + rounded(fit.stable.estimated, 4) +
                       ") and became another model by being made stable: try a lower order or more frames"};
  }
  if (summary.held_share > kMaxClamped) {
    return {false, "its outputs are clamped to their range in " + rounded(1000 * summary.held_share, 1) +
                       " of 1000 frames, more than 1: record longer or try a lower order"};
  }
  const double spread = median(summary.sd_ratio);
  if (!(spread < kMaxSpread && spread > 1 / kMaxSpread)) {
    return {false, "playing freely it moves " + rounded(spread, 2) +
                       " times as much as the recording does: try a lower order or less coupling"};
  }
  if (const std::string why = unpredicted(judged); !why.empty()) return {false, why};
  if (summary.play_distance && summary.play_distance->value > summary.play_distance->ceiling) {
    return {false,
            "playing freely it is farther from the recording than that recording's own frames in random order "
            "(energy distance " +
                rounded(summary.play_distance->value, 3) + ", shuffled " + rounded(summary.play_distance->ceiling, 3) +
                "): record longer, or something that moves more "
                "steadily"};
  }
  if (!summary.inputs.empty() && tip_fit(judged, kFreeRun) < kMinFollowed) {
    return {false, "simulated from its inputs alone the tip is followed hardly better than by its mean (fit " +
                       rounded(tip_fit(judged, kFreeRun), 1) + " %): learn without inputs, or check their timing"};
  }
  std::string reason = std::string("predicts the next frame of ") +
                       (summary.held_out ? "held-out data" : "what it learned") + " with a median fit of " +
                       rounded(typical_fit(judged, 1), 1) + " %, and the tip there with " +
                       rounded(tip_absolute_fit(judged, 1), 1) + " % by absolute errors";
  if (fit.stable.changed) reason += "; the estimate was unstable and was made stable at hardly any cost";
  return {true, reason};
}

Training outline_training(std::span<const Recording> recordings, const OutlineRecipe& options,
                          const OutlineSummary& summary) {
  Training out;
  for (const Recording& recording : recordings) out.sources.push_back(recording.source);
  out.recipe = notes(options, summary);
  const OutlineFigures& judged = summary.held_out ? *summary.held_out : summary.learned;
  out.figures = {{"fpe", summary.fpe},
                 {"radius", summary.stable.radius},
                 {"rows_learned", static_cast<double>(summary.rows_learned)},
                 {"rows_held_out", static_cast<double>(summary.rows_held_out)},
                 {"held_share", summary.held_share},
                 {"sd_ratio", median(summary.sd_ratio)},
                 {"pixels_per_unit", summary.pixels_per_unit}};
  if (summary.play_distance) {
    out.figures.push_back({"play_distance", summary.play_distance->value});
    out.figures.push_back({"play_distance.shuffled", summary.play_distance->ceiling});
  }
  for (const OutlineInput& input : summary.inputs) {
    out.inputs.push_back({input.scale, common_one_rms(recordings, input.name)});
  }
  for (const OutlineResidual& residual : summary.residuals) out.residual_sd.push_back(residual.sd);
  out.underside = common_underside(recordings);
  for (std::size_t k = 0; k < judged.steps.size(); ++k) {
    const std::string steps = judged.steps[k] == kFreeRun ? "inf" : std::to_string(judged.steps[k]);
    out.figures.push_back({"fit." + steps, typical_fit(judged, judged.steps[k])});
    out.figures.push_back({"tip_fit." + steps, judged.tip_fit_percent[k]});
    out.figures.push_back({"overlap." + steps, judged.overlap[k]});
  }
  out.usable = summary.usable;
  return out;
}

}  // namespace wisp
