#include "learn/outline/outline_fit.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/statistics.hpp"
#include "learn/arx/fit/arx_report.hpp"
#include "learn/arx/judge/held_out.hpp"
#include "learn/numeric/chi_squared.hpp"
#include "learn/outline/outline_components.hpp"
#include "learn/outline/outline_curve.hpp"
#include "learn/outline/outline_fidelity.hpp"
#include "learn/outline/outline_noise.hpp"
#include "learn/outline/outline_orders.hpp"
#include "learn/outline/outline_preparation.hpp"
#include "learn/outline/outline_ridge.hpp"
#include "learn/outline/outline_synthesis.hpp"
#include "learn/outline/outline_turns.hpp"
#include "learn/outline/outline_verdict.hpp"
#include "learn/outline/resampled_residuals.hpp"

namespace wisp {
namespace {

constexpr std::size_t kTrialSteps = 100000;  // the verdict is about 1 in 1000: 100 of them
constexpr std::size_t kMinHeldOut = 10;      // rows, beside a history, that figures can be made from

std::string text(double value) {
  std::string out = std::to_string(value);
  while (out.back() == '0') out.pop_back();
  if (out.back() == '.') out.pop_back();
  return out;
}

Result<void> check_options(const OutlineRecipe& options) {
  const auto refuse = [](const std::string& what, double value, const std::string& range) {
    return Error{what + " is " + text(value) + ", expected " + range};
  };
  const int order = options.order.value_or(1), delay = options.delay.value_or(0);
  if (order < 0 || order > 64) return refuse("the order", order, "0 (as fits the noise) to 64");
  if (delay < 0 || delay > 1000) return refuse("the delay", delay, "0 to 1000 frames");
  if (!(options.holdout >= 0 && options.holdout <= 0.9))
    return refuse("the held-out share", options.holdout, "0 to 0.9");
  if (const int knots = options.input_curve.value_or(0); knots != 0 && (knots < 3 || knots > 16)) {
    return refuse("the number of knots of the inputs' curve", knots, "0 (no curve) or 3 to 16");
  }
  if (options.shared_shocks < 1 || options.shared_shocks > 64) {
    return refuse("the number of shared shocks", options.shared_shocks, "1 to 64");
  }
  if (!(options.pixels_per_unit >= 0 && std::isfinite(options.pixels_per_unit))) {
    return refuse("the scale", options.pixels_per_unit, "0 or more pixels per unit");
  }
  return {};
}

// What is left open, decided.
OutlineRecipe decided(OutlineRecipe options, const PreparedOutlines& prepared) {
  constexpr double kMinDrawnSeconds = 10, kMinWholeSeconds = 20;
  double seconds = 0;
  for (const Recording& recording : prepared.recordings) {
    seconds += static_cast<double>(complete_rows(recording, prepared.channels)) / recording.rate_hz;
  }
  if (!options.noise) {
    const bool draw = !prepared.inputs.empty() && seconds >= kMinDrawnSeconds;
    options.noise = draw ? OutlineNoise::kResampled : OutlineNoise::kMatched;
  }
  const bool drawn = options.noise == OutlineNoise::kResampled;
  const bool whole = !options.light && options.mirror.value_or(true) && seconds >= kMinWholeSeconds;
  const OutlineCoupling heard = whole ? OutlineCoupling::kFull : OutlineCoupling::kCoordinate;
  if (!options.coupling) options.coupling = drawn ? heard : OutlineCoupling::kPoint;
  const bool full = options.coupling == OutlineCoupling::kFull;
  if (options.order == 0) options.order = full ? 2 : drawn ? 3 : 4;
  return options;
}

bool mirror_wanted(const OutlineRecipe& options, const PreparedOutlines& prepared) {
  return options.mirror.value_or(prepared.shape.split_sign);
}

Result<PreparedOutlines> prepared_for(std::span<const Recording> recordings, const OutlineRecipe& wanted, bool powers) {
  const RegressorShape shape{.split_sign = !wanted.one_sided, .powers = powers};
  return prepare_outlines(recordings, {wanted.inputs, shape, wanted.pixels_per_unit});
}

// Square roots and squares of inputs stand for what a curve would, where the outline moves as a whole.
bool takes_powers(const OutlineRecipe& options, const PreparedOutlines& prepared) {
  const bool bent = options.input_curve.value_or(0) != 0;
  return *options.coupling == OutlineCoupling::kFull && prepared.shape.split_sign && !bent;
}

// Recordings and, where wanted, their mirror images.
std::vector<Recording> to_learn_from(std::span<const Recording> recordings, const PreparedOutlines& prepared,
                                     const OutlineRecipe& options) {
  if (mirror_wanted(options, prepared)) return with_mirror_images(recordings, prepared);
  return {recordings.begin(), recordings.end()};
}

// Where the wind only ever came from one side, what it does from the other side is a guess, which must not spoil what
// is known: the coordinates' answers to each other are those of a flame that leans as it was recorded.
double mirror_weight(const PreparedOutlines& prepared) {
  constexpr double kGuess = 0.1;
  const auto one_side = [](const OutlineInput& input) { return input.lowest >= 0 || input.highest <= 0; };
  return std::all_of(prepared.inputs.begin(), prepared.inputs.end(), one_side) ? kGuess : 1;
}

// A frame and its mirror image are one observation: what is known of coefficients and noise is known from half as many
// rows as were fitted.
void count_frames_once(ArxFit& fitted) {
  for (auto& row : fitted.model.std_error) {
    for (double& error : row) error *= std::sqrt(2.0);
  }
  for (std::size_t i = 0; i < fitted.model.noise.sd.size(); ++i) {
    const double rows = static_cast<double>(fitted.summary.samples_used) / 2;
    const double freedom = std::max(1.0, rows - fitted.model.orders.row_size(static_cast<int>(i)));
    const double sd = fitted.model.noise.sd[i];
    fitted.model.noise.sd_ci95[i] = {sd * std::sqrt(freedom / chi_squared_quantile(0.975, freedom)),
                                     sd * std::sqrt(freedom / chi_squared_quantile(0.025, freedom))};
  }
}

// How a fit is made, beside its structure.
struct FitOptions {
  double ridge = 0;
  bool judge_free_run = true;
};

Result<ArxFit> fit(std::span<const Recording> recordings, const PreparedOutlines& prepared,
                   const OutlineRecipe& options, const OutlineSummary& summary, const FitOptions& how) {
  const OutlineCandidate& chosen = summary.choice.taken();
  const ArxOrders orders = outline_orders(chosen.order, chosen.delay, *options.coupling, prepared);
  const bool mirror = mirror_wanted(options, prepared);
  if (*options.coupling == OutlineCoupling::kFull) {
    const double weight = mirror ? mirror_weight(prepared) : 0;
    return fit_components(recordings, prepared, {orders, how.ridge, weight});
  }
  const ArxOptions arx{.orders = orders, .ridge = how.ridge, .judge_free_run = how.judge_free_run};
  const std::vector<Recording> seen = to_learn_from(recordings, prepared, options);
  auto fitted = fit_arx(seen, prepared.channels, arx);
  if (fitted && mirror) count_frames_once(*fitted);
  return fitted;
}

// One of many: without the figures of free simulation.
Result<ArxFit> fit_quickly(std::span<const Recording> recordings, const PreparedOutlines& prepared,
                           const OutlineRecipe& options, const OutlineSummary& summary, double ridge) {
  return fit(recordings, prepared, options, summary, {.ridge = ridge, .judge_free_run = false});
}

// The covariance of what the inputs alone leave unexplained: the outline's flicker.
Result<Covariance> flicker_covariance(const ArxModel& model, std::span<const Recording> recordings,
                                      const ChannelChoice& channels) {
  const auto ny = static_cast<Eigen::Index>(channels.outputs.size());
  Covariance sum = Covariance::Zero(ny, ny);
  double rows = 0;
  for (const Recording& recording : recordings) {
    const auto simulated = predict(model, recording, channels, {.steps = kFreeRun, .initial = InitialState::kZero});
    if (!simulated) return simulated.error();
    Eigen::VectorXd error(ny);
    for (std::size_t row = 0; row < recording.rows(); ++row) {
      for (Eigen::Index i = 0; i < ny; ++i) {
        const auto& measured = recording.channels[*find_channel(recording, channels.outputs[i])].samples;
        error[i] = measured[row] - (*simulated)[i][row];
      }
      if (!error.allFinite()) continue;
      sum += error * error.transpose();
      ++rows;
    }
  }
  return Covariance(sum / std::max(1.0, rows));
}

Covariance residual_covariance(const ArxFit& fitted) {
  const auto ny = static_cast<Eigen::Index>(fitted.model.noise.sd.size());
  Covariance out(ny, ny);
  for (Eigen::Index i = 0; i < ny; ++i) {
    for (Eigen::Index j = 0; j < ny; ++j) out(i, j) = fitted.summary.noise_covariance[i * ny + j];
  }
  return out;
}

void set_shared(const Eigen::MatrixXd& factor, ResidualNoise& noise) {
  std::fill(noise.sd.begin(), noise.sd.end(), 0.0);
  noise.rank = static_cast<int>(factor.cols());
  noise.mixing.clear();
  for (Eigen::Index i = 0; i < factor.rows(); ++i) {
    for (Eigen::Index r = 0; r < factor.cols(); ++r) noise.mixing.push_back(factor(i, r));
  }
}

double carried(const Covariance& shocks, const Eigen::MatrixXd& factor) {
  double share = 0;
  double channels = 0;
  for (Eigen::Index i = 0; i < shocks.rows(); ++i) {
    if (!(shocks(i, i) > 0)) continue;
    share += std::min(1.0, factor.row(i).squaredNorm() / shocks(i, i));
    ++channels;
  }
  return channels > 0 ? share / channels : 1;
}

// Gives the model its own residuals to play.
Result<void> set_drawn(std::span<const Recording> recordings, const PreparedOutlines& prepared,
                       const OutlineRecipe& options, ArxModel& model) {
  auto drawn = resampled_residuals(model, recordings, prepared,
                                   {.max_bytes = options.resampled_bytes, .mirror = mirror_wanted(options, prepared)});
  if (!drawn) return drawn.error();
  model.noise.resampled = *std::move(drawn);
  return {};
}

// Gives the model its Gaussian noise.
Result<void> set_noise(const ArxFit& fitted, std::span<const Recording> recordings, const PreparedOutlines& prepared,
                       const OutlineRecipe& options, ArxModel& model, OutlineSummary& summary) {
  const auto wanted = flicker_covariance(model, recordings, prepared.channels);
  if (!wanted) return wanted.error();
  summary.shared_variance = 1;
  Eigen::MatrixXd factor;
  if (options.noise == OutlineNoise::kIndependent) {
    factor = Eigen::Map<const Eigen::VectorXd>(model.noise.sd.data(), wanted->rows()).asDiagonal();
  } else {
    const bool apart = options.coupling == OutlineCoupling::kPoint || options.coupling == OutlineCoupling::kCoordinate;
    const bool matched = options.noise == OutlineNoise::kMatched && apart;
    const Covariance shocks = matched ? shocks_for(model, *wanted) : residual_covariance(fitted);
    factor = shared_factor(shocks, options.shared_shocks);
    summary.shared_variance = carried(shocks, factor);
  }
  if (options.match_variance) summary.variance_matched = scale_to_variance(model, *wanted, factor);
  if (options.noise != OutlineNoise::kIndependent) {
    set_shared(factor, model.noise);
    return {};
  }
  for (std::size_t i = 0; i < model.noise.sd.size(); ++i) model.noise.sd[i] = factor(i, i);
  return {};
}

// What was seen, and at least three standard deviations of it about the mean: a short recording has not seen all of its
// own flicker.
Output output_of(const std::string& name, std::span<const Recording> recordings) {
  Output out{name, "", std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  double count = 0;
  double sum = 0;
  double square = 0;
  for (const Recording& recording : recordings) {
    for (double value : recording.channels[*find_channel(recording, name)].samples) {
      if (std::isnan(value)) continue;
      out.lowest = std::min(out.lowest, value);
      out.highest = std::max(out.highest, value);
      sum += value;
      square += value * value;
      ++count;
    }
  }
  const double mean = sum / count;
  const double sd = std::sqrt(std::max(0.0, square / count - mean * mean));
  out.lowest = std::min(out.lowest, mean - 3 * sd);
  out.highest = std::max(out.highest, mean + 3 * sd);
  // A channel that never moves (a base cut off by the picture's edge) keeps only what rounding left of it: no range.
  constexpr double kStill = 1e-9;
  if (out.highest - out.lowest < kStill) out.lowest = out.highest = mean;
  return out;
}

InputShape input_shape(RegressorShape shape) {
  if (shape.powers) return InputShape::kSplitSignPowers;
  if (shape.curve) return shape.split_sign ? InputShape::kSplitSignCurve : InputShape::kCurve;
  return shape.split_sign ? InputShape::kSplitSign : InputShape::kLinear;
}

Input input_of(const OutlineInput& input, RegressorShape shape) {
  const double strongest = std::max(std::abs(input.lowest), std::abs(input.highest));
  return {input.name,
          text(input.scale) + (input.unit.empty() ? "" : " " + input.unit),
          shape.split_sign ? -strongest : input.lowest,
          shape.split_sign ? strongest : input.highest,
          input_shape(shape),
          input.curve};
}

Model model_of(const ArxModel& arx, const PreparedOutlines& prepared, const OutlineRecipe& options) {
  Model model;
  model.name = options.name;
  model.rate_hz = prepared.recordings.front().rate_hz;
  for (const OutlineInput& input : prepared.inputs) model.inputs.push_back(input_of(input, prepared.shape));
  const auto seen = to_learn_from(prepared.recordings, prepared, options);
  for (const std::string& name : prepared.channels.outputs) model.outputs.push_back(output_of(name, seen));
  model.dynamics = arx;
  model.view = OutlineView{prepared.layout.knots, 0, prepared.pixels_per_unit.front()};
  return model;
}

// Fewer rows than coefficients and their history leave nothing to judge.
Result<void> check_rows(const PreparedOutlines& prepared, const OutlineRecipe& options) {
  const ArxOrders orders =
      outline_orders(options.order.value_or(1), options.delay.value_or(0), *options.coupling, prepared);
  int coefficients = 0;
  for (int i = 0; i < orders.outputs(); ++i) coefficients = std::max(coefficients, orders.row_size(i));
  std::size_t rows = 0;
  for (const Recording& recording : prepared.recordings) rows += complete_rows(recording, prepared.channels);
  const auto least = static_cast<std::size_t>(2 * (coefficients + orders.history()));
  if (rows >= least) return {};
  return Error{prepared.recordings.front().source + ": has " + std::to_string(rows) + " complete rows, and " +
               std::to_string(coefficients) + " coefficients an output need at least " + std::to_string(least) +
               "; record longer or lower the order"};
}

// Inputs that come too late are moved; which ones, and by how much, is noted.
Result<std::vector<Recording>> aligned(std::span<const Recording> recordings, const OutlineRecipe& options,
                                       OutlineSummary& summary) {
  std::vector<Recording> out;
  for (const Recording& recording : recordings) {
    std::vector<std::string> inputs;
    if (options.inputs) inputs = *options.inputs;
    for (std::size_t c : channels_with_role(recording, Role::kInput)) {
      if (!options.inputs) inputs.push_back(recording.channels[c].name);
    }
    auto one = align_outline(recording, inputs);
    if (!one) return one.error();
    for (InputAlignment& found : one->inputs) {
      if (found.frames_moved > 0) summary.warnings.push_back(recording.source + ": " + found.note());
      summary.alignment.push_back(std::move(found));
    }
    out.push_back(std::move(one->recording));
  }
  return out;
}

ArxOrders chosen_orders(const PreparedOutlines& prepared, const OutlineRecipe& options, const OutlineChoice& choice) {
  return outline_orders(choice.taken().order, choice.taken().delay, *options.coupling, prepared);
}

// Learns the inputs' curves, where there are to be any.
Result<void> learn_curves(std::span<const Recording> recordings, const PreparedOutlines& prepared,
                          const OutlineRecipe& options, OutlineSummary& summary) {
  if (summary.curve_choice.knots == 0) return {};
  const auto from = to_learn_from(recordings, prepared, options);
  auto curves =
      outline_curves(from, prepared, chosen_orders(prepared, options, summary.choice), summary.curve_choice.knots);
  if (!curves) return curves.error();
  summary.curves = *std::move(curves);
  if (!mirror_wanted(options, prepared)) return {};
  for (CurveEstimate& one : summary.curves) {
    for (double& error : one.std_error) error *= std::sqrt(2.0);  // a frame and its mirror image are one observation
  }
  return {};
}

bool hear_each_other(const OutlineRecipe& options) {
  return options.coupling == OutlineCoupling::kBand || options.coupling == OutlineCoupling::kFull;
}

// Decides whether the inputs pass a nonlinearity, which is estimated from the first part.
Result<void> bend(OutlineParts& parts, const PreparedOutlines& prepared, const OutlineRecipe& options,
                  OutlineSummary& summary) {
  if (options.input_curve == 0 || prepared.inputs.empty()) return {};
  auto choice = choose_outline_curves(prepared, mirror_wanted(options, prepared),
                                      chosen_orders(prepared, options, summary.choice), options.input_curve);
  if (!choice) return choice.error();
  summary.curve_choice = *std::move(choice);
  if (auto ok = learn_curves(parts.learned, prepared, options, summary); !ok) return ok;
  if (summary.curves.empty()) return {};
  parts.learned = bent_outlines(parts.learned, prepared, summary.curves);
  parts.held_out = bent_outlines(parts.held_out, prepared, summary.curves);
  return {};
}

// Of a model whose components were fitted: says of which coordinates one step ahead promises too much.
void warn_of_coordinates(const PreparedOutlines& prepared, OutlineSummary& summary) {
  ArxSummary found;
  for (const OutlineChannelFigures& channel : summary.learned.channels) {
    found.fit_percent.push_back(channel.fit_percent.front());
    found.free_run_fit_percent.push_back(channel.fit_percent.back());
  }
  warn_of_free_run(prepared.channels.outputs, found);
  summary.warnings.insert(summary.warnings.end(), found.warnings.begin(), found.warnings.end());
}

// Nothing drives a flicker from outside, so that its seconds are alike in what they say: they are held out in turn.
bool is_judged_in_turn(const PreparedOutlines& prepared, const OutlineRecipe& options) {
  return prepared.inputs.empty() && options.refit && options.holdout > 0;
}

// Judges a model of everything by models that have not seen what they predict.
Result<ArxFit> judge_in_turn(const PreparedOutlines& prepared, const OutlineRecipe& options, OutlineSummary& summary) {
  const auto turns = std::max<std::size_t>(2, static_cast<std::size_t>(std::lround(1 / options.holdout)));
  const std::size_t rows = summary.rows_learned + summary.rows_held_out;
  summary.rows_held_out = rows / turns;
  summary.rows_learned = rows - summary.rows_held_out;
  summary.refitted = true;
  auto fitted = fit(prepared.recordings, prepared, options, summary, {.ridge = summary.ridge.ridge});
  if (!fitted) return fitted.error();
  auto learned = outline_figures(fitted->model, prepared.recordings, prepared.channels, prepared.layout);
  if (!learned) return learned.error();
  summary.learned = *std::move(learned);
  const auto estimate = [&](std::span<const Recording> from) -> Result<ArxModel> {
    auto one = fit_quickly(from, prepared, options, summary, summary.ridge.ridge);
    if (!one) return one.error();
    return std::move(one->model);
  };
  auto held_out = figures_in_turn(estimate, prepared, turns);
  if (held_out) summary.held_out = *std::move(held_out);
  return fitted;
}

// Judges a model that has seen only the first part of every recording, or of a flicker the model of everything.
Result<ArxFit> judge(const PreparedOutlines& prepared, const OutlineRecipe& options, OutlineSummary& summary) {
  OutlineParts parts = hold_out(prepared.recordings, prepared.channels, options.holdout);
  for (const Recording& part : parts.learned) summary.rows_learned += complete_rows(part, prepared.channels);
  for (const Recording& part : parts.held_out) summary.rows_held_out += complete_rows(part, prepared.channels);
  auto choice = choose_orders(to_learn_from(parts.learned, prepared, options), parts.held_out, prepared, options);
  if (!choice) return choice.error();
  summary.choice = *std::move(choice);
  if (auto ok = bend(parts, prepared, options, summary); !ok) return ok.error();
  if (hear_each_other(options)) {
    const auto with = [&](double ridge) { return fit_quickly(parts.learned, prepared, options, summary, ridge); };
    auto ridge = choose_ridge(with, parts.held_out, prepared, chosen_orders(prepared, options, summary.choice));
    if (!ridge) return ridge.error();
    summary.ridge = *std::move(ridge);
  }
  if (is_judged_in_turn(prepared, options)) return judge_in_turn(prepared, options, summary);
  auto fitted = fit(parts.learned, prepared, options, summary, {.ridge = summary.ridge.ridge});
  if (!fitted) return fitted;
  auto learned = outline_figures(fitted->model, parts.learned, prepared.channels, prepared.layout);
  if (!learned) return learned.error();
  summary.learned = *std::move(learned);
  const bool full = *options.coupling == OutlineCoupling::kFull;
  if (full && !prepared.inputs.empty()) warn_of_coordinates(prepared, summary);
  const auto history = static_cast<std::size_t>(fitted->model.orders.history());
  if (summary.rows_held_out < kMinHeldOut + history) return fitted;
  auto held_out = outline_figures(fitted->model, parts.held_out, prepared.channels, prepared.layout);
  if (held_out) summary.held_out = *std::move(held_out);
  auto free = arx::free_run_parts(fitted->model, parts.held_out, prepared.channels);
  if (free) summary.free_run_parts = *std::move(free);
  return fitted;
}

void take_fit(const ArxFit& fitted, OutlineSummary& summary) {
  summary.orders = fitted.model.orders;
  summary.stable = fitted.summary.stable;
  summary.warnings.insert(summary.warnings.end(), fitted.summary.warnings.begin(), fitted.summary.warnings.end());
  for (double fpe : fitted.summary.row_fpe) {
    summary.fpe += fpe / static_cast<double>(fitted.summary.row_fpe.size());
  }
  for (std::size_t i = 0; i < fitted.model.noise.sd.size(); ++i) {
    summary.residuals.push_back({fitted.model.noise.sd[i], fitted.model.noise.sd_ci95[i]});
  }
}

double recorded_sd(const std::string& name, const Recording& recording) {
  std::vector<double> samples;
  for (double value : recording.channels[*find_channel(recording, name)].samples) {
    if (!std::isnan(value)) samples.push_back(value);
  }
  return deviation(samples);
}

// The recording in which most moves: one of calm among others tells nothing of what the inputs do.
std::size_t liveliest(const PreparedOutlines& prepared) {
  std::size_t best = 0;
  double most = -1;
  for (std::size_t r = 0; r < prepared.recordings.size(); ++r) {
    double sum = 0;
    for (const std::string& name : prepared.channels.outputs) sum += recorded_sd(name, prepared.recordings[r]);
    if (sum > most) best = r, most = sum;
  }
  return best;
}

// What it does when it plays along the inputs of the liveliest recording.
Result<void> try_out(const Model& model, const OutlineRecipe& options, const PreparedOutlines& prepared,
                     std::span<const Recording> recordings, OutlineSummary& summary) {
  const std::size_t lively = liveliest(prepared);
  const Recording driving = with_regressors(recordings[lively], summary.inputs, {});
  const auto play = play_freely(model, kTrialSteps, {.seed = options.seed, .input = &driving});
  if (!play) return play.error();
  summary.held_share = play->held_share;
  for (std::size_t i = 0; i < play->sd.size(); ++i) {
    const double recorded = recorded_sd(prepared.channels.outputs[i], prepared.recordings[lively]);
    summary.sd_ratio.push_back(recorded > 0 ? play->sd[i] / recorded : 1);
  }
  const auto distance = play_distance(model, prepared, lively, driving, options.seed);
  if (!distance) return distance.error();
  summary.play_distance = *distance;
  return {};
}

}  // namespace

Result<OutlineFit> fit_outline(std::span<const Recording> recordings, const OutlineRecipe& wanted,
                               const Progress& progress) {
  constexpr const char* kStage = "learning";
  if (auto ok = check_options(wanted); !ok) return ok.error();
  OutlineFit out;
  OutlineSummary& summary = out.summary;
  std::vector<Recording> in_step;
  if (wanted.align) {
    auto moved = aligned(recordings, wanted, summary);
    if (!moved) return moved.error();
    in_step = *std::move(moved);
    recordings = in_step;
  }
  auto prepared = prepared_for(recordings, wanted, false);
  if (!prepared) return prepared.error();
  if (!go_on(progress, kStage, 0.1)) return Error{std::string(kStopped)};
  OutlineRecipe options = decided(wanted, *prepared);
  if (takes_powers(options, *prepared)) {
    options.input_curve = 0;
    prepared = prepared_for(recordings, wanted, true);
    if (!prepared) return prepared.error();
  }
  if (auto ok = check_rows(*prepared, options); !ok) return ok.error();
  auto fitted = judge(*prepared, options, summary);
  if (!fitted) return fitted.error();
  if (!go_on(progress, kStage, 0.6)) return Error{std::string(kStopped)};
  const bool refit = options.refit && summary.rows_held_out > 0 && !summary.refitted;
  if (refit) {
    if (auto ok = learn_curves(prepared->recordings, *prepared, options, summary); !ok) return ok.error();
  }
  if (!summary.curves.empty()) prepared = bent_preparation(*std::move(prepared), summary.curves);
  if (refit) {
    fitted = fit(prepared->recordings, *prepared, options, summary, {.ridge = summary.ridge.ridge});
    if (!fitted) return fitted.error();
    summary.refitted = true;
  }
  summary.rate_hz = prepared->recordings.front().rate_hz;
  summary.unsteadiness = unsteadiness(*prepared);
  summary.inputs = prepared->inputs;
  summary.warnings.insert(summary.warnings.end(), prepared->warnings.begin(), prepared->warnings.end());
  summary.points = prepared->layout.points;
  summary.pixels_per_unit = prepared->pixels_per_unit.front();
  take_fit(*fitted, summary);
  ArxModel arx = fitted->model;
  const auto seen = hold_out(prepared->recordings, prepared->channels, summary.refitted ? 0 : options.holdout).learned;
  if (!prepared->inputs.empty()) centre_on_calm(arx);
  if (options.noise == OutlineNoise::kResampled) {
    if (auto ok = set_drawn(seen, *prepared, options, arx); !ok) return ok.error();
  }
  if (arx.noise.resampled.empty()) {
    const auto shaken = to_learn_from(seen, *prepared, options);
    if (auto ok = set_noise(*fitted, shaken, *prepared, options, arx, summary); !ok) return ok.error();
  }
  out.model = model_of(arx, *prepared, options);
  if (!go_on(progress, kStage, 0.8)) return Error{std::string(kStopped)};
  if (auto ok = try_out(out.model, options, *prepared, recordings, summary); !ok) return ok.error();
  summary.usable = outline_verdict(fitted->summary, summary);
  out.model.training = outline_training(recordings, options, summary);
  return out;
}

}  // namespace wisp
