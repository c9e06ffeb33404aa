#pragma once
// The outline of a block of instances as polylines, by forward differences: points that follow each other in one knot
// span take three additions a coordinate, where four basis weights take seven operations. Source: C. de Boor, A
// Practical Guide to Splines, chapter X (the coefficients of derivatives); differences from Taylor's series, which
// ends.
//
// Differences pile up rounding, so every span begins anew, and so does every kLongestRun points.

#include <cstdint>
#include <span>

#include "run/lanes/lanes.hpp"
#include "run/state/arena.hpp"
#include "wisp/model/model.hpp"

namespace wisp {

/// Points after the first of a run are sums: in the longest run, of eight numbers that were rounded.
inline constexpr std::uint32_t kLongestRun = 8;

/// Points in a row in one knot span. What the first of them is, and the differences after it, are shares of the span's
/// slope, of the bends at its two ends, and of its twist.
struct PolylineRun {
  std::uint32_t points;
  std::uint32_t control;  ///< the first point is this control point, moved by the next three, or not where all are 0
  float along;
  float left;
  float right;
  float step_left;  ///< to the second point: the slope, and these
  float step_right;
  float bend_twist;  ///< what the second difference is beyond the left bend
};

/// An outline compiled for a number of points. Derivatives of the spline in steps from point to point are a factor
/// times a difference: slopes, of control points; bends, of slopes; twists, of bends.
struct PolylineProgram {
  int points = 0;                ///< 0: there is no outline
  std::span<float> slope;        ///< one less than control points
  std::span<float> bend;         ///< two less
  std::span<float> twist;        ///< three less: one a knot span
  std::span<std::uint32_t> end;  ///< per knot span, one past its last run
  std::span<PolylineRun> runs;
};

/// Lays out the program of `points` points at equal steps of the spline's parameter and, unless the arena measures,
/// fills it.
///
/// Precondition: points >= 2.
PolylineProgram make_polyline(const OutlineView& view, int points, Arena& arena);

/// Calls show(point, values) for one coordinate (0 x, 1 y) of every point in order; `controls` is
/// [control point][x, y][lane].
template <class N, class Show>
inline void polyline_lanes(const PolylineProgram& program, int coordinate, const typename N::Real* controls,
                           const Show& show) {
  using Values = Reals<N>;
  const auto control = [&](std::size_t i) { return load<Values>(controls + (2 * i + coordinate) * N::kLanes); };
  const auto times = [](float factor, const Values& values) { return all<Values>(factor) * values; };
  // Settled: what is added up of them can't be denormal.
  const auto scaled = [&](float factor, const Values& difference) { return settle(times(factor, difference)); };
  const PolylineRun* run = program.runs.data();
  int point = 0;
  Values points[kLongestRun];
  const auto play = [&](const Values& slope, const Values& left, const Values& right, const Values& twist) {
    points[0] = control(run->control);
    if (run->along != 0 || run->left != 0 || run->right != 0) {
      points[0] = points[0] + times(run->along, slope) + times(run->left, left) + times(run->right, right);
    }
    if (run->points == 1) return;
    auto step = slope + times(run->step_left, left) + times(run->step_right, right);
    points[1] = points[0] + step;
    if (run->points == 2) return;
    auto bend = left + times(run->bend_twist, twist);
    step = step + bend;
    points[2] = points[1] + step;
    for (std::uint32_t k = 3; k < run->points; ++k) {
      bend = bend + twist;
      step = step + bend;
      points[k] = points[k - 1] + step;
    }
  };
  auto slope = scaled(program.slope[0], control(1) - control(0));
  auto next = scaled(program.slope[1], control(2) - control(1));
  auto left = scaled(program.bend[0], next - slope);
  for (std::size_t span = 0; span < program.twist.size(); ++span) {
    slope = next;
    next = scaled(program.slope[span + 2], control(span + 3) - control(span + 2));
    const auto right = scaled(program.bend[span + 1], next - slope);
    const auto twist = scaled(program.twist[span], right - left);
    for (const PolylineRun* end = program.runs.data() + program.end[span]; run < end; ++run) {
      play(slope, left, right, twist);
      for (std::uint32_t k = 0; k < run->points; ++k) show(point++, points[k]);
    }
    left = right;
  }
}

}  // namespace wisp
