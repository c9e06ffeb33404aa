#include "learn/arx/curve/curve_choice.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "learn/arx/fit/arx_fit.hpp"
#include "learn/arx/judge/held_out.hpp"
#include "record/number_text.hpp"

namespace wisp {
namespace {

std::vector<Recording> bent(std::span<const Recording> recordings, const CurveFitOptions& options,
                            std::span<const CurveEstimate> curves) {
  std::vector<InputCurve> given;
  for (const CurveEstimate& one : curves) given.push_back(one.curve);
  std::vector<Recording> out;
  for (const Recording& one : recordings) {
    out.push_back(given.empty() ? one : with_curves(one, options.inputs, given));
  }
  return out;
}

// Errors over what a fold holds out under a linear model behind curves of so many knots (0: none).
Result<Eigen::MatrixXd> errors_of(const arx::Fold& fold, const ChannelChoice& channels, CurveFitOptions options,
                                  int knots) {
  std::vector<CurveEstimate> curves;
  if (knots > 0) {
    options.knots = knots;
    auto fit = fit_input_curves(fold.learned, channels, options);
    if (!fit) return fit.error();
    curves = std::move(fit->curves);
  }
  const auto fit =
      fit_arx(bent(fold.learned, options, curves), channels, {.orders = options.orders, .judge_free_run = false});
  if (!fit) return fit.error();
  return arx::free_run_parts(fit->model, bent(fold.held_out, options, curves), channels);
}

// The same of all folds, one below the other.
Result<Eigen::MatrixXd> errors_of(std::span<const arx::Fold> folds, const ChannelChoice& channels,
                                  const CurveFitOptions& options, int knots) {
  const auto rows = static_cast<Eigen::Index>(folds.size()) * arx::kParts;
  Eigen::MatrixXd all(rows, static_cast<Eigen::Index>(channels.outputs.size()));
  Eigen::Index at = 0;
  for (const arx::Fold& fold : folds) {
    const auto errors = errors_of(fold, channels, options, knots);
    if (!errors) return errors.error();
    all.middleRows(at, arx::kParts) = *errors;
    at += arx::kParts;
  }
  return all;
}

std::string reason_for(const CurveCandidate& best, int knots, bool given) {
  std::string reason = knots > 0 ? "inputs are bent by curves of " : "inputs are as they are, not bent by curves of ";
  reason += std::to_string(best.knots) + " knots" + (given ? ", as given" : "");
  reason += ": free simulation of held-out rows errs by " + number_text(100 * std::abs(best.gain), 3) + " % ";
  reason += best.gain >= 0 ? "less" : "more";
  return reason + ", by " + number_text(std::abs(best.sureness), 2) + " standard errors over its parts";
}

// Whether every input takes values enough for a curve.
bool can_bend(std::span<const Recording> learned, const CurveFitOptions& options) {
  return !options.inputs.empty() && std::all_of(options.inputs.begin(), options.inputs.end(), [&](const auto& input) {
    return curve_knots(learned, input, kMinCurveKnots).size() >= 3;
  });
}

}  // namespace

Result<CurveChoice> choose_input_curves(std::span<const arx::Fold> folds, const ChannelChoice& channels,
                                        const CurveFitOptions& options, std::optional<int> knots) {
  CurveChoice out{{}, knots.value_or(0), ""};
  const bool bendable =
      std::all_of(folds.begin(), folds.end(), [&](const arx::Fold& one) { return can_bend(one.learned, options); });
  if (!knots && !bendable) {
    out.reason = "the inputs take too few values to tell a curve from a line";
    return out;
  }
  const auto straight = errors_of(folds, channels, options, 0);
  for (int count = knots.value_or(kMinCurveKnots); straight && count <= knots.value_or(kMaxTriedKnots); ++count) {
    const auto errors = errors_of(folds, channels, options, count);
    if (!errors) break;  // too few rows for as many pieces
    const Eigen::VectorXd own = arx::relative_errors(*errors, *straight);
    out.candidates.push_back({count, 1 - std::sqrt(own.mean()),
                              arx::standard_errors_below(own, arx::relative_errors(*straight, *straight))});
  }
  if (out.candidates.empty()) {
    out.reason = knots ? "curves of " + std::to_string(*knots) +
                             " knots, as given; too little is recorded to tell whether they help"
                       : "too little is recorded to tell a curve from a line";
    return out;
  }
  const CurveCandidate& best = *std::max_element(out.candidates.begin(), out.candidates.end(),
                                                 [](const auto& a, const auto& b) { return a.gain < b.gain; });
  if (best.gain > 0 && best.sureness > arx::kSurelyBetter) out.knots = best.knots;
  out.reason = reason_for(best, out.knots, knots.has_value());
  return out;
}

}  // namespace wisp
