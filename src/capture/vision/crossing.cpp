#include "capture/vision/crossing.hpp"

namespace wisp {
namespace {

// On which side of the line from a to b a point lies: positive, negative, or 0 on the line.
double side(const CurvePoint& a, const CurvePoint& b, const CurvePoint& p) {
  return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
}

}  // namespace

bool crosses_itself(std::span<const CurvePoint> polyline) {
  for (std::size_t i = 0; i + 1 < polyline.size(); ++i) {
    const CurvePoint &a = polyline[i], &b = polyline[i + 1];
    double side_of_c = i + 2 < polyline.size() ? side(a, b, polyline[i + 2]) : 0;
    for (std::size_t j = i + 2; j + 1 < polyline.size(); ++j) {
      const CurvePoint &c = polyline[j], &d = polyline[j + 1];
      const double side_of_d = side(a, b, d);
      if (side_of_c * side_of_d < 0 && side(c, d, a) * side(c, d, b) < 0) return true;
      side_of_c = side_of_d;
    }
  }
  return false;
}

}  // namespace wisp
