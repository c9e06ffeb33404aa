#include "capture/vision/outline_verdict.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "capture/vision/plane_length.hpp"

namespace wisp {
namespace {

// Calibrated on the scenes of studies/scenes and on films; wisp_verify_scenes prints how often they are wrong.
constexpr double kMaxMissing = 0.04;    // share of rows
constexpr double kMaxJumps = 0.03;      // share of steps
constexpr double kMoveShare = 0.35;     // of the height: a base that moves farther in a frame is another one
constexpr double kJumpRatio = 2.2;      // … and a height that changes so many times
constexpr double kMaxAtBorder = 0.05;   // share of rows
constexpr double kMaxElsewhere = 0.1;   // share of the clip's rows: who lights a candle is in the picture for less
constexpr double kMaxStill = 0.3;       // share of the rows until the last outline
constexpr double kMisfit = 0.1;         // heights, shared by the control points; few cannot follow a flame as well
constexpr double kEdgeNoise = 0.3;      // pixels
constexpr double kMinMovement = 0.006;  // heights
constexpr double kMinTaper = 0.32;
constexpr double kMinSolidity = 0.86;
constexpr double kFilled = 0.8;        // of its convex hull: a flame that leans or bends fills more
constexpr double kMaxLean = 45;        // degrees, median: flames in films lean by 2 to 20, one in glare by 36
constexpr double kMaxRagged = 0.15;    // share of outlines that fill less
constexpr double kMaxLost = 0.1;       // share of rows without a frame of their own: flicker is not what lies between
constexpr double kMaxRepeated = 0.35;  // … and that repeat the one before
constexpr double kFlat = 0.5;          // share of a shape that is clipped: then its form is the camera's
constexpr double kMinHeight = 10;      // pixels
constexpr double kOutSeconds = 0.3;    // without a flame until the end: it went out; gaps in films last 0.13 at most

constexpr int kCurvePoints = 64;

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// One row's outline.
struct OutlineRow {
  std::size_t row = 0;
  std::vector<CurvePoint> curve;
  CurvePoint base;
  CurvePoint tip;
  double height = 0;
};

OutlineRow shape_of(const Recording& recording, const SplineTable& table, std::size_t row) {
  std::vector<double> controls(2 * static_cast<std::size_t>(table.points()));
  for (std::size_t i = 0; i < controls.size(); ++i) controls[i] = recording.channels[i].samples[row];
  OutlineRow shape{.row = row, .curve = curve_polyline(table, controls, kCurvePoints), .base = {}, .tip = {}};
  const CurvePoint first = shape.curve.front(), last = shape.curve.back();
  shape.base = {0.5 * (first.x + last.x), 0.5 * (first.y + last.y)};
  for (const CurvePoint& p : shape.curve) {
    const double reach = length(p.x - shape.base.x, p.y - shape.base.y);
    if (reach <= shape.height) continue;
    shape.height = reach;
    shape.tip = p;
  }
  return shape;
}

// Twice the area of the triangle a, b, c; above 0 where they turn left.
double turn(const CurvePoint& a, const CurvePoint& b, const CurvePoint& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

// How wide a shape is across its axis at a share of its height above the base.
double width_at(const OutlineRow& shape, double share) {
  const double ax = (shape.tip.x - shape.base.x) / shape.height, ay = (shape.tip.y - shape.base.y) / shape.height;
  double low = 1e30, high = -1e30;
  for (std::size_t k = 0; k < shape.curve.size(); ++k) {
    const CurvePoint &a = shape.curve[k], &b = shape.curve[(k + 1) % shape.curve.size()];
    const auto along = [&](const CurvePoint& p) { return (p.x - shape.base.x) * ax + (p.y - shape.base.y) * ay; };
    const double at = share * shape.height, from = along(a), to = along(b);
    if ((from > at) == (to > at)) continue;
    const double part = (at - from) / (to - from);
    const double x = a.x + part * (b.x - a.x) - shape.base.x, y = a.y + part * (b.y - a.y) - shape.base.y;
    low = std::min(low, ay * x - ax * y);
    high = std::max(high, ay * x - ax * y);
  }
  return std::max(0.0, high - low);
}

// How wide a shape is across its axis where it is widest, in heights.
double full_width(const OutlineRow& shape) {
  double low = 1e30, high = -1e30;
  for (const CurvePoint& p : shape.curve) {
    const double across = turn(shape.base, shape.tip, p) / (shape.height * shape.height);
    low = std::min(low, across);
    high = std::max(high, across);
  }
  return high - low;
}

// How far it leans to either side, degrees: 0 where its tip lies above its base, 90 beside it, 180 below.
double lean_of(const OutlineRow& shape) {
  return std::atan2(std::abs(shape.tip.x - shape.base.x), shape.base.y - shape.tip.y) * 180 / std::numbers::pi;
}

double taper_of(const OutlineRow& shape) {
  const double body = width_at(shape, 0.4);
  return body <= 0 ? 0 : 1 - width_at(shape, 0.88) / body;
}

double area_of(const std::vector<CurvePoint>& corners) {
  double twice = 0;
  for (std::size_t k = 2; k < corners.size(); ++k) twice += turn(corners[0], corners[k - 1], corners[k]);
  return 0.5 * std::abs(twice);
}

// A. M. Andrew, Information Processing Letters 9 (1979).
std::vector<CurvePoint> convex_hull(std::vector<CurvePoint> points) {
  std::sort(points.begin(), points.end(),
            [](const auto& a, const auto& b) { return a.x < b.x || (a.x == b.x && a.y < b.y); });
  std::vector<CurvePoint> hull;
  for (const bool back : {false, true}) {
    const std::size_t begin = hull.size();
    for (const CurvePoint& p : points) {
      while (hull.size() >= begin + 2 && turn(hull[hull.size() - 2], hull.back(), p) <= 0) hull.pop_back();
      hull.push_back(p);
    }
    hull.pop_back();
    if (!back) std::reverse(points.begin(), points.end());
  }
  return hull;
}

double ragged_share(const std::vector<OutlineRow>& shapes) {
  const auto ragged = std::count_if(shapes.begin(), shapes.end(), [](const OutlineRow& shape) {
    return area_of(shape.curve) < kFilled * area_of(convex_hull(shape.curve));
  });
  return static_cast<double>(ragged) / static_cast<double>(shapes.size());
}

double movement_of(const std::vector<OutlineRow>& shapes, double height) {
  double squares = 0;
  for (int k = 0; k < kCurvePoints; ++k) {
    double x = 0, y = 0, xx = 0, yy = 0;
    for (const OutlineRow& s : shapes) {
      const double dx = s.curve[static_cast<std::size_t>(k)].x - s.base.x,
                   dy = s.curve[static_cast<std::size_t>(k)].y - s.base.y;
      x += dx;
      y += dy;
      xx += dx * dx;
      yy += dy * dy;
    }
    const double n = static_cast<double>(shapes.size());
    squares += std::max(0.0, xx / n - x * x / (n * n) + yy / n - y * y / (n * n)) / kCurvePoints;
  }
  return std::sqrt(squares) / height;
}

double jumps_of(const std::vector<OutlineRow>& shapes, double height) {
  std::size_t steps = 0, jumps = 0;
  for (std::size_t k = 1; k < shapes.size(); ++k) {
    const OutlineRow &a = shapes[k - 1], &b = shapes[k];
    if (b.row != a.row + 1) continue;
    ++steps;
    const double ratio = std::max(a.height, b.height) / std::min(a.height, b.height);
    jumps += length(b.base.x - a.base.x, b.base.y - a.base.y) > kMoveShare * height || ratio > kJumpRatio;
  }
  return steps == 0 ? 0 : static_cast<double>(jumps) / static_cast<double>(steps);
}

// Shares of rows in which the curve reaches a border, but for the border on which both of its ends lie: there the
// picture cuts off what holds it, as a flag's mast.
std::array<double, 4> border_of(const std::vector<OutlineRow>& shapes, int width, int height) {
  constexpr double kNear = 1.5;  // pixels
  std::array<double, 4> out{};
  for (const OutlineRow& shape : shapes) {
    const auto at = [&](const CurvePoint& p) -> std::array<bool, 4> {
      return {p.x<kNear, p.y<kNear, p.x> width - 1 - kNear, p.y> height - 1 - kNear};
    };
    const auto first = at(shape.curve.front()), last = at(shape.curve.back());
    for (std::size_t k = 0; k < 4; ++k) {
      const bool attached = first[k] && last[k];
      const bool reached = std::any_of(shape.curve.begin(), shape.curve.end(), [&](const auto& p) { return at(p)[k]; });
      if (reached && !attached) out[k] += 1 / static_cast<double>(shapes.size());
    }
  }
  return out;
}

// The row after the last outline, where nothing comes for long enough and the film does not fade out.
std::optional<std::size_t> out_at(const CaptureReport& report, std::size_t last) {
  const std::size_t dark = report.frames - 1 - last;
  if (report.facts.fades_out || static_cast<double>(dark) < kOutSeconds * report.rate_hz) return std::nullopt;
  return last + 1;
}

std::string percent(double share) {
  char text[16];
  std::snprintf(text, sizeof text, "%.0f %%", 100 * share);
  return text;
}

// Of the rows in which the flame burns, those without an outline.
double missing_share(const OutlineFacts& facts) {
  return static_cast<double>(facts.absent - facts.blown) / static_cast<double>(facts.rows - facts.blown);
}

// Why frames are not where they should be, or nothing.
std::string irregular(const OutlineFacts& f) {
  if (f.lost > kMaxLost) {
    return "its frames come irregularly, " + percent(f.lost) +
           " are missing from the clip; film at a fixed rate, with more light or less to do for the camera";
  }
  if (f.repeated > kMaxRepeated) {
    return percent(f.repeated) +
           " of its frames repeat the one before: it was filmed at a lower rate; give the clip in that rate";
  }
  return {};
}

// Why it is not one scene, or nothing.
std::string cut(const OutlineFacts& f, std::size_t frames) {
  const std::size_t other = f.other_before + f.other_after;
  if (static_cast<double>(other) <= kMaxElsewhere * static_cast<double>(frames)) return {};
  return "in " + percent(static_cast<double>(other) / static_cast<double>(frames)) +
         " of the frames it is gone and another bright thing is in the picture: the film is cut, or the camera moves "
         "too far; give frames " +
         std::to_string(f.seen_from + 1) + " to " + std::to_string(f.seen_from + f.rows) + " alone, or another scene's";
}

// Why it does not move as a flame does, or nothing.
std::string rigid(const OutlineFacts& f) {
  const double still = static_cast<double>(f.still) / static_cast<double>(f.seen_from + f.rows);
  if (f.movement >= kMinMovement && still <= kMaxStill) return {};
  return "its edges do not move" + (still > kMaxStill ? " in " + percent(still) + " of the frames" : std::string()) +
         ": it may be a lamp or a lit thing; film a flame in a dark room";
}

// Whether the curve follows the edge: a flame's is smooth.
bool follows(const OutlineFacts& f, int points) { return f.misfit <= kMisfit / points + kEdgeNoise / f.height; }

// Why the shape is not a flame's, or nothing.
std::string misshapen(const OutlineFacts& f, int points) {
  const bool taper = f.taper >= kMinTaper && f.narrowing >= kMinNarrowing,
             solid = f.solidity >= kMinSolidity && f.ragged <= kMaxRagged && f.width <= kMaxWidth && follows(f, points);
  if (taper && solid) return {};
  if (f.clipped > kFlat) {
    return "it is clipped flat, " + percent(f.clipped) +
           " of it as bright as the camera shows anything, and its shape is not a flame's; film it darker";
  }
  if (!taper) {
    return "it does not taper upwards as a flame does; choose a region around the flame, or film it before a dark "
           "ground";
  }
  return "its shape is not a flame's: it may have run together with what it lights; film it darker, so that only the "
         "flame is bright";
}

// The first of what makes an outline unusable, or nothing.
std::string fault(const OutlineFacts& f, const CaptureReport& report) {
  constexpr std::array<const char*, 4> kSide{"left", "upper", "right", "lower"};
  const bool flame = report.flames > 0;
  if (std::string why = rigid(f); !why.empty()) return why;
  if (flame && f.lean > kMaxLean) {
    return "it lies on its side, " + std::to_string(std::lround(f.lean)) +
           " degrees from upright: the film seems to be turned; rotate it so that the flame points upwards";
  }
  if (flame && f.light < kMinLight) {
    return "other things in the picture are brighter; choose a region around the flame, or film it in a dark room";
  }
  if (flame && f.contrast < kMinContrast) {
    return "it is hardly brighter than what is around it, by " + std::to_string(std::lround(f.contrast)) +
           " of 255 levels: it may be a lit wall; film a flame before a dark ground";
  }
  if (std::string why = irregular(f); !why.empty()) return why;
  if (std::string why = cut(f, report.frames); !why.empty()) return why;
  if (missing_share(f) > kMaxMissing) {
    return "it is missing in " + percent(missing_share(f)) +
           " of the frames; film it steadily, with nothing in between";
  }
  if (f.jumps > kMaxJumps) {
    return "it jumps in " + percent(f.jumps) +
           " of the frames; keep the camera still, and only one flame in the picture";
  }
  for (const std::size_t side : {0, 1, 2}) {
    if (f.border[side] <= kMaxAtBorder) continue;
    return "it reaches the " + std::string(kSide[side]) + " border of the picture in " + percent(f.border[side]) +
           " of the frames; leave room around it";
  }
  if (std::string why = flame ? misshapen(f, report.points) : ""; !why.empty()) return why;
  if (f.height < kMinHeight)
    return "it is only " + std::to_string(std::lround(f.height)) + " pixels high; film it from nearer";
  return {};
}

void give_verdict(CaptureReport& report) {
  const std::string why = fault(report.facts, report);
  report.usable = why.empty();
  report.reason = report.usable ? "an outline was found in " + percent(1 - missing_share(report.facts)) +
                                      " of the frames and moves steadily"
                                : why;
  if (static_cast<double>(report.facts.seen_from) > kOutSeconds * report.rate_hz) {
    report.reason += "; it is seen from frame " + std::to_string(report.facts.seen_from + 1) + " on";
  }
  if (report.flames > 1) report.reason += "; there are " + std::to_string(report.flames) + " flames, one is followed";
  if (report.out_at && report.facts.other_after == 0)
    report.reason += "; the flame is out from frame " + std::to_string(*report.out_at + 1) + " on";
}

}  // namespace

void excuse_absence(CaptureReport& report, std::size_t rows, std::size_t times) {
  report.facts.blown = std::min(rows, report.facts.absent);
  if (report.facts.blown == 0) return;
  give_verdict(report);
  report.reason += "; it is blown out and lit again " + (times == 1 ? "once" : std::to_string(times) + " times");
}

void judge_outline(const Recording& recording, const SplineTable& table, CaptureReport& report) {
  std::vector<OutlineRow> shapes;
  std::vector<double> heights, tapers, widths, leans;
  for (std::size_t row = 0; row < recording.rows(); ++row) {
    if (std::isnan(recording.channels.front().samples[row])) continue;
    shapes.push_back(shape_of(recording, table, row));
    const OutlineRow& shape = shapes.back();
    heights.push_back(shape.height);
    tapers.push_back(taper_of(shape));
    widths.push_back(full_width(shape));
    leans.push_back(lean_of(shape));
  }
  if (shapes.empty()) return;
  OutlineFacts& facts = report.facts;
  facts.height = std::max(median(heights), 1e-9);
  facts.taper = median(tapers);
  facts.width = median(widths);
  facts.lean = median(leans);
  facts.ragged = ragged_share(shapes);
  facts.movement = movement_of(shapes, facts.height);
  facts.misfit = report.residual / facts.height;
  facts.jumps = jumps_of(shapes, facts.height);
  facts.border = border_of(shapes, report.width, report.height);
  const std::size_t first = shapes.front().row, last = shapes.back().row;
  facts.seen_from = first;
  facts.rows = last - first + 1;
  facts.absent = facts.rows - shapes.size();
  report.out_at = out_at(report, last);
  give_verdict(report);
}

}  // namespace wisp
