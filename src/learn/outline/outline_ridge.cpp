#include "learn/outline/outline_ridge.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "learn/outline/outline_figures.hpp"
#include "record/number_text.hpp"

namespace wisp {
namespace {

constexpr double kRidges[] = {0, 1e-5, 1e-4, 3e-4, 1e-3, 3e-3, 1e-2, 3e-2, 1e-1};
constexpr double kUntried = 1e-3;  // where too little is held out to try any

Result<RidgeCandidate> tried(const RidgeFit& fit, std::span<const Recording> held_out, const PreparedOutlines& prepared,
                             double ridge) {
  const auto fitted = fit(ridge);
  if (!fitted) return fitted.error();
  RidgeCandidate out{ridge, std::numeric_limits<double>::infinity(), !fitted->summary.stable.changed};
  const int half_a_second = std::max(1, static_cast<int>(std::lround(prepared.recordings.front().rate_hz / 2)));
  const int steps = prepared.inputs.empty() ? half_a_second : kFreeRun;
  const auto figures = outline_figures(fitted->model, held_out, prepared.channels, prepared.layout, {steps});
  if (!figures) return figures.error();
  const std::vector<double>& j = figures->j.front();
  const double error = std::accumulate(j.begin(), j.end(), 0.0) / static_cast<double>(j.size());
  if (std::isfinite(error)) out.error = error;
  return out;
}

// A stable estimate before one that had to be made stable, then the one that errs less.
bool better(const RidgeCandidate& a, const RidgeCandidate& b) {
  return a.stable != b.stable ? a.stable : a.error < b.error;
}

}  // namespace

Result<RidgeChoice> choose_ridge(const RidgeFit& fit, std::span<const Recording> held_out,
                                 const PreparedOutlines& prepared, const ArxOrders& orders) {
  constexpr std::size_t kMinHeldOut = 50;  // rows beside a history
  if (complete_rows(held_out, prepared.channels) < kMinHeldOut + static_cast<std::size_t>(orders.history())) {
    return RidgeChoice{{}, kUntried, "ridge " + number_text(kUntried, 2) + ": too little is held out to try others"};
  }
  RidgeChoice out;
  for (const double ridge : kRidges) {
    auto one = tried(fit, held_out, prepared, ridge);
    if (!one) return one.error();
    out.candidates.push_back(*one);
  }
  const RidgeCandidate& best = *std::min_element(out.candidates.begin(), out.candidates.end(), better);
  out.ridge = best.ridge;
  out.reason = "ridge " + number_text(best.ridge, 2) + " of " + std::to_string(out.candidates.size()) +
               " candidates: the held-out error of " +
               (prepared.inputs.empty() ? "prediction half a second ahead" : "free simulation") + " is " +
               number_text(best.error, 3) + ", without a ridge " + number_text(out.candidates.front().error, 3);
  return out;
}

}  // namespace wisp
