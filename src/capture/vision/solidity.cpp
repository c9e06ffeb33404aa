#include "capture/vision/solidity.hpp"

#include <algorithm>
#include <cmath>

namespace wisp {
namespace {

double area(const std::vector<CurvePoint>& points) {
  double twice = 0;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const CurvePoint &a = points[k], &b = points[(k + 1) % points.size()];
    twice += a.x * b.y - b.x * a.y;
  }
  return 0.5 * std::abs(twice);
}

// Andrew's monotone chain.
std::vector<CurvePoint> convex_hull(std::vector<CurvePoint> points) {
  std::sort(points.begin(), points.end(),
            [](const CurvePoint& a, const CurvePoint& b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
  std::vector<CurvePoint> hull;
  for (int side = 0; side < 2; ++side) {
    const std::size_t first = hull.size();
    for (const CurvePoint& p : points) {
      while (hull.size() >= first + 2) {
        const CurvePoint &a = hull[hull.size() - 2], &b = hull.back();
        if ((b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x) > 0) break;
        hull.pop_back();
      }
      hull.push_back(p);
    }
    hull.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return hull;
}

}  // namespace

double solidity(const std::vector<CurvePoint>& polygon) {
  return area(polygon) / std::max(area(convex_hull(polygon)), 1e-9);
}

}  // namespace wisp
