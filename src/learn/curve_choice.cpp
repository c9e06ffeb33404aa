#include "wisp/learn/curve_choice.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>

#include "wisp/learn/arx_fit.hpp"
#include "wisp/learn/prediction.hpp"

namespace wisp {
namespace {

constexpr double kSureBy = 2;            // standard errors of the held-out gain
constexpr double kBlockSeconds = 1;      // neighbouring rows may not be independent
constexpr std::size_t kFewestRows = 20;  // of a block, where a second has fewer
constexpr std::size_t kLeastBlocks = 5;  // to tell a standard error from

std::vector<Recording> bent(std::span<const Recording> recordings, const CurveFitOptions& options,
                            std::span<const InputCurve> curves) {
  std::vector<Recording> out;
  for (const Recording& one : recordings) {
    out.push_back(curves.empty() ? one : with_curves(one, options.inputs, curves));
  }
  return out;
}

double log_density(double error, double variance) {
  return -0.5 * (std::log(2 * std::numbers::pi * variance) + error * error / variance);
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
  if (blocks.size() < kLeastBlocks) return;
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
    return curve_knots(learned, input, kFewestCurveKnots).size() >= 3;
  });
}

}  // namespace

Result<std::vector<double>> held_out_log_likelihood(std::span<const Recording> learned,
                                                    std::span<const Recording> held_out, const ChannelChoice& channels,
                                                    const CurveFitOptions& options,
                                                    std::span<const InputCurve> curves) {
  const auto fit =
      fit_arx(bent(learned, options, curves), channels, {.orders = options.orders, .judge_free_run = false});
  if (!fit) return fit.error();
  std::vector<double> out;
  for (const Recording& recording : bent(held_out, options, curves)) {
    const auto predicted = predict(fit->model, recording, channels);
    if (!predicted) return predicted.error();
    std::vector<double> rows(recording.rows(), 0.0);
    for (std::size_t i = 0; i < channels.outputs.size(); ++i) {
      const auto& measured = recording.channels[*find_channel(recording, channels.outputs[i])].samples;
      // An output that never moves says nothing.
      if (!(fit->summary.loss[i] > std::numeric_limits<double>::min())) continue;
      for (std::size_t t = 0; t < rows.size(); ++t) {
        rows[t] += log_density(measured[t] - (*predicted)[i][t], fit->summary.loss[i]);
      }
    }
    out.insert(out.end(), rows.begin(), rows.end());
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
  for (int count = knots.value_or(kFewestCurveKnots); count <= knots.value_or(kMostTriedKnots); ++count) {
    CurveFitOptions tried = options;
    tried.knots = count;
    const auto fit = fit_input_curves(learned, channels, tried);
    if (!fit) return fit.error();
    const auto with = held_out_log_likelihood(learned, held_out, channels, tried, curves_of(*fit));
    if (!with) return with.error();
    out.candidates.push_back({count});
    judge(*with, *without, block, out.candidates.back());
  }
  const auto best = std::max_element(out.candidates.begin(), out.candidates.end(),
                                     [](const auto& a, const auto& b) { return a.gain < b.gain; });
  const bool kept = knots || best->gain > kSureBy * best->gain_error;
  out.knots = kept ? best->knots : 0;
  out.reason = reason_for(*best, kept, knots.has_value());
  return out;
}

}  // namespace wisp
