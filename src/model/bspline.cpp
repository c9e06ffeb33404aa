#include "model/bspline.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace wisp {
namespace {

// Returns index k with knots[k] <= s < knots[k+1]; the last non-empty span at s = 1.
int span_of(std::span<const double> knots, double s) {
  const int points = static_cast<int>(knots.size()) - kSplineDegree - 1;
  const auto first = knots.begin() + kSplineDegree;
  const auto last = knots.begin() + points;
  const auto above = std::upper_bound(first, last, s);
  return static_cast<int>(above - knots.begin()) - 1;
}

// Returns the values of the degree-`degree` basis functions over span k, by the Cox–de Boor recurrence.
std::array<double, 4> values_on_span(std::span<const double> knots, int k, double s, int degree) {
  std::array<double, 4> value{1, 0, 0, 0};
  std::array<double, 4> left{}, right{};
  for (int d = 1; d <= degree; ++d) {
    left[d] = s - knots[k + 1 - d];
    right[d] = knots[k + d] - s;
    double saved = 0;
    for (int r = 0; r < d; ++r) {
      const double share = value[r] / (right[r + 1] + left[d - r]);
      value[r] = saved + right[r + 1] * share;
      saved = left[d - r] * share;
    }
    value[d] = saved;
  }
  return value;
}

}  // namespace

std::vector<double> uniform_knots(int points) {
  assert(points >= kSplineDegree + 1);
  const int spans = points - kSplineDegree;
  std::vector<double> interior;
  for (int k = 1; k < spans; ++k) interior.push_back(static_cast<double>(k) / spans);
  return clamped_knots(interior);
}

std::vector<double> clamped_knots(std::span<const double> interior) {
  std::vector<double> knots(kSplineDegree + 1, 0.0);
  knots.insert(knots.end(), interior.begin(), interior.end());
  knots.insert(knots.end(), kSplineDegree + 1, 1.0);
  return knots;
}

bool valid_knots(std::span<const double> knots) {
  constexpr std::size_t kClamped = kSplineDegree + 1;
  if (knots.size() < 2 * kClamped) return false;
  if (!std::all_of(knots.begin(), knots.end(), [](double knot) { return std::isfinite(knot); })) return false;
  if (!std::is_sorted(knots.begin(), knots.end())) return false;
  for (std::size_t k = 0; k < kClamped; ++k) {
    if (knots[k] != 0.0 || knots[knots.size() - 1 - k] != 1.0) return false;
  }
  const auto interior = knots.subspan(kClamped, knots.size() - 2 * kClamped);
  if (!interior.empty() && (interior.front() <= 0.0 || interior.back() >= 1.0)) return false;
  for (std::size_t k = kSplineDegree; k < interior.size(); ++k) {
    if (interior[k] == interior[k - kSplineDegree]) return false;
  }
  return true;
}

BasisWeights basis(std::span<const double> knots, double s) {
  assert(s >= 0 && s <= 1);
  const int k = span_of(knots, s);
  return {k - kSplineDegree, values_on_span(knots, k, s, kSplineDegree)};
}

BasisWeights basis_derivative(std::span<const double> knots, double s) {
  assert(s >= 0 && s <= 1);
  const int k = span_of(knots, s);
  const auto lower = values_on_span(knots, k, s, kSplineDegree - 1);
  // B'(i,3) = 3 (B(i,2)/(t(i+3)−t(i)) − B(i+1,2)/(t(i+4)−t(i+1))); lower[r] is B(k−2+r, 2).
  BasisWeights out{k - kSplineDegree, {}};
  for (int r = 0; r < kSplineDegree; ++r) {
    const double slope = kSplineDegree * lower[r] / (knots[k + 1 + r] - knots[k - 2 + r]);
    out.weight[r] -= slope;
    out.weight[r + 1] += slope;
  }
  return out;
}

}  // namespace wisp
