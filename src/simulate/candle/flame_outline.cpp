#include "simulate/candle/flame_outline.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "model/bspline.hpp"
#include "simulate/candle/virtual_camera.hpp"

namespace wisp {

namespace flow {
namespace {

// Sides of a square: lower, right, upper, left.
enum Side { kLower, kRight, kUpper, kLeft };

struct Lattice {
  std::span<const float> values;
  int columns;
  int rows;
  float level;

  float at(int i, int j) const { return values[static_cast<std::size_t>(j) * columns + i]; }

  // Returns the index of a square's edge: twice the index of its lower or left end, plus 1 if the edge is vertical.
  int edge(int i, int j, int side) const {
    switch (side) {
      case kLower:
        return 2 * (j * columns + i);
      case kUpper:
        return 2 * ((j + 1) * columns + i);
      case kLeft:
        return 2 * (j * columns + i) + 1;
      default:
        return 2 * (j * columns + i + 1) + 1;
    }
  }

  PointMm crossing(int edge) const {
    const int i = edge / 2 % columns;
    const int j = edge / 2 / columns;
    const bool up = edge % 2 != 0;
    const double a = static_cast<double>(at(i, j));
    const double b = static_cast<double>(up ? at(i, j + 1) : at(i + 1, j));
    const double t = (static_cast<double>(level) - a) / (b - a);
    return up ? PointMm{static_cast<double>(i), j + t} : PointMm{i + t, static_cast<double>(j)};
  }
};

// Links the contour's edges in square (i, j): next[edge of entry] = edge of exit. The inside is on the contour's right.
void link_square(const Lattice& lattice, int i, int j, std::vector<int>& next) {
  const std::array<bool, 4> inside = {lattice.at(i, j) > lattice.level, lattice.at(i + 1, j) > lattice.level,
                                      lattice.at(i + 1, j + 1) > lattice.level, lattice.at(i, j + 1) > lattice.level};
  // Counter-clockwise around the corners, the contour enters by a side where outside changes to inside, so that the
  // inside is on its right, and leaves by one where inside changes to outside.
  std::array<int, 2> enters{};
  std::array<int, 2> leaves{};
  int count = 0;
  int left = 0;
  for (int side = 0; side < 4; ++side) {
    const bool from = inside[side];
    const bool to = inside[(side + 1) % 4];
    if (from && !to) leaves[left++] = side;
    if (!from && to) enters[count++] = side;
  }
  if (count == 0) return;
  if (count == 1) {
    next[lattice.edge(i, j, enters[0])] = lattice.edge(i, j, leaves[0]);
    return;
  }
  const float mean =
      0.25F * (lattice.at(i, j) + lattice.at(i + 1, j) + lattice.at(i, j + 1) + lattice.at(i + 1, j + 1));
  const bool joined = mean > lattice.level;
  for (int k = 0; k < 2; ++k) {
    // An inside corner lies between the entry side and the next side. If not joined, each inside corner is cut off by
    // itself; if joined, each outside corner is.
    const int partner = joined ? (enters[k] + 3) % 4 : (enters[k] + 1) % 4;
    next[lattice.edge(i, j, enters[k])] = lattice.edge(i, j, partner);
  }
}

}  // namespace

std::vector<std::vector<PointMm>> closed_contours(std::span<const float> values, int columns, int rows, float level) {
  const Lattice lattice{values, columns, rows, level};
  std::vector<int> next(2 * static_cast<std::size_t>(columns) * rows, -1);
  for (int j = 0; j + 1 < rows; ++j)
    for (int i = 0; i + 1 < columns; ++i) link_square(lattice, i, j, next);

  std::vector<std::vector<PointMm>> contours;
  for (std::size_t start = 0; start < next.size(); ++start) {
    if (next[start] < 0) continue;
    std::vector<PointMm> contour;
    int edge = static_cast<int>(start);
    while (edge >= 0 && next[edge] >= 0) {
      contour.push_back(lattice.crossing(edge));
      const int following = next[edge];
      next[edge] = -1;
      edge = following;
    }
    if (edge == static_cast<int>(start)) contours.push_back(std::move(contour));
  }
  return contours;
}

double clockwise_area(std::span<const PointMm> polygon) {
  double twice = 0;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const PointMm& a = polygon[k];
    const PointMm& b = polygon[(k + 1) % polygon.size()];
    twice += b.x * a.y - a.x * b.y;
  }
  return twice / 2;
}

}  // namespace flow

namespace {

constexpr double kLevel = 0.3;  // light of glowing soot at the contour: half of full brightness in the camera's picture
constexpr double kCut = 0.03;   // share of the flame's height that is cut off below to form the base: the round bottom
                                // of a contour has no corners that fix the first and last control point
constexpr int kSamplesPerCell = 3;
constexpr int kContourPoints = 200;
constexpr double kTipShare = 0.02;
constexpr int kRefits = 8;

double distance(PointMm a, PointMm b) { return std::hypot(b.x - a.x, b.y - a.y); }

// Cells [first, last] of the columns and rows with light above a level; empty if there are none.
struct Extent {
  int left = 0, right = -1, bottom = 0, top = -1;
};

Extent lit_extent(const RigLight& light, double level) {
  Extent e{light.columns, -1, light.rows, -1};
  for (int j = 0; j < light.rows; ++j)
    for (int i = 0; i < light.columns; ++i) {
      if (!(static_cast<double>(light.soot[static_cast<std::size_t>(j) * light.columns + i]) > level)) continue;
      e = {std::min(e.left, i), std::max(e.right, i), std::min(e.bottom, j), std::max(e.top, j)};
    }
  return e;
}

// Returns the largest closed contour, in millimetres. The lattice extends beyond the grid, where it is dark, so the
// contour of a flame that leaves the grid is closed along the grid's border.
std::vector<PointMm> largest_contour(const RigLight& light, double level) {
  const Extent e = lit_extent(light, level);
  if (e.right < e.left) return {};
  const double step = 1.0 / kSamplesPerCell;
  const int columns = (e.right - e.left + 6) * kSamplesPerCell;
  const int rows = (e.top - e.bottom + 6) * kSamplesPerCell;
  const flow::SamplePlaces across = flow::sample_places(columns, e.left - 3, step, light.columns);
  const flow::SamplePlaces upward = flow::sample_places(rows, e.bottom - 3, step, light.rows);
  std::vector<float> mixed(light.columns);
  std::vector<float> lattice;
  lattice.reserve(static_cast<std::size_t>(columns) * rows);
  for (int j = 0; j < rows; ++j) {
    flow::mix_rows(light.soot, light.columns, upward, j, mixed);
    for (int i = 0; i < columns; ++i) lattice.push_back(flow::sample(mixed, across, i));
  }
  std::vector<PointMm> largest;
  double most = 0;
  for (std::vector<PointMm>& contour : flow::closed_contours(lattice, columns, rows, static_cast<float>(level))) {
    const double area = flow::clockwise_area(contour);
    if (area <= most) continue;
    most = area;
    largest = std::move(contour);
  }
  for (PointMm& p : largest) {
    p.x = (e.left - 3 + p.x * step + 0.5) * light.cell_mm - light.wick_x_mm;
    p.y = (e.bottom - 3 + p.y * step + 0.5) * light.cell_mm - light.wick_y_mm;
  }
  return largest;
}

// Returns the part of a closed, clockwise contour above a height, from the left crossing over the top to the right one.
std::vector<PointMm> cut_open(const std::vector<PointMm>& closed, double height) {
  const auto n = static_cast<int>(closed.size());
  const auto higher = [](PointMm a, PointMm b) { return a.y < b.y; };
  const int top = static_cast<int>(std::max_element(closed.begin(), closed.end(), higher) - closed.begin());
  const auto at = [&](int k) { return closed[((k % n) + n) % n]; };
  const auto crossing = [&](PointMm above, PointMm below) {
    const double t = (above.y - height) / (above.y - below.y);
    return PointMm{above.x + t * (below.x - above.x), height};
  };
  int first = top;
  while (first > top - n && at(first - 1).y > height) --first;
  int last = top;
  while (last < first + n - 1 && at(last + 1).y > height) ++last;
  std::vector<PointMm> open;
  if (at(first - 1).y < at(first).y) open.push_back(crossing(at(first), at(first - 1)));
  for (int k = first; k <= last; ++k) open.push_back(at(k));
  if (at(last + 1).y < at(last).y) open.push_back(crossing(at(last), at(last + 1)));
  return open;
}

std::vector<PointMm> evenly_spaced(const std::vector<PointMm>& line, int count) {
  double length = 0;
  for (std::size_t k = 1; k < line.size(); ++k) length += distance(line[k - 1], line[k]);
  std::vector<PointMm> points = {line.front()};
  double passed = 0;
  std::size_t k = 1;
  for (int n = 1; n < count - 1; ++n) {
    const double wanted = length * n / (count - 1);
    while (k + 1 < line.size() && passed + distance(line[k - 1], line[k]) < wanted) {
      passed += distance(line[k - 1], line[k]);
      ++k;
    }
    const double piece = distance(line[k - 1], line[k]);
    const double t = piece > 0 ? std::clamp((wanted - passed) / piece, 0.0, 1.0) : 0.0;
    points.push_back(
        {line[k - 1].x + t * (line[k].x - line[k - 1].x), line[k - 1].y + t * (line[k].y - line[k - 1].y)});
  }
  points.push_back(line.back());
  return points;
}

PointMm combine(const std::vector<PointMm>& points, const BasisWeights& w) {
  PointMm sum;
  for (int k = 0; k < 4; ++k) {
    sum.x += w.weight[k] * points[w.first + k].x;
    sum.y += w.weight[k] * points[w.first + k].y;
  }
  return sum;
}

// Solves the symmetric, positive definite, dense system in place by Cholesky's method, for both coordinates at once.
void solve_normal_equations(std::vector<double>& a, std::vector<PointMm>& b) {
  const auto n = static_cast<int>(b.size());
  for (int i = 0; i < n; ++i)
    for (int j = 0; j <= i; ++j) {
      double sum = a[i * n + j];
      for (int k = 0; k < j; ++k) sum -= a[i * n + k] * a[j * n + k];
      a[i * n + j] = i == j ? std::sqrt(sum) : sum / a[j * n + j];
    }
  for (int i = 0; i < n; ++i) {
    for (int k = 0; k < i; ++k) b[i] = {b[i].x - a[i * n + k] * b[k].x, b[i].y - a[i * n + k] * b[k].y};
    b[i] = {b[i].x / a[i * n + i], b[i].y / a[i * n + i]};
  }
  for (int i = n - 1; i >= 0; --i) {
    for (int k = i + 1; k < n; ++k) b[i] = {b[i].x - a[k * n + i] * b[k].x, b[i].y - a[k * n + i] * b[k].y};
    b[i] = {b[i].x / a[i * n + i], b[i].y / a[i * n + i]};
  }
}

std::vector<PointMm> fit_at(const std::vector<PointMm>& line, const std::vector<double>& s,
                            const std::vector<double>& knots, int points) {
  std::vector<double> normal(static_cast<std::size_t>(points) * points, 0.0);
  // A small ridge term keeps the system solvable if a control point has few samples or none.
  for (int k = 0; k < points; ++k) normal[k * points + k] = 1e-9;
  std::vector<PointMm> right(points);
  for (std::size_t m = 0; m < line.size(); ++m) {
    const BasisWeights w = basis(knots, s[m]);
    for (int i = 0; i < 4; ++i) {
      right[w.first + i].x += w.weight[i] * line[m].x;
      right[w.first + i].y += w.weight[i] * line[m].y;
      for (int j = 0; j < 4; ++j) normal[(w.first + i) * points + w.first + j] += w.weight[i] * w.weight[j];
    }
  }
  solve_normal_equations(normal, right);
  return right;
}

// Fits a spline by least squares over arc length, then refits after moving every sample's parameter towards its nearest
// point of the spline (Hoschek's intrinsic parametrisation): at a pointed tip parameters must advance faster.
std::vector<PointMm> fit_spline(const std::vector<PointMm>& line, int points) {
  const std::vector<double> knots = uniform_knots(points);
  std::vector<double> s(line.size());
  for (std::size_t m = 0; m < s.size(); ++m) s[m] = static_cast<double>(m) / static_cast<double>(s.size() - 1);
  std::vector<PointMm> fitted = fit_at(line, s, knots, points);
  for (int round = 0; round < kRefits; ++round) {
    for (std::size_t m = 1; m + 1 < s.size(); ++m) {
      const PointMm p = combine(fitted, basis(knots, s[m]));
      const PointMm d = combine(fitted, basis_derivative(knots, s[m]));
      const double speed = d.x * d.x + d.y * d.y;
      if (speed > 0) s[m] += ((line[m].x - p.x) * d.x + (line[m].y - p.y) * d.y) / speed;
      s[m] = std::clamp(s[m], s[m - 1], 1.0);
    }
    fitted = fit_at(line, s, knots, points);
  }
  return fitted;
}

PointMm farthest(std::vector<PointMm> line, PointMm base) {
  const auto count = static_cast<std::size_t>(std::max(1.0, kTipShare * static_cast<double>(line.size())));
  std::nth_element(line.begin(), line.begin() + static_cast<std::ptrdiff_t>(count - 1), line.end(),
                   [&](PointMm a, PointMm b) { return distance(a, base) > distance(b, base); });
  PointMm mean;
  for (std::size_t k = 0; k < count; ++k) mean = {mean.x + line[k].x, mean.y + line[k].y};
  return {mean.x / static_cast<double>(count), mean.y / static_cast<double>(count)};
}

}  // namespace

FlameOutline flame_outline(const RigLight& light) {
  FlameOutline outline;
  double sum = 0;
  for (const float value : light.soot) sum += static_cast<double>(value);
  outline.brightness = sum * light.cell_mm * light.cell_mm;

  const std::vector<PointMm> closed = largest_contour(light, kLevel);
  outline.area = flow::clockwise_area(closed);
  if (outline.area < 4 * light.cell_mm * light.cell_mm) return outline;
  const auto lower = [](PointMm a, PointMm b) { return a.y < b.y; };
  const auto [bottom, top] = std::minmax_element(closed.begin(), closed.end(), lower);
  outline.contour = evenly_spaced(cut_open(closed, bottom->y + kCut * (top->y - bottom->y)), kContourPoints);
  const PointMm left = outline.contour.front();
  const PointMm right = outline.contour.back();
  outline.base = {(left.x + right.x) / 2, (left.y + right.y) / 2};
  outline.tip = farthest(outline.contour, outline.base);
  outline.height = outline.tip.y - outline.base.y;
  outline.lean = std::atan2(outline.tip.x - outline.base.x, outline.height) * 180 / 3.14159265358979323846;
  outline.control_points = fit_spline(outline.contour, kOutlinePoints);
  outline.found = true;
  return outline;
}

}  // namespace wisp
