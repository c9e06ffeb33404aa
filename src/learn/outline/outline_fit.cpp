#include "learn/outline/outline_fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/statistics.hpp"
#include "learn/outline/outline_shape.hpp"
#include "learn/outline/outline_synthesis.hpp"
#include "learn/outline/resampled_residuals.hpp"
#include "record/number_text.hpp"

namespace wisp {
namespace {

constexpr std::size_t kWindows = 120;  // maximum per side of an energy distance: accurate to 0.01, computed in 10 ms
constexpr double kPlayed = 30;         // minimum duration of play, seconds
constexpr double kJudged = 10;         // minimum duration of a recording whose spread is judged, seconds
constexpr std::size_t kMaxRecorded = 2000;  // maximum number of recorded outlines used for comparison
constexpr std::size_t kMaxPlayed = 500;     // maximum number of played outlines used for comparison
constexpr std::size_t kPlaces = 12;         // points per outline

double unsteadiness(const PreparedOutlines& prepared) {
  double neighbours = 0, any = 0;
  for (const Recording& recording : prepared.recordings) {
    for (const std::string& name : prepared.channels.outputs) {
      const std::vector<double>& all = samples_of(recording, name);
      std::vector<double> steps;
      for (std::size_t k = 1; k < all.size(); ++k) {
        if (!std::isnan(all[k] - all[k - 1])) steps.push_back((all[k] - all[k - 1]) * (all[k] - all[k - 1]));
      }
      neighbours += mean(steps);
      any += 2 * std::pow(deviation(present(all)), 2);
    }
  }
  return any > 0 ? neighbours / any : 0;
}

// Index of the recording with most motion; a calm recording would not show the effect of the inputs, nor would one
// without a complete row.
std::size_t liveliest(const PreparedOutlines& prepared) {
  std::vector<double> motion;
  for (const Recording& recording : prepared.recordings) {
    double& sum = motion.emplace_back(0.0);
    if (complete_rows({&recording, 1}, prepared.channels) == 0) continue;
    for (const std::string& name : prepared.channels.outputs) sum += deviation(present(samples_of(recording, name)));
  }
  return static_cast<std::size_t>(std::max_element(motion.begin(), motion.end()) - motion.begin());
}

using Outline = std::vector<OutlinePoint>;

// Outlines of at most `most` equally spaced rows, each as points at equal arc lengths. `crossed` receives the share of
// self-intersecting ones, `ends` the number of outlines up to the end of each recording.
std::vector<Outline> outlines(std::span<const Recording> recordings, const PreparedOutlines& prepared, std::size_t most,
                              double* crossed = nullptr, std::vector<std::size_t>* ends = nullptr) {
  const OutlineCurve curve(prepared.layout.knots, 100);
  std::size_t rows = 0, crossings = 0;
  for (const Recording& recording : recordings) rows += recording.rows();
  std::vector<Outline> out;
  const std::size_t stride = 1 + rows / most;
  for (const Recording& recording : recordings) {
    for (std::size_t row = 0; row < recording.rows(); row += stride) {
      const std::vector<double> control = whole_row(recording, prepared.layout, row);
      if (control.empty()) continue;
      const auto polyline = curve.polyline(control);
      if (crossed) crossings += crosses_itself(polyline) ? 1 : 0;
      out.push_back(at_equal_lengths(polyline, kPlaces));
    }
    if (ends) ends->push_back(out.size());
  }
  if (crossed && !out.empty()) *crossed = static_cast<double>(crossings) / static_cast<double>(out.size());
  return out;
}

// Returns the squared distance to the nearest other outline, summed over corresponding points.
double nearest(const Outline& one, std::span<const Outline> others) {
  double best = std::numeric_limits<double>::infinity();
  for (const Outline& other : others) {
    double sum = 0;
    for (std::size_t k = 0; k < one.size() && sum < best; ++k) {
      sum += std::pow(one[k][0] - other[k][0], 2) + std::pow(one[k][1] - other[k][1], 2);
    }
    best = std::min(best, sum);
  }
  return best;
}

// Computes OutlineTrial::outside. `ends`: index one past each recording's last outline.
double outside_share(std::span<const Outline> recorded, std::span<const std::size_t> ends,
                     std::span<const Outline> played) {
  std::vector<Outline> early, late;
  std::size_t next = 0;
  for (const std::size_t end : ends) {
    const std::size_t cut = next + (end - next) * 3 / 5;
    for (; next < end; ++next) (next < cut ? early : late).push_back(recorded[next]);
  }
  if (early.empty() || late.empty() || played.empty()) return 0;
  std::vector<double> own(late.size());
  std::transform(late.begin(), late.end(), own.begin(), [&](const Outline& one) { return nearest(one, early); });
  const double bound = quantile(own, 0.99);
  double count = 0;
  for (const Outline& one : played) count += nearest(one, recorded) > bound ? 1 : 0;
  return count / static_cast<double>(played.size());
}

// Plays along the inputs of a recording for at least kPlayed seconds.
Result<Synthesis> played_along(const Model& model, const PreparedOutlines& prepared, const Recording& original,
                               std::uint64_t seed) {
  const Recording driving = with_regressors(original, prepared.inputs, {});
  const std::size_t rows = std::max(original.rows(), static_cast<std::size_t>(kPlayed * model.rate_hz));
  return synthesize(model, {.rows = rows, .seed = seed, .input = &driving});
}

// Standard deviation per output, played over recorded; 1 for constant outputs.
std::vector<double> spread_ratios(const PreparedOutlines& prepared, const Recording& real, const Recording& play) {
  std::vector<double> out;
  for (const std::string& name : prepared.channels.outputs) {
    const double recorded = deviation(present(samples_of(real, name)));
    out.push_back(recorded > 0 ? deviation(samples_of(play, name)) / recorded : 1);
  }
  return out;
}

// Plays along the liveliest recording and compares play and recording. `original`: the prepared recordings in pixels.
Result<OutlineTrial> try_outline(const Model& model, const PreparedOutlines& prepared,
                                 std::span<const Recording> original, std::uint64_t seed) {
  OutlineTrial out;
  out.unsteadiness = unsteadiness(prepared);
  const std::size_t which = liveliest(prepared);
  const Recording& real = prepared.recordings[which];
  const auto play = played_along(model, prepared, original[which], seed);
  if (!play) return play.error();
  out.held_share = play->held_share;
  out.sd_ratio = spread_ratios(prepared, real, play->recording);
  std::vector<std::size_t> ends;
  const auto recorded = outlines(prepared.recordings, prepared, kMaxRecorded, &out.crossed_recorded, &ends);
  out.outside = outside_share(recorded, ends, outlines({&play->recording, 1}, prepared, kMaxPlayed, &out.crossed));
  const FidelityOptions how{.channels = prepared.channels.outputs, .max_windows = kWindows, .motion_only = true};
  if (const auto found = fidelity({&real, 1}, {&play->recording, 1}, how)) {
    if (std::isfinite(found->energy_distance.value)) out.half_second = found->energy_distance;
    if (std::isfinite(found->long_motion.value)) out.two_seconds = found->long_motion;
  }
  return out;
}

// Plays along every recording except the liveliest, which try_outline() judged. Warns where the play's spread differs
// from the recording's: gusts and draughts have too little in common for one equation.
Result<void> judge_others(const Model& model, const PreparedOutlines& prepared, std::span<const Recording> original,
                          std::uint64_t seed, std::vector<std::string>& warnings) {
  const std::size_t tried = liveliest(prepared);
  for (std::size_t k = 0; k < original.size() && !prepared.inputs.empty(); ++k) {
    if (complete_rows({&prepared.recordings[k], 1}, prepared.channels) == 0) {
      warnings.push_back(original[k].source + ": has no row with an outline and its inputs: not learned from");
      continue;
    }
    if (k == tried || static_cast<double>(original[k].rows()) < kJudged * model.rate_hz) continue;
    const auto play = played_along(model, prepared, original[k], seed);
    if (!play) return play.error();
    const double spread = median(spread_ratios(prepared, prepared.recordings[k], play->recording));
    if (spread >= 0.8 && spread <= 1.25) continue;  // the range that the report calls good
    warnings.push_back(original[k].source + ": along its input the model moves " + number_text(spread, 2) +
                       " times as much as this recording does; learn it apart from the others");
  }
  return {};
}

constexpr std::size_t kMinHeldOut = 16;  // with fewer held-out rows, history included, no figures are computed

// Moves inputs that lag the motion earlier, with a warning, and records all alignments.
Result<std::vector<Recording>> aligned(std::span<const Recording> recordings, const OutlineRecipe& recipe,
                                       OutlineSummary& summary) {
  std::vector<Recording> out;
  for (const Recording& recording : recordings) {
    const auto inputs = recipe.inputs ? *recipe.inputs : input_names(recording);
    auto one = align_outline(recording, recipe.align ? inputs : std::vector<std::string>());
    if (!one) return one.error();
    for (InputAlignment& found : one->inputs) {
      if (found.frames_moved > 0) summary.warnings.push_back(recording.source + ": " + found.note());
      summary.alignment.push_back(std::move(found));
    }
    out.push_back(std::move(one->recording));
  }
  return out;
}

// Fits dynamics to the first part of every recording and judges the dynamics on this part and on the held-out rest.
Result<void> judge(const PreparedOutlines& prepared, const OutlineRecipe& recipe, OutlineSummary& summary) {
  const OutlineParts parts = hold_out(prepared.recordings, prepared.channels, recipe.holdout);
  summary.rows_learned = complete_rows(parts.learned, prepared.channels);
  summary.rows_held_out = complete_rows(parts.held_out, prepared.channels);
  const auto dynamics = fit_dynamics(parts.learned, prepared, recipe.paper);
  if (!dynamics) return dynamics.error();
  auto learned = outline_figures(*dynamics, parts.learned, prepared);
  if (!learned) return learned.error();
  summary.learned = *std::move(learned);
  if (summary.rows_held_out < kMinHeldOut) return {};
  auto held_out = outline_figures(*dynamics, parts.held_out, prepared);
  if (held_out) summary.held_out = *std::move(held_out);
  return {};
}

Result<std::vector<double>> residual_sd(const OutlineDynamics& dynamics, const PreparedOutlines& prepared) {
  std::vector<std::vector<double>> errors(prepared.channels.outputs.size());
  for (const Recording& recording : prepared.recordings) {
    const auto predicted = predict_outline(dynamics, recording, prepared, {.steps = 1});
    if (!predicted) return predicted.error();
    for (std::size_t i = 0; i < errors.size(); ++i) {
      for (std::size_t row = 0; row < recording.rows(); ++row)
        errors[i].push_back(recording.channels[i].samples[row] - (*predicted)[i][row]);
    }
  }
  std::vector<double> out(errors.size());
  std::transform(errors.begin(), errors.end(), out.begin(), [](const auto& one) { return deviation(present(one)); });
  return out;
}

// Ranges of the outputs: the recorded range, but at least three standard deviations about the mean, since a short
// recording does not contain its full range of flicker. With a shape, outlines are also counted mirrored.
std::vector<Output> outputs_of(const PreparedOutlines& prepared, const ShapeComponents& shape) {
  const std::size_t count = prepared.channels.outputs.size();
  std::vector<std::vector<double>> seen(count);
  for (const Recording& recording : prepared.recordings) {
    for (std::size_t row = 0; row < recording.rows(); ++row) {
      const std::vector<double> control = whole_row(recording, prepared.layout, row);
      if (control.empty()) continue;
      for (std::size_t i = 0; i < count; ++i) seen[i].push_back(control[i]);
      if (shape.empty()) continue;
      std::vector<double> at = shape_coordinates(control);
      for (std::size_t k = shape.points(); k < at.size(); ++k) at[k] = 2 * shape.rest[k] - at[k];
      const std::vector<double> mirrored = control_points(at);
      for (std::size_t i = 0; i < count; ++i) seen[i].push_back(mirrored[i]);
    }
  }
  std::vector<Output> out;
  for (std::size_t i = 0; i < count; ++i) {
    const double middle = mean(seen[i]), sd = deviation(seen[i]);
    Output one{prepared.channels.outputs[i], "", std::min(quantile(seen[i], 0), middle - 3 * sd),
               std::max(quantile(seen[i], 1), middle + 3 * sd)};
    // Range in heights below which a channel (such as a base cut off by the picture's edge) counts as constant.
    constexpr double kStill = 1e-9;
    if (one.highest - one.lowest < kStill) one.lowest = one.highest = middle;
    out.push_back(std::move(one));
  }
  return out;
}

Input input_of(const OutlineInput& input, bool powers) {
  const double strongest = std::max(std::abs(input.lowest), std::abs(input.highest));
  return {input.name, number_text(input.scale, 6) + (input.unit.empty() ? "" : " " + input.unit),
          powers ? -strongest : input.lowest, powers ? strongest : input.highest,
          powers ? InputShape::kEvenOdd : InputShape::kLinear};
}

Result<Model> model_of(const PreparedOutlines& prepared, const OutlineRecipe& recipe, OutlineSummary& summary) {
  auto dynamics = fit_dynamics(prepared.recordings, prepared, recipe.paper);
  if (!dynamics) return dynamics.error();
  auto sd = residual_sd(*dynamics, prepared);
  if (!sd) return sd.error();
  summary.residual_sd = *std::move(sd);
  summary.radius = spectral_radius(dynamics->arx);
  Model model;
  model.name = recipe.name;
  model.rate_hz = prepared.recordings.front().rate_hz;
  for (const OutlineInput& input : prepared.inputs) model.inputs.push_back(input_of(input, prepared.shape.powers));
  model.outputs = outputs_of(prepared, dynamics->shape);
  model.view = OutlineView{prepared.layout.knots, 0, prepared.pixels_per_unit.front(), dynamics->shape};
  ArxModel arx = dynamics->arx;
  if (!dynamics->shape.empty()) {
    auto rows = resampled_residuals(*dynamics, prepared.recordings, prepared);
    if (!rows) return rows.error();
    summary.resampled_rows = rows->row_count();
    arx.noise.resampled = *std::move(rows);
  }
  model.dynamics = std::move(arx);
  summary.dynamics = *std::move(dynamics);
  return model;
}

}  // namespace

Result<OutlineFit> fit_outline(std::span<const Recording> recordings, const OutlineRecipe& recipe,
                               const Progress& progress) {
  constexpr const char* kStage = "learning";
  if (auto ok = check_fields(recipe); !ok) return ok.error();
  OutlineFit out;
  OutlineSummary& summary = out.summary;
  const auto in_step = aligned(recordings, recipe, summary);
  if (!in_step) return in_step.error();
  const RegressorShape shape{.powers = recipe.paper == 0};
  const auto prepared = prepare_outlines(*in_step, {recipe.inputs, shape, recipe.pixels_per_unit});
  if (!prepared) return prepared.error();
  if (!go_on(progress, kStage, 0.1)) return Error{std::string(kStopped)};
  summary.rate_hz = prepared->recordings.front().rate_hz;
  summary.inputs = prepared->inputs;
  summary.warnings.insert(summary.warnings.end(), prepared->warnings.begin(), prepared->warnings.end());
  summary.points = prepared->layout.points;
  summary.pixels_per_unit = prepared->pixels_per_unit.front();
  if (auto ok = judge(*prepared, recipe, summary); !ok) return ok.error();
  if (!go_on(progress, kStage, 0.4)) return Error{std::string(kStopped)};
  auto model = model_of(*prepared, recipe, summary);
  if (!model) return model.error();
  out.model = *std::move(model);
  if (!go_on(progress, kStage, 0.7)) return Error{std::string(kStopped)};
  auto trial = try_outline(out.model, *prepared, *in_step, recipe.seed);
  if (!trial) return trial.error();
  summary.trial = *std::move(trial);
  if (auto ok = judge_others(out.model, *prepared, *in_step, recipe.seed, summary.warnings); !ok) return ok.error();
  summary.usable = outline_verdict(summary, &summary.code);
  out.model.training = outline_training(recordings, recipe, summary);
  return out;
}

}  // namespace wisp
