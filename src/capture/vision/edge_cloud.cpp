#include "wisp/capture/vision/edge_cloud.hpp"

#include <algorithm>
#include <cmath>

namespace wisp {
namespace {

constexpr std::size_t kLeastBoundary = 12;

// Depth grows towards the side of the base.
struct Down {
  int dx = 0;
  int dy = 1;
  double depth(double x, double y) const { return dx * x + dy * y; }
};

Down down(BaseSide side) {
  switch (side) {
    case BaseSide::kLeft:
      return {-1, 0};
    case BaseSide::kTop:
      return {0, -1};
    case BaseSide::kRight:
      return {1, 0};
    case BaseSide::kBottom:
      break;
  }
  return {0, 1};
}

// Depth of the last row (or column) that can be seen on the base's side, in the window's pixels.
double border_depth(const BoundaryWindow& window, const Down& base) {
  const Region &area = window.area, &place = window.place;
  if (base.dy > 0) return area.bottom() - 1 - place.y;
  if (base.dx > 0) return area.right() - 1 - place.x;
  return base.dy < 0 ? place.y - area.y : place.x - area.x;
}

// A stretch of a closed boundary: `count` pixels from `first` on, clockwise.
struct Arc {
  std::size_t first = 0;
  std::size_t count = 0;
  double base_depth = 0;
  bool cut = false;
};

// From the tip back and forth until the base's depth is reached.
Arc arc_above_base(const BoundaryWindow& window, std::span<const PixelPosition> boundary,
                   const EdgeCloudOptions& options) {
  const Down base = down(options.base);
  const std::size_t size = boundary.size();
  std::size_t highest = 0;
  double lowest_depth = -1e30, highest_depth = 1e30;
  for (std::size_t k = 0; k < size; ++k) {
    const double depth = base.depth(boundary[k].x, boundary[k].y);
    lowest_depth = std::max(lowest_depth, depth);
    if (depth < highest_depth) {
      highest_depth = depth;
      highest = k;
    }
  }
  // Near the picture's edge the trim shrinks to nothing, so that the base does not jump when the edge cuts it off.
  const double gap = border_depth(window, base) - lowest_depth;
  const double trim = std::min(gap, std::max(1.0, options.base_share * (lowest_depth - highest_depth)));
  Arc arc;
  arc.cut = gap == 0;
  arc.base_depth = lowest_depth - trim;
  const auto above = [&](std::size_t k) {
    return base.depth(boundary[k % size].x, boundary[k % size].y) < arc.base_depth;
  };
  std::size_t back = 0, forth = 0;
  while (back + 1 < size && above(highest + size - back - 1)) ++back;
  while (forth + 1 < size - back && above(highest + forth + 1)) ++forth;
  arc.first = (highest + size - back) % size;
  arc.count = back + forth + 1;
  return arc;
}

void locate_points(const BoundaryWindow& window, std::span<const PixelPosition> boundary, const Arc& arc,
                   int most_points, std::vector<EdgePoint>& points) {
  const std::size_t most = static_cast<std::size_t>(std::max(most_points, 2));
  const std::size_t stride = (arc.count + most - 1) / most;
  points.clear();
  for (std::size_t k = 0; k < arc.count; k += stride) {
    points.push_back(locate_edge(window.image, window.level, boundary[(arc.first + k) % boundary.size()]));
  }
}

// Moves the outermost point along the side's own direction to the base's depth, so that both ends lie on one line.
void end_at_base(EdgePoint& end, const EdgePoint& inner, const Down& base, double depth) {
  const double at = base.depth(end.x, end.y), before = base.depth(inner.x, inner.y);
  const double run = at - before;
  const double along = std::abs(run) > 0.5 ? std::clamp((depth - at) / run, -2.0, 2.0) : 0.0;
  end.x += along * (end.x - inner.x);
  end.y += along * (end.y - inner.y);
  const double miss = depth - base.depth(end.x, end.y);
  end.x += base.dx * miss;
  end.y += base.dy * miss;
}

// The tip's place in arc length: the mean of places weighted by how nearly farthest from the base they are, which does
// not leap from corner to corner of a blunt tip.
double tip_place(const EdgeCloud& cloud, const std::vector<double>& arc_length, double& height) {
  const double bx = cloud.base_x(), by = cloud.base_y();
  double farthest = 0;
  for (const EdgePoint& p : cloud.points) farthest = std::max(farthest, std::hypot(p.x - bx, p.y - by));
  height = farthest;
  const double blur = std::max(0.02 * farthest, 0.5);
  double weights = 0, places = 0;
  for (std::size_t k = 0; k < cloud.points.size(); ++k) {
    const double short_by = (farthest - std::hypot(cloud.points[k].x - bx, cloud.points[k].y - by)) / blur;
    if (short_by > 4) continue;
    const double weight = (4 - short_by) * (4 - short_by);
    weights += weight;
    places += weight * arc_length[k];
  }
  return places / weights;
}

bool place_along(EdgeCloud& cloud, double tip_s) {
  std::vector<double>& s = cloud.s;
  s.assign(cloud.points.size(), 0.0);
  for (std::size_t k = 1; k < s.size(); ++k) {
    const EdgePoint &a = cloud.points[k - 1], &b = cloud.points[k];
    s[k] = s[k - 1] + std::hypot(b.x - a.x, b.y - a.y);
  }
  const double whole = s.back(), tip = tip_place(cloud, s, cloud.height);
  if (tip <= 0 || tip >= whole) return false;
  cloud.tip_share = tip / whole;
  for (double& place : s) {
    place = place <= tip ? tip_s * place / tip : tip_s + (1 - tip_s) * (place - tip) / (whole - tip);
  }
  s.back() = 1;
  return true;
}

}  // namespace

bool make_edge_cloud(const BoundaryWindow& window, std::span<const PixelPosition> boundary,
                     const EdgeCloudOptions& options, EdgeCloud& cloud) {
  if (boundary.size() < kLeastBoundary) return false;
  const Arc arc = arc_above_base(window, boundary, options);
  if (arc.count < kLeastBoundary / 2) return false;
  locate_points(window, boundary, arc, options.most_points, cloud.points);
  cloud.base_cut = arc.cut;
  const Down base = down(options.base);
  const double depth = arc.base_depth + (arc.cut ? 0.5 : 0.0);
  const std::size_t n = cloud.points.size(), inner = std::min<std::size_t>(3, n - 1);
  end_at_base(cloud.points.front(), EdgePoint(cloud.points[inner]), base, depth);
  end_at_base(cloud.points.back(), EdgePoint(cloud.points[n - 1 - inner]), base, depth);
  for (EdgePoint& point : cloud.points) {
    point.x += window.place.x;
    point.y += window.place.y;
  }
  return place_along(cloud, options.tip_s);
}

}  // namespace wisp
