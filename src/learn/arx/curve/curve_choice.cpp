#include "learn/arx/curve/curve_choice.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>

#include "learn/arx/fit/arx_fit.hpp"
#include "learn/arx/judge/prediction.hpp"

namespace wisp {
namespace {

constexpr double kFreedom = 5;           // of Student's distribution
constexpr int kReweightings = 8;         // each halves what is left to go, or better
constexpr double kSureBy = 2;            // standard errors of the held-out gain
constexpr double kBlockSeconds = 1;      // neighbouring rows may not be independent
constexpr std::size_t kFewestRows = 20;  // of a block, where a second has fewer
constexpr std::size_t kMinBlocks = 5;    // to tell a standard error from

std::vector<Recording> bent(std::span<const Recording> recordings, const CurveFitOptions& options,
                            std::span<const InputCurve> curves) {
  std::vector<Recording> out;
  for (const Recording& one : recordings) {
    out.push_back(curves.empty() ? one : with_curves(one, options.inputs, curves));
  }
  return out;
}

// Student's weight of an error in units of its squared scale.
double weight_of(double square) { return (kFreedom + 1) / (kFreedom + square); }

double log_density(double error, double scale) {
  const double constant = std::lgamma((kFreedom + 1) / 2) - std::lgamma(kFreedom / 2);
  return constant - 0.5 * std::log(kFreedom * std::numbers::pi * scale) -
         0.5 * (kFreedom + 1) * std::log1p(error * error / (kFreedom * scale));
}

// One step ahead, of all recordings one after the other: [output][row], NaN where there is no prediction.
Result<std::vector<std::vector<double>>> errors_of(const ArxModel& model, std::span<const Recording> recordings,
                                                   const ChannelChoice& channels) {
  std::vector<std::vector<double>> out(channels.outputs.size());
  for (const Recording& recording : recordings) {
    const auto predicted = predict(model, recording, channels);
    if (!predicted) return predicted.error();
    for (std::size_t i = 0; i < out.size(); ++i) {
      const auto& measured = recording.channels[*find_channel(recording, channels.outputs[i])].samples;
      for (std::size_t t = 0; t < measured.size(); ++t) out[i].push_back(measured[t] - (*predicted)[i][t]);
    }
  }
  return out;
}

// The squared scale of greatest likelihood, by reweighting; 0 where nothing is left over.
double scale_of(const std::vector<double>& errors) {
  double scale = 0;
  for (int pass = 0; pass <= kReweightings; ++pass) {
    double sum = 0, rows = 0;
    for (double error : errors) {
      if (!std::isfinite(error)) continue;
      const double square = error * error;
      sum += scale > 0 ? square * weight_of(square / scale) : square;
      ++rows;
    }
    scale = rows > 0 ? sum / rows : 0;
  }
  return scale > std::numeric_limits<double>::min() ? scale : 0;
}

std::vector<InputCurve> curves_of(const CurveFit& fit) {
  std::vector<InputCurve> out;
  for (const CurveEstimate& one : fit.curves) out.push_back(one.curve);
  return out;
}

// Mean gain of a row and its standard error over blocks.
void judge(const std::vector<double>& with, const std::vector<double>& without, std::size_t rows_a_block,
           CurveCandidate& out) {
  std::vector<double> blocks;
  double sum = 0;
  std::size_t rows = 0;
  for (std::size_t t = 0; t < with.size(); ++t) {
    const double gain = with[t] - without[t];
    if (std::isfinite(gain)) sum += gain, ++rows;
    if (rows < rows_a_block) continue;
    blocks.push_back(sum / static_cast<double>(rows));
    sum = 0;
    rows = 0;
  }
  out.gain_error = std::numeric_limits<double>::infinity();
  if (blocks.empty()) return;
  const auto n = static_cast<double>(blocks.size());
  for (double block : blocks) out.gain += block / n;
  if (blocks.size() < kMinBlocks) return;
  double square = 0;
  for (double block : blocks) square += (block - out.gain) * (block - out.gain);
  out.gain_error = std::sqrt(square / (n * (n - 1)));
}

std::string reason_for(const CurveCandidate& best, bool kept, bool given) {
  if (!std::isfinite(best.gain_error)) {
    return given ? "curves of " + std::to_string(best.knots) +
                       " knots, as asked for; too little is held out to tell "
                       "whether they help"
                 : "too little is held out to tell whether the inputs are bent";
  }
  char text[240];
  std::snprintf(text, sizeof text, "%s %d knots: held-out rows are %.3g ± %.2g nats a row %s by curves",
                kept ? "inputs are bent by curves of" : "inputs are as they are, not bent by curves of", best.knots,
                std::abs(best.gain), best.gain_error, best.gain >= 0 ? "likelier" : "less likely");
  return text;
}

// Whether every input takes values enough for a curve.
bool can_bend(std::span<const Recording> learned, const CurveFitOptions& options) {
  return !options.inputs.empty() && std::all_of(options.inputs.begin(), options.inputs.end(), [&](const auto& input) {
    return curve_knots(learned, input, kMinCurveKnots).size() >= 3;
  });
}

}  // namespace

Result<std::vector<double>> held_out_log_likelihood(std::span<const Recording> learned,
                                                    std::span<const Recording> held_out, const ChannelChoice& channels,
                                                    const CurveFitOptions& options,
                                                    std::span<const InputCurve> curves) {
  const auto seen = bent(learned, options, curves);
  const auto fit = fit_arx(seen, channels, {.orders = options.orders, .judge_free_run = false});
  if (!fit) return fit.error();
  const auto own = errors_of(fit->model, seen, channels);
  if (!own) return own.error();
  const auto errors = errors_of(fit->model, bent(held_out, options, curves), channels);
  if (!errors) return errors.error();
  std::vector<double> out(errors->front().size(), 0.0);
  for (std::size_t i = 0; i < errors->size(); ++i) {
    const double scale = scale_of((*own)[i]);
    if (!(scale > 0)) continue;  // an output that never moves says nothing
    for (std::size_t t = 0; t < out.size(); ++t) out[t] += log_density((*errors)[i][t], scale);
  }
  return out;
}

Result<CurveChoice> choose_input_curves(std::span<const Recording> learned, std::span<const Recording> held_out,
                                        const ChannelChoice& channels, const CurveFitOptions& options,
                                        std::optional<int> knots) {
  CurveChoice out;
  if (!knots && !can_bend(learned, options)) {
    out.reason = "the inputs take too few values to tell a curve from a line";
    return out;
  }
  const auto without = held_out_log_likelihood(learned, held_out, channels, options, {});
  if (!without) return without.error();
  const double rate = learned.front().rate_hz;
  const std::size_t block = std::max(kFewestRows, static_cast<std::size_t>(std::lround(kBlockSeconds * rate)));
  for (int count = knots.value_or(kMinCurveKnots); count <= knots.value_or(kMaxTriedKnots); ++count) {
    CurveFitOptions tried = options;
    tried.knots = count;
    const auto fit = fit_input_curves(learned, channels, tried);
    if (!fit && !knots) break;  // too few rows for as many pieces
    if (!fit) return fit.error();
    const auto with = held_out_log_likelihood(learned, held_out, channels, tried, curves_of(*fit));
    if (!with) return with.error();
    out.candidates.push_back({count});
    judge(*with, *without, block, out.candidates.back());
  }
  if (out.candidates.empty()) {
    out.reason = "too little is recorded to tell a curve from a line";
    return out;
  }
  const auto best = std::max_element(out.candidates.begin(), out.candidates.end(),
                                     [](const auto& a, const auto& b) { return a.gain < b.gain; });
  const bool kept = knots || best->gain > kSureBy * best->gain_error;
  out.knots = kept ? best->knots : 0;
  out.reason = reason_for(*best, kept, knots.has_value());
  return out;
}

}  // namespace wisp
