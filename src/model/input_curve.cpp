#include "wisp/model/input_curve.hpp"

#include <algorithm>
#include <cmath>

namespace wisp {
namespace {

constexpr double kNearest = 1e-6;  // of the curve's length: a slope is at most a million

Result<void> check_knot(const InputCurve& curve, std::size_t k, double nearest) {
  const std::string which = "knot " + std::to_string(k) + " of an input's curve";
  if (!std::isfinite(curve.at[k]) || !std::isfinite(curve.value[k])) return Error{which + " is not a finite number"};
  if (k == 0) return {};
  if (!(curve.at[k] - curve.at[k - 1] >= nearest)) {
    return Error{which + " is at " + std::to_string(curve.at[k]) + ", expected beyond the one before, at " +
                 std::to_string(curve.at[k - 1])};
  }
  if (!(curve.value[k] >= curve.value[k - 1])) {
    return Error{which + " is " + std::to_string(curve.value[k]) + ", expected no less than the one before, " +
                 std::to_string(curve.value[k - 1])};
  }
  return {};
}

}  // namespace

double value_at(const InputCurve& curve, double input) {
  if (curve.empty() || !(input > curve.at.front() && input < curve.at.back())) return input;
  const auto next = std::upper_bound(curve.at.begin(), curve.at.end(), input) - curve.at.begin();
  const auto k = static_cast<std::size_t>(next);
  const double share = (input - curve.at[k - 1]) / (curve.at[k] - curve.at[k - 1]);
  return curve.value[k - 1] + share * (curve.value[k] - curve.value[k - 1]);
}

Result<void> check(const InputCurve& curve, double lowest, double highest) {
  if (curve.at.size() < 2 || curve.at.size() > kMaxCurveKnots || curve.value.size() != curve.at.size()) {
    return Error{"an input's curve has " + std::to_string(curve.at.size()) + " knots and " +
                 std::to_string(curve.value.size()) + " values, expected 2 to 16 and as many"};
  }
  const double nearest = kNearest * (curve.at.back() - curve.at.front());
  for (std::size_t k = 0; k < curve.at.size(); ++k) {
    if (auto ok = check_knot(curve, k, nearest); !ok) return ok;
  }
  if (!(curve.at.front() >= lowest && curve.at.back() <= highest)) {
    return Error{"an input's curve goes from " + std::to_string(curve.at.front()) + " to " +
                 std::to_string(curve.at.back()) + ", expected within the input's range, " + std::to_string(lowest) +
                 " to " + std::to_string(highest)};
  }
  if (curve.value.front() != curve.at.front() || curve.value.back() != curve.at.back()) {
    return Error{"an input's curve ends at " + std::to_string(curve.value.front()) + " and " +
                 std::to_string(curve.value.back()) + ", expected the knots there, " +
                 std::to_string(curve.at.front()) + " and " + std::to_string(curve.at.back())};
  }
  return {};
}

}  // namespace wisp
