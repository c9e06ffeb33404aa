#include "learn/outline/outline_shape.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>

namespace wisp {
namespace {

constexpr int kStrips = 1024;

// Twice the signed area of a triangle; the sign is the side of the line a–b on which c lies.
double side(const OutlinePoint& a, const OutlinePoint& b, const OutlinePoint& c) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

bool cross(const OutlinePoint& a, const OutlinePoint& b, const OutlinePoint& c, const OutlinePoint& d) {
  return side(a, b, c) * side(a, b, d) < 0 && side(c, d, a) * side(c, d, b) < 0;
}

OutlinePoint base_of(std::span<const OutlinePoint> polyline) {
  const OutlinePoint& left = polyline.front();
  const OutlinePoint& right = polyline.back();
  return {(left[0] + right[0]) / 2, (left[1] + right[1]) / 2};
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
  bool empty() const { return !(highest > lowest); }
  double middle(int strip) const { return lowest + (highest - lowest) * (strip + 0.5) / kStrips; }

  // Index of the strip that contains y, up to ±1 from rounding.
  int near(double y) const { return static_cast<int>((y - lowest) / (highest - lowest) * kStrips); }
};

// Crossings of a polygon's sides with the centre line of every strip, ascending; pairs enclose filled intervals.
class Crossings {
 public:
  Crossings(std::span<const OutlinePoint> polygon, const Range& range) : first_(kStrips + 1, 0) {
    visit(polygon, range, [&](int strip, double) { ++first_[strip + 1]; });
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    x_.resize(first_.back());
    std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
    visit(polygon, range, [&](int strip, double x) { x_[next[strip]++] = x; });
    for (int strip = 0; strip < kStrips; ++strip) {
      std::sort(x_.begin() + static_cast<std::ptrdiff_t>(first_[strip]),
                x_.begin() + static_cast<std::ptrdiff_t>(first_[strip + 1]));
    }
  }

  std::span<const double> at(int strip) const {
    return std::span(x_).subspan(first_[strip], first_[strip + 1] - first_[strip]);
  }

 private:
  // Calls visit(strip, x) per crossing. A side excludes its end of larger y, so that a corner on the line counts once.
  template <class Visit>
  static void visit(std::span<const OutlinePoint> polygon, const Range& range, Visit visit) {
    for (std::size_t k = 0; k < polygon.size(); ++k) {
      const OutlinePoint& a = polygon[k];
      const OutlinePoint& b = polygon[(k + 1) % polygon.size()];
      const int low = std::max(0, range.near(std::min(a[1], b[1])) - 1);
      const int high = std::min(kStrips - 1, range.near(std::max(a[1], b[1])) + 1);
      for (int strip = low; strip <= high; ++strip) {
        const double y = range.middle(strip);
        if ((a[1] <= y) == (b[1] <= y)) continue;
        visit(strip, a[0] + (b[0] - a[0]) * (y - a[1]) / (b[1] - a[1]));
      }
    }
  }

  std::vector<std::size_t> first_;  // index of each strip's first crossing in x_
  std::vector<double> x_;
};

double length_of(std::span<const double> crossing) {
  double sum = 0;
  for (std::size_t k = 0; k + 1 < crossing.size(); k += 2) sum += crossing[k + 1] - crossing[k];
  return sum;
}

double common_length(std::span<const double> a, std::span<const double> b) {
  double sum = 0;
  for (std::size_t i = 0, j = 0; i + 1 < a.size() && j + 1 < b.size();) {
    sum += std::max(0.0, std::min(a[i + 1], b[j + 1]) - std::max(a[i], b[j]));
    (a[i + 1] < b[j + 1] ? i : j) += 2;
  }
  return sum;
}

}  // namespace

OutlineCurve::OutlineCurve(std::span<const double> knots, std::size_t samples) {
  assert(samples >= 2);
  for (std::size_t k = 0; k < samples; ++k) {
    samples_.push_back(basis(knots, static_cast<double>(k) / static_cast<double>(samples - 1)));
  }
}

std::vector<OutlinePoint> OutlineCurve::polyline(std::span<const double> control) const {
  assert(control.size() == 2 * (static_cast<std::size_t>(samples_.back().first) + 4));
  std::vector<OutlinePoint> out;
  out.reserve(samples_.size());
  for (const BasisWeights& sample : samples_) {
    OutlinePoint point{0, 0};
    for (int r = 0; r < 4; ++r) {
      point[0] += sample.weight[r] * control[2 * (sample.first + r)];
      point[1] += sample.weight[r] * control[2 * (sample.first + r) + 1];
    }
    out.push_back(point);
  }
  return out;
}

std::vector<OutlinePoint> at_equal_lengths(std::span<const OutlinePoint> polyline, std::size_t count) {
  assert(!polyline.empty() && count >= 2);
  std::vector<double> along(polyline.size(), 0.0);
  for (std::size_t k = 1; k < polyline.size(); ++k) {
    along[k] = along[k - 1] + std::hypot(polyline[k][0] - polyline[k - 1][0], polyline[k][1] - polyline[k - 1][1]);
  }
  std::vector<OutlinePoint> out(count, polyline.front());
  std::size_t next = 1;
  for (std::size_t k = 1; k < count && along.back() > 0; ++k) {
    const double wanted = along.back() * static_cast<double>(k) / static_cast<double>(count - 1);
    while (next + 1 < along.size() && along[next] < wanted) ++next;
    const double step = along[next] - along[next - 1];
    const double share = step > 0 ? std::clamp((wanted - along[next - 1]) / step, 0.0, 1.0) : 1.0;
    for (std::size_t c : {0, 1}) {
      out[k][c] = polyline[next - 1][c] + share * (polyline[next][c] - polyline[next - 1][c]);
    }
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

bool crosses_itself(std::span<const OutlinePoint> polyline) {
  const std::size_t n = polyline.size();
  for (std::size_t i = 0; i + 2 < n; ++i) {
    for (std::size_t j = i + 2; j < n; ++j) {
      if (cross(polyline[i], polyline[i + 1], polyline[j], polyline[(j + 1) % n])) return true;
    }
  }
  return false;
}

double enclosed_area(std::span<const OutlinePoint> polygon) {
  double twice = 0;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const OutlinePoint &a = polygon[k], &b = polygon[(k + 1) % polygon.size()];
    twice += a[0] * b[1] - b[0] * a[1];
  }
  return std::abs(twice) / 2;
}

double overlap_of(std::span<const OutlinePoint> a, std::span<const OutlinePoint> b) {
  Range range;
  range.take(a);
  range.take(b);
  if (range.empty()) return 0;
  const Crossings of_a(a, range);
  const Crossings of_b(b, range);
  double common = 0;
  double covered = 0;
  for (int strip = 0; strip < kStrips; ++strip) {
    const double both = common_length(of_a.at(strip), of_b.at(strip));
    common += both;
    covered += length_of(of_a.at(strip)) + length_of(of_b.at(strip)) - both;
  }
  return covered > 0 ? common / covered : 0;
}

}  // namespace wisp
