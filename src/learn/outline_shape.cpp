#include "wisp/learn/outline_shape.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "wisp/model/bspline.hpp"

namespace wisp {
namespace {

constexpr int kStrips = 1024;

OutlinePoint base_of(std::span<const OutlinePoint> polyline) {
  const OutlinePoint& left = polyline.front();
  const OutlinePoint& right = polyline.back();
  return {(left[0] + right[0]) / 2, (left[1] + right[1]) / 2};
}

// Where the polygon's sides cross the line y, ascending: pairs enclose what is filled. A side owns its lower end and
// not its upper one, so that a corner on the line counts once.
void crossings(std::span<const OutlinePoint> polygon, double y, std::vector<double>& out) {
  out.clear();
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const OutlinePoint& a = polygon[k];
    const OutlinePoint& b = polygon[(k + 1) % polygon.size()];
    if ((a[1] <= y) == (b[1] <= y)) continue;
    out.push_back(a[0] + (b[0] - a[0]) * (y - a[1]) / (b[1] - a[1]));
  }
  std::sort(out.begin(), out.end());
}

double length_of(const std::vector<double>& crossing) {
  double sum = 0;
  for (std::size_t k = 0; k + 1 < crossing.size(); k += 2) sum += crossing[k + 1] - crossing[k];
  return sum;
}

double common_length(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (std::size_t i = 0, j = 0; i + 1 < a.size() && j + 1 < b.size();) {
    sum += std::max(0.0, std::min(a[i + 1], b[j + 1]) - std::max(a[i], b[j]));
    (a[i + 1] < b[j + 1] ? i : j) += 2;
  }
  return sum;
}

struct Range {
  double lowest = std::numeric_limits<double>::infinity();
  double highest = -std::numeric_limits<double>::infinity();

  void take(std::span<const OutlinePoint> points) {
    for (const OutlinePoint& point : points) {
      lowest = std::min(lowest, point[1]);
      highest = std::max(highest, point[1]);
    }
  }
  double strip(int k) const { return lowest + (highest - lowest) * (k + 0.5) / kStrips; }
};

}  // namespace

OutlineCurve::OutlineCurve(std::span<const double> knots, std::size_t samples)
    : points_(knots.size() - kSplineDegree - 1) {
  assert(samples >= 2);
  for (std::size_t k = 0; k < samples; ++k) {
    const BasisWeights weights = basis(knots, static_cast<double>(k) / static_cast<double>(samples - 1));
    samples_.push_back({static_cast<std::size_t>(weights.first), weights.weight});
  }
}

std::vector<OutlinePoint> OutlineCurve::polyline(std::span<const double> control) const {
  assert(control.size() == 2 * points_);
  std::vector<OutlinePoint> out;
  out.reserve(samples_.size());
  for (const Sample& sample : samples_) {
    OutlinePoint point{0, 0};
    for (std::size_t r = 0; r < 4; ++r) {
      point[0] += sample.weight[r] * control[2 * (sample.first + r)];
      point[1] += sample.weight[r] * control[2 * (sample.first + r) + 1];
    }
    out.push_back(point);
  }
  return out;
}

OutlinePoint tip_of(std::span<const OutlinePoint> polyline) {
  assert(!polyline.empty());
  const OutlinePoint base = base_of(polyline);
  const auto distance = [&](const OutlinePoint& p) { return std::hypot(p[0] - base[0], p[1] - base[1]); };
  std::vector<OutlinePoint> points(polyline.begin(), polyline.end());
  const std::size_t farthest = std::max<std::size_t>(1, points.size() / 50);
  std::partial_sort(points.begin(), points.begin() + static_cast<std::ptrdiff_t>(farthest), points.end(),
                    [&](const OutlinePoint& a, const OutlinePoint& b) { return distance(a) > distance(b); });
  OutlinePoint tip{0, 0};
  for (std::size_t k = 0; k < farthest; ++k) {
    tip[0] += points[k][0] / static_cast<double>(farthest);
    tip[1] += points[k][1] / static_cast<double>(farthest);
  }
  return tip;
}

double height_of(std::span<const OutlinePoint> polyline) {
  const OutlinePoint base = base_of(polyline);
  const OutlinePoint tip = tip_of(polyline);
  return std::hypot(tip[0] - base[0], tip[1] - base[1]);
}

double area_of(std::span<const OutlinePoint> polygon) {
  Range range;
  range.take(polygon);
  if (!(range.highest > range.lowest)) return 0;
  std::vector<double> crossing;
  double sum = 0;
  for (int k = 0; k < kStrips; ++k) {
    crossings(polygon, range.strip(k), crossing);
    sum += length_of(crossing);
  }
  return sum * (range.highest - range.lowest) / kStrips;
}

double overlap_of(std::span<const OutlinePoint> a, std::span<const OutlinePoint> b) {
  Range range;
  range.take(a);
  range.take(b);
  std::vector<double> of_a;
  std::vector<double> of_b;
  double common = 0;
  double covered = 0;
  for (int k = 0; k < kStrips; ++k) {
    crossings(a, range.strip(k), of_a);
    crossings(b, range.strip(k), of_b);
    const double both = common_length(of_a, of_b);
    common += both;
    covered += length_of(of_a) + length_of(of_b) - both;
  }
  return covered > 0 ? common / covered : 0;
}

}  // namespace wisp
