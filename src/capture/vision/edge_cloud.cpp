#include "capture/vision/edge_cloud.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace wisp {
namespace {

struct Gradient {
  double x = 0;
  double y = 0;
};

// Sobel operator; border pixels are repeated beyond the picture.
Gradient sobel(const ImageView& image, int x, int y) {
  const int left = std::max(x - 1, 0), right = std::min(x + 1, image.width - 1);
  const std::uint8_t* above = image.row(std::max(y - 1, 0));
  const std::uint8_t* here = image.row(y);
  const std::uint8_t* below = image.row(std::min(y + 1, image.height - 1));
  const int gx = above[right] + 2 * here[right] + below[right] - above[left] - 2 * here[left] - below[left];
  const int gy = below[left] + 2 * below[x] + below[right] - above[left] - 2 * above[x] - above[right];
  return {static_cast<double>(gx), static_cast<double>(gy)};
}

double bilinear(const ImageView& image, double x, double y) {
  x = std::clamp(x, 0.0, image.width - 1.0);
  y = std::clamp(y, 0.0, image.height - 1.0);
  const int x0 = std::min(static_cast<int>(x), std::max(image.width - 2, 0));
  const int y0 = std::min(static_cast<int>(y), std::max(image.height - 2, 0));
  const int x1 = std::min(x0 + 1, image.width - 1), y1 = std::min(y0 + 1, image.height - 1);
  const double fx = x - x0, fy = y - y0;
  const double top = image.at(x0, y0) + fx * (image.at(x1, y0) - image.at(x0, y0));
  const double low = image.at(x0, y1) + fx * (image.at(x1, y1) - image.at(x0, y1));
  return top + fy * (low - top);
}

// Returns the edge at a bright pixel on the window's border: the outline runs along the border itself.
EdgePoint border_edge(const ImageView& image, PixelPosition pixel) {
  EdgePoint edge{static_cast<double>(pixel.x), static_cast<double>(pixel.y), 0, 0};
  if (pixel.x == 0) edge.normal_x = -1;
  if (pixel.x == image.width - 1) edge.normal_x = 1;
  if (edge.normal_x == 0) edge.normal_y = pixel.y == 0 ? -1 : 1;
  edge.x += 0.5 * edge.normal_x;
  edge.y += 0.5 * edge.normal_y;
  return edge;
}

bool on_border(const ImageView& image, PixelPosition pixel) {
  return pixel.x == 0 || pixel.y == 0 || pixel.x == image.width - 1 || pixel.y == image.height - 1;
}

constexpr std::size_t kMinBoundary = 12;  // pixels

// Axes relative to the base: across (to the right for a base below) and down (towards the base).
struct Axes {
  double right_x = 1;
  double right_y = 0;
  double across(double x, double y) const { return right_x * x + right_y * y; }
  double down(double x, double y) const { return -right_y * x + right_x * y; }
};

Axes picture_axes(BaseSide side) {
  if (side == BaseSide::kLeft) return {0, 1};
  if (side == BaseSide::kTop) return {-1, 0};
  return side == BaseSide::kRight ? Axes{0, -1} : Axes{1, 0};
}

struct Stretch {
  double low = 1e30;
  double high = -1e30;
  void take(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
};

// Returns the centre of the boundary's extent across the axis, between two depths.
double middle_across(std::span<const PixelPosition> boundary, const Axes& axes, double from, double to) {
  Stretch across;
  for (const PixelPosition& p : boundary) {
    const double down = axes.down(p.x, p.y);
    if (down >= from && down <= to) across.take(axes.across(p.x, p.y));
  }
  return 0.5 * (across.low + across.high);
}

// Returns the slope of the lower part's centre line: pixels to the right per pixel up.
double lean(std::span<const PixelPosition> boundary, const Axes& axes) {
  Stretch depth;
  for (const PixelPosition& p : boundary) depth.take(axes.down(p.x, p.y));
  const double band = std::max(0.1 * (depth.high - depth.low), 1.0);
  const double upper = depth.high - 3.5 * band, lower = depth.high - 1.5 * band;
  return (middle_across(boundary, axes, upper - 0.5 * band, upper + 0.5 * band) -
          middle_across(boundary, axes, lower - 0.5 * band, lower + 0.5 * band)) /
         (2 * band);
}

// Direction in which a corner of the base is the extreme point.
struct Outwards {
  double x = 0;
  double y = 0;
  double reach(double px, double py) const { return x * px + y * py; }
};

// Returns the direction down and to the left (side −1) or right (side 1) at 45 degrees, rotated for an object that
// leans over that corner, as the object's side would otherwise be more extreme than the corner.
Outwards corner_direction(const Axes& axes, int side, double leaning) {
  const double over = side < 0 ? std::min(leaning, 0.0) : std::max(leaning, 0.0);
  const double size = std::sqrt(1 + over * over);
  const double across = (side - over) / size, down = (1 + side * over) / size;
  return {across * axes.right_x - down * axes.right_y, across * axes.right_y + down * axes.right_x};
}

std::size_t farthest(std::span<const PixelPosition> boundary, const Outwards& out) {
  std::size_t best = 0;
  double reached = out.reach(boundary[0].x, boundary[0].y);
  for (std::size_t k = 1; k < boundary.size(); ++k) {
    const double reach = out.reach(boundary[k].x, boundary[k].y);
    if (reach <= reached) continue;
    best = k;
    reached = reach;
  }
  return best;
}

// An arc of a closed boundary: `count` pixels from `first` on, clockwise.
struct Arc {
  std::size_t first = 0;
  std::size_t count = 0;
};

void locate_points(const BoundaryWindow& window, std::span<const PixelPosition> boundary, const Arc& arc,
                   int max_points, std::vector<EdgePoint>& points) {
  const std::size_t most = static_cast<std::size_t>(std::max(max_points, 2));
  const std::size_t stride = (arc.count + most - 1) / most;
  points.clear();
  for (std::size_t k = 0; k < arc.count; k += stride) {
    EdgePoint point = locate_edge(window.image, window.level, boundary[(arc.first + k) % boundary.size()]);
    point.x += window.place.x;
    point.y += window.place.y;
    points.push_back(point);
  }
}

// Returns the area enclosed by the points and a straight line from last to first; positive for clockwise, y down.
double enclosed(std::span<const EdgePoint> points) {
  double twice = 0;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const EdgePoint &a = points[k], &b = points[(k + 1) % points.size()];
    twice += a.x * b.y - b.x * a.y;
  }
  return 0.5 * twice;
}

// Moves an end to its corner's sub-pixel position: the mean of the edge points near the end, weighted by how extreme
// they are in the direction `out`. Drops points beyond the mean, so that the curve ends there.
void settle_corner(std::vector<EdgePoint>& points, bool last, const Outwards& out, double height) {
  const double blur = std::max(0.01 * height, 1.0);
  const auto at = [&](std::size_t k) -> EdgePoint& { return points[last ? points.size() - 1 - k : k]; };
  const std::size_t near = std::min<std::size_t>(points.size() / 4, 32);
  double best = -1e30;
  for (std::size_t k = 0; k < near; ++k) best = std::max(best, out.reach(at(k).x, at(k).y));
  double weights = 0, x = 0, y = 0, place = 0;
  for (std::size_t k = 0; k < near; ++k) {
    const double share = 1 - (best - out.reach(at(k).x, at(k).y)) / blur;
    if (share <= 0) continue;
    weights += share;
    x += share * at(k).x;
    y += share * at(k).y;
    place += share * static_cast<double>(k);
  }
  const std::size_t beyond = static_cast<std::size_t>(place / weights);
  EdgePoint& end = at(beyond);
  end.x = x / weights;
  end.y = y / weights;
  if (last) {
    points.resize(points.size() - beyond);
  } else {
    points.erase(points.begin(), points.begin() + static_cast<std::ptrdiff_t>(beyond));
  }
}

// Returns the arc length at the tip: the mean over the points farthest from the base, weighted by distance, which does
// not jump between the corners of a blunt tip.
double tip_place(const EdgeCloud& cloud) {
  const double blur = std::max(0.02 * cloud.height, 0.5);
  double weights = 0, places = 0;
  for (std::size_t k = 0; k < cloud.points.size(); ++k) {
    const EdgePoint& p = cloud.points[k];
    const double short_by = (cloud.height - length(p.x - cloud.base_x, p.y - cloud.base_y)) / blur;
    if (short_by > 4) continue;
    const double weight = (4 - short_by) * (4 - short_by);
    weights += weight;
    places += weight * cloud.way[k];
  }
  return places / weights;
}

// Computes height, arc lengths and the landmarks' shares of the arc length. Returns whether the tip is between corners.
bool measure_way(EdgeCloud& cloud) {
  const std::size_t count = cloud.points.size();
  cloud.way.assign(count, 0.0);
  cloud.height = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const EdgePoint& b = cloud.points[k];
    cloud.height = std::max(cloud.height, length(b.x - cloud.base_x, b.y - cloud.base_y));
    if (k == 0) continue;
    const EdgePoint& a = cloud.points[k - 1];
    cloud.way[k] = cloud.way[k - 1] + length(b.x - a.x, b.y - a.y);
  }
  const double whole = cloud.way.back(), tip = tip_place(cloud);
  cloud.shares = {cloud.way[cloud.left_corner] / whole, tip / whole, cloud.way[cloud.right_corner] / whole};
  return cloud.shares[0] < cloud.shares[1] && cloud.shares[1] < cloud.shares[2];
}

// Adds half of the underside before the left corner and half after the right one. Returns the number added before.
std::size_t follow_underside(EdgeCloud& cloud, std::vector<EdgePoint>& underside) {
  const std::ptrdiff_t middle = static_cast<std::ptrdiff_t>(underside.size() / 2);
  cloud.points.insert(cloud.points.end(), underside.begin(), underside.begin() + middle + 1);
  cloud.points.insert(cloud.points.begin(), underside.begin() + middle, underside.end());
  return underside.size() - static_cast<std::size_t>(middle);
}

}  // namespace

EdgePoint locate_edge(const ImageView& image, int level, PixelPosition pixel) {
  assert(image.at(pixel.x, pixel.y) > level);
  // Reaches 2.25 pixels: a dark diagonal neighbour is √2 away, and the gradient only approximates its direction.
  constexpr double kStep = 0.75;
  constexpr int kSteps = 3;
  const double target = level + 0.5;
  const Gradient gradient = sobel(image, pixel.x, pixel.y);
  const double size = length(gradient.x, gradient.y);
  if (size == 0) return border_edge(image, pixel);
  const double nx = -gradient.x / size, ny = -gradient.y / size;
  double before = image.at(pixel.x, pixel.y);
  for (int k = 1; k <= kSteps; ++k) {
    const double after = bilinear(image, pixel.x + nx * kStep * k, pixel.y + ny * kStep * k);
    if (after < target) {
      const double along = kStep * (k - 1 + (before - target) / (before - after));
      return {pixel.x + nx * along, pixel.y + ny * along, nx, ny};
    }
    before = after;
  }
  if (on_border(image, pixel)) return border_edge(image, pixel);
  return {pixel.x + 0.5 * nx, pixel.y + 0.5 * ny, nx, ny};
}

std::vector<double> even_pace() {
  std::vector<double> pace(kPaceSteps + 1);
  for (int k = 0; k <= kPaceSteps; ++k) pace[k] = static_cast<double>(k) / kPaceSteps;
  return pace;
}

double at_pace(std::span<const double> pace, double place) {
  const double at = std::clamp(place, 0.0, 1.0) * static_cast<double>(pace.size() - 1);
  const std::size_t step = std::min(pace.size() - 2, static_cast<std::size_t>(at));
  return pace[step] + (at - static_cast<double>(step)) * (pace[step + 1] - pace[step]);
}

void place_points(EdgeCloud& cloud, const EdgeCloudOptions& options) {
  const double whole = cloud.way.back();
  const std::array<double, 5> share{0, cloud.shares[0], cloud.shares[1], cloud.shares[2], 1};
  const std::array<double, 5> place{0, options.landmarks[0], options.landmarks[1], options.landmarks[2], 1};
  cloud.s.resize(cloud.way.size());
  int leg = 0;
  for (std::size_t k = 0; k < cloud.s.size(); ++k) {
    const double at = cloud.way[k] / whole;
    while (leg < 3 && at > share[leg + 1]) ++leg;
    const double extent = share[leg + 1] - share[leg];
    const double part = extent <= 0 ? 1 : std::clamp((at - share[leg]) / extent, 0.0, 1.0);
    cloud.s[k] = at_pace(options.pace, place[leg] + (place[leg + 1] - place[leg]) * part);
  }
}

bool make_edge_cloud(const BoundaryWindow& window, std::span<const PixelPosition> boundary,
                     const EdgeCloudOptions& options, EdgeCloud& cloud) {
  if (boundary.size() < kMinBoundary) return false;
  const Axes axes = picture_axes(options.base);
  const double leaning = lean(boundary, axes);
  const Outwards to_left = corner_direction(axes, -1, leaning), to_right = corner_direction(axes, 1, leaning);
  const std::size_t size = boundary.size();
  const std::size_t left = farthest(boundary, to_left), right = farthest(boundary, to_right);
  // On a pointed foot both corners coincide: the path over the tip is the whole boundary.
  const Arc over{left, left == right ? size : (right + size - left) % size + 1};
  const Arc under{right, (left + size - right) % size + 1};
  if (over.count < kMinBoundary / 2) return false;
  std::vector<EdgePoint> underside;
  locate_points(window, boundary, over, options.max_points, cloud.points);
  locate_points(window, boundary, under, options.max_points, underside);
  if (cloud.points.size() < kMinBoundary / 2) return false;
  const double height = length(window.place.width, window.place.height);
  settle_corner(cloud.points, false, to_left, 0.5 * height);
  settle_corner(cloud.points, true, to_right, 0.5 * height);
  cloud.base_x = 0.5 * (cloud.points.front().x + cloud.points.back().x);
  cloud.base_y = 0.5 * (cloud.points.front().y + cloud.points.back().y);
  cloud.left_out = options.underside ? 0 : std::abs(enclosed(underside));
  cloud.left_corner = 0;
  cloud.right_corner = cloud.points.size() - 1;
  if (options.underside) {
    cloud.left_corner = follow_underside(cloud, underside);
    cloud.right_corner += cloud.left_corner;
  }
  cloud.area = enclosed(cloud.points);
  if (cloud.area <= 0 || !measure_way(cloud)) return false;
  place_points(cloud, options);
  return true;
}

}  // namespace wisp
