#include "capture/vision/spline_table.hpp"

#include <algorithm>
#include <cassert>

namespace wisp {
namespace {

CurvePoint combine(const BasisWeights& weights, std::span<const double> controls) {
  CurvePoint out;
  for (int r = 0; r < 4; ++r) {
    out.x += weights.weight[r] * controls[2 * (weights.first + r)];
    out.y += weights.weight[r] * controls[2 * (weights.first + r) + 1];
  }
  return out;
}

}  // namespace

SplineTable::SplineTable(std::span<const double> knots) : knots_(knots.begin(), knots.end()) {
  assert(valid_knots(knots));
  points_ = static_cast<int>(knots.size()) - kSplineDegree - 1;
  for (int k = kSplineDegree; k < points_; ++k) {
    const double begin = knots_[k], width = knots_[k + 1] - begin;
    if (width <= 0) continue;
    // The cubic through each weight at 0, 1/4, 1/2 and 3/4 of the span; the span's end belongs to the next span.
    Span span{begin, k - kSplineDegree, {}};
    std::array<BasisWeights, 4> value;
    for (int i = 0; i < 4; ++i) value[i] = basis(knots_, begin + width * (0.25 * i));
    for (int r = 0; r < 4; ++r) {
      const double v0 = value[0].weight[r], v1 = value[1].weight[r], v2 = value[2].weight[r], v3 = value[3].weight[r];
      const double d1 = v1 - v0, d2 = v2 - 2 * v1 + v0, d3 = v3 - 3 * v2 + 3 * v1 - v0;
      // Newton's forward form on u = 4 (s − begin) / width, gathered by powers of u.
      const double scale = 4 / width;
      span.power[0][r] = v0;
      span.power[1][r] = (d1 - d2 / 2 + d3 / 3) * scale;
      span.power[2][r] = (d2 / 2 - d3 / 2) * scale * scale;
      span.power[3][r] = d3 / 6 * scale * scale * scale;
    }
    spans_.push_back(span);
  }
  guess_.resize(kSplineCells + 1);
  int at = 0;
  for (int cell = 0; cell <= kSplineCells; ++cell) {
    const double s = static_cast<double>(cell) / kSplineCells;
    while (at + 1 < static_cast<int>(spans_.size()) && spans_[at + 1].begin <= s) ++at;
    guess_[cell] = at;
  }
}

const SplineTable::Span& SplineTable::span_at(double s) const {
  int at = guess_[static_cast<int>(s * kSplineCells)];
  while (at + 1 < static_cast<int>(spans_.size()) && spans_[at + 1].begin <= s) ++at;
  return spans_[at];
}

BasisWeights SplineTable::weights(double s) const {
  s = std::clamp(s, 0.0, 1.0);
  const Span& span = span_at(s);
  const double t = s - span.begin;
  BasisWeights out{span.first, {}};
  for (int r = 0; r < 4; ++r) {
    out.weight[r] = span.power[0][r] + t * (span.power[1][r] + t * (span.power[2][r] + t * span.power[3][r]));
  }
  return out;
}

BasisWeights SplineTable::derivatives(double s) const {
  s = std::clamp(s, 0.0, 1.0);
  const Span& span = span_at(s);
  const double t = s - span.begin;
  BasisWeights out{span.first, {}};
  for (int r = 0; r < 4; ++r) out.weight[r] = span.power[1][r] + t * (2 * span.power[2][r] + t * 3 * span.power[3][r]);
  return out;
}

CurvePoint SplineTable::at(std::span<const double> controls, double s) const { return combine(weights(s), controls); }

CurvePoint SplineTable::slope(std::span<const double> controls, double s) const {
  return combine(derivatives(s), controls);
}

void SplineTable::pieces(std::span<const double> controls, CurvePieces& out) const {
  out.guess_ = guess_;
  out.pieces_.resize(spans_.size());
  for (std::size_t k = 0; k < spans_.size(); ++k) {
    const Span& span = spans_[k];
    out.pieces_[k].begin = span.begin;
    for (std::size_t power = 0; power < 4; ++power) {
      CurvePoint sum;
      for (std::size_t r = 0; r < 4; ++r) {
        const std::size_t control = 2 * (static_cast<std::size_t>(span.first) + r);
        sum.x += span.power[power][r] * controls[control];
        sum.y += span.power[power][r] * controls[control + 1];
      }
      out.pieces_[k].power[power] = sum;
    }
  }
}

std::vector<CurvePoint> curve_polyline(const SplineTable& table, std::span<const double> controls, int count) {
  assert(count >= 2);
  std::vector<CurvePoint> out;
  out.reserve(count);
  for (int k = 0; k < count; ++k) out.push_back(table.at(controls, static_cast<double>(k) / (count - 1)));
  return out;
}

bool crosses_itself(std::span<const CurvePoint> polyline) {
  for (std::size_t i = 0; i + 1 < polyline.size(); ++i) {
    const CurvePoint &a = polyline[i], &b = polyline[i + 1];
    double side_of_c = i + 2 < polyline.size() ? side_of(a, b, polyline[i + 2]) : 0;
    for (std::size_t j = i + 2; j + 1 < polyline.size(); ++j) {
      const CurvePoint &c = polyline[j], &d = polyline[j + 1];
      const double side_of_d = side_of(a, b, d);
      if (side_of_c * side_of_d < 0 && side_of(c, d, a) * side_of(c, d, b) < 0) return true;
      side_of_c = side_of_d;
    }
  }
  return false;
}

}  // namespace wisp
