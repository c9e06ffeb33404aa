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

constexpr std::size_t kWindows = 120;       // per side: an accuracy of 0.01 for 10 ms of computation
constexpr double kPlayed = 30;              // minimum duration of play, seconds
constexpr std::size_t kMaxRecorded = 2000;  // maximum number of recorded outlines used for comparison
constexpr std::size_t kMaxPlayed = 500;
constexpr std::size_t kPlaces = 12;  // points per outline

const std::vector<double>& channel_samples(const Recording& recording, const std::string& name) {
  return recording.channels[*find_channel(recording, name)].samples;
}

// Samples that are not missing.
std::vector<double> seen(const std::vector<double>& all) {
  std::vector<double> out;
  std::copy_if(all.begin(), all.end(), std::back_inserter(out), [](double value) { return !std::isnan(value); });
  return out;
}

double unsteadiness(const PreparedOutlines& prepared) {
  double neighbours = 0, any = 0;
  for (const Recording& recording : prepared.recordings) {
    for (const std::string& name : prepared.channels.outputs) {
      const std::vector<double>& all = channel_samples(recording, name);
      std::vector<double> steps;
      for (std::size_t k = 1; k < all.size(); ++k) {
        if (!std::isnan(all[k] - all[k - 1])) steps.push_back((all[k] - all[k - 1]) * (all[k] - all[k - 1]));
      }
      neighbours += mean(steps);
      any += 2 * std::pow(deviation(seen(all)), 2);
    }
  }
  return any > 0 ? neighbours / any : 0;
}

// Index of the recording with most motion; a calm recording would not show the effect of the inputs.
std::size_t liveliest(const PreparedOutlines& prepared) {
  std::size_t best = 0;
  double most = -1;
  for (std::size_t r = 0; r < prepared.recordings.size(); ++r) {
    double sum = 0;
    for (const std::string& name : prepared.channels.outputs)
      sum += deviation(seen(channel_samples(prepared.recordings[r], name)));
    if (sum > most) best = r, most = sum;
  }
  return best;
}

using Outline = std::vector<OutlinePoint>;

// Outlines of at most `most` equally spaced rows, each as points at equal arc lengths; also counts self-intersecting
// ones.
std::vector<Outline> outlines(std::span<const Recording> recordings, const PreparedOutlines& prepared, std::size_t most,
                              double* crossed = nullptr) {
  const OutlineCurve curve(prepared.layout.knots, 100);
  std::size_t rows = 0, crossings = 0;
  for (const Recording& recording : recordings) rows += recording.rows();
  std::vector<Outline> out;
  const std::size_t stride = 1 + rows / most;
  for (const Recording& recording : recordings) {
    const auto layout = outline_layout(recording);
    for (std::size_t row = 0; row < recording.rows(); row += stride) {
      const std::vector<double> control = whole_row(recording, *layout, row);
      if (control.empty()) continue;
      const auto polyline = curve.polyline(control);
      if (crossed) crossings += crosses_itself(polyline) ? 1 : 0;
      out.push_back(at_equal_lengths(polyline, kPlaces));
    }
  }
  if (crossed && !out.empty()) *crossed = static_cast<double>(crossings) / static_cast<double>(out.size());
  return out;
}

// Mean square distance to the nearest of the other outlines.
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

double outside_share(std::span<const Outline> recorded, std::span<const Outline> played) {
  const std::size_t cut = recorded.size() * 3 / 5;
  if (cut == 0 || cut == recorded.size() || played.empty()) return 0;
  std::vector<double> own;
  for (const Outline& one : recorded.subspan(cut)) own.push_back(nearest(one, recorded.first(cut)));
  const double bound = quantile(own, 0.99);
  double count = 0;
  for (const Outline& one : played) count += nearest(one, recorded) > bound ? 1 : 0;
  return count / static_cast<double>(played.size());
}

constexpr std::size_t kMinHeldOut = 16;  // minimum number of rows for figures, including a history of six

// Moves inputs that are late against the motion, and records which and by how many frames.
Result<std::vector<Recording>> aligned(std::span<const Recording> recordings, const OutlineRecipe& recipe,
                                       OutlineSummary& summary) {
  std::vector<Recording> out;
  for (const Recording& recording : recordings) {
    std::vector<std::string> inputs;
    if (recipe.inputs) inputs = *recipe.inputs;
    for (std::size_t c : channels_with_role(recording, Role::kInput)) {
      if (!recipe.inputs) inputs.push_back(recording.channels[c].name);
    }
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

// Judges the dynamics of the first parts on the held-out rest.
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
      for (std::size_t row = 0; row < recording.rows(); ++row) {
        const double error = recording.channels[i].samples[row] - (*predicted)[i][row];
        if (!std::isnan(error)) errors[i].push_back(error);
      }
    }
  }
  std::vector<double> out;
  for (const auto& one : errors) out.push_back(deviation(one));
  return out;
}

// Ranges of the outputs: the recorded range, but at least three standard deviations about the mean, since a short
// recording does not contain its full range of flicker. With a shape, the mirrored range too.
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
    // Relative range below which a channel (such as a base cut off by the picture's edge) counts as constant: no range.
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

// The model, learned from all rows.
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

Result<OutlineTrial> try_outline(const Model& model, const PreparedOutlines& prepared,
                                 std::span<const Recording> original, std::uint64_t seed) {
  OutlineTrial out;
  out.unsteadiness = unsteadiness(prepared);
  const std::size_t which = liveliest(prepared);
  const Recording& real = prepared.recordings[which];
  const Recording driving = with_regressors(original[which], prepared.inputs, {});
  const std::size_t rows = std::max(real.rows(), static_cast<std::size_t>(kPlayed * model.rate_hz));
  const auto play = synthesize(model, {.rows = rows, .seed = seed, .input = &driving});
  if (!play) return play.error();
  out.held_share = play->held_share;
  for (const std::string& name : prepared.channels.outputs) {
    const double recorded = deviation(seen(channel_samples(real, name)));
    out.sd_ratio.push_back(recorded > 0 ? deviation(channel_samples(play->recording, name)) / recorded : 1);
  }
  out.outside = outside_share(outlines(prepared.recordings, prepared, kMaxRecorded, &out.crossed_recorded),
                              outlines({&play->recording, 1}, prepared, kMaxPlayed, &out.crossed));
  const FidelityOptions how{.channels = prepared.channels.outputs, .max_windows = kWindows};
  if (const auto found = fidelity({&real, 1}, {&play->recording, 1}, how)) {
    out.half_second = found->energy_distance;
    out.two_seconds = found->long_motion;
  }
  return out;
}

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
  summary.usable = outline_verdict(summary, &summary.code);
  out.model.training = outline_training(recordings, recipe, summary);
  return out;
}

}  // namespace wisp
