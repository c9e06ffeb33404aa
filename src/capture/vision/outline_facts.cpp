#include "capture/vision/outline_rows.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/statistics.hpp"
#include "capture/vision/region.hpp"
#include "capture/vision/survey.hpp"

namespace wisp {
namespace {

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

// Returns the width of a shape across its axis, at `share` of its height above the base.
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

// Returns the maximum width of a shape across its axis, in heights of the shape.
double full_width(const OutlineRow& shape) {
  double low = 1e30, high = -1e30;
  for (const CurvePoint& p : shape.curve) {
    const double across = side_of(shape.base, shape.tip, p) / (shape.height * shape.height);
    low = std::min(low, across);
    high = std::max(high, across);
  }
  return high - low;
}

// Returns the lean in degrees: 0 with the tip above the base, 90 beside the base, 180 below it.
double lean_of(const OutlineRow& shape) {
  return std::atan2(std::abs(shape.tip.x - shape.base.x), shape.base.y - shape.tip.y) * 180 / std::numbers::pi;
}

double taper_of(const OutlineRow& shape) {
  const double body = width_at(shape, 0.4);
  return body <= 0 ? 0 : 1 - width_at(shape, 0.88) / body;
}

// Variance of a curve's points relative to its base, square pixels: total, and its random part from frame to frame.
struct Motion {
  std::array<double, kCurvePoints> variance{};
  std::array<double, kCurvePoints> noise{};
};

Motion motion_of(const std::vector<OutlineRow>& shapes) {
  Motion out;
  std::vector<double> values(shapes.size());
  for (std::size_t k = 0; k < kCurvePoints; ++k) {
    for (const bool x : {true, false}) {
      const auto at = [&](const OutlineRow& s) { return x ? s.curve[k].x - s.base.x : s.curve[k].y - s.base.y; };
      std::transform(shapes.begin(), shapes.end(), values.begin(), at);
      const double spread = deviation(values);
      out.variance[k] += spread * spread;
      double squares = 0;
      for (std::size_t i = 1; i + 1 < values.size(); ++i) {
        const double bend = values[i - 1] - 2 * values[i] + values[i + 1];
        squares += bend * bend / 6;  // expected value for independent noise: its variance
      }
      out.noise[k] += squares / static_cast<double>(std::max<std::size_t>(shapes.size(), 3) - 2);
    }
  }
  return out;
}

void gather_motion(const std::vector<OutlineRow>& shapes, OutlineFacts& facts) {
  const Motion motion = motion_of(shapes);
  const double moved = std::sqrt(mean(motion.variance));
  std::vector<double> noise(motion.noise.begin(), motion.noise.end()), x, y;
  facts.movement = moved / facts.height;
  facts.edge_noise = std::sqrt(quantile(noise, 0.25));
  for (const OutlineRow& shape : shapes) {
    x.push_back(shape.base.x);
    y.push_back(shape.base.y);
  }
  facts.wander = std::hypot(deviation(x), deviation(y)) / std::max(moved, 0.02);
}

double jumps_of(const std::vector<OutlineRow>& shapes, double height) {
  std::size_t steps = 0, jumps = 0;
  for (std::size_t k = 1; k < shapes.size(); ++k) {
    const OutlineRow &a = shapes[k - 1], &b = shapes[k];
    if (b.row != a.row + 1) continue;
    ++steps;
    jumps += length(b.base.x - a.base.x, b.base.y - a.base.y) > kAsNear * height;
  }
  return steps == 0 ? 0 : static_cast<double>(jumps) / static_cast<double>(steps);
}

// Returns the share of rows in which the curve touches each border, except a border at which both ends of the curve
// lie: there the picture cuts off the object's support, such as a flag's mast.
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

bool repeats(const DroppedFrame& one) { return one.reason == "duplicate"; }

// Returns the row after the last outline; none if the absence is short, a fade-out, or ends in a repeated frame.
std::optional<std::size_t> out_at(const CaptureReport& report, std::size_t last) {
  const std::size_t dark = report.frames - 1 - last;
  if (!report.dropped.empty() && repeats(report.dropped.back())) return std::nullopt;
  if (report.facts.fades_out || static_cast<double>(dark) < kGlintSeconds * report.rate_hz) return std::nullopt;
  return last + 1;
}

}  // namespace

bool gather_facts(const Recording& recording, const SplineTable& table, CaptureReport& report) {
  std::vector<OutlineRow> shapes;
  for (std::size_t row = 0; row < recording.rows(); ++row) {
    if (std::isnan(recording.channels.front().samples[row])) continue;
    shapes.push_back(shape_of(recording, table, row));
  }
  if (shapes.empty()) return false;
  OutlineFacts& facts = report.facts;
  const auto usual = [&](double measure(const OutlineRow&)) {
    std::vector<double> values;
    for (const OutlineRow& shape : shapes) values.push_back(measure(shape));
    return median(std::move(values));
  };
  facts.height = std::max(usual([](const OutlineRow& shape) { return shape.height; }), 1e-9);
  facts.taper = usual(taper_of);
  facts.width = usual(full_width);
  facts.lean = usual(lean_of);
  gather_motion(shapes, facts);
  facts.jumps = jumps_of(shapes, facts.height);
  facts.border = border_of(shapes, report.width, report.height);
  const std::size_t first = shapes.front().row, last = shapes.back().row;
  facts.seen_from = first;
  facts.rows = last - first + 1;
  facts.absent = facts.rows - shapes.size();
  for (const DroppedFrame& one : report.dropped)
    facts.absent -= repeats(one) && one.frame > first && one.frame < last ? 1 : 0;
  report.out_at = out_at(report, last);
  return true;
}

}  // namespace wisp
