#pragma once
// The outlines of a block of instances as polylines, by forward differences: within one knot span a point takes three
// additions per coordinate, where four basis weights take seven operations. Source: C. de Boor, A Practical Guide to
// Splines, chapter X (the coefficients of derivatives); differences from Taylor's series, which is finite for a cubic.
// Rounding errors accumulate in differences, so they restart in every span, and after every run of kLongestRun points.

#include <cstdint>
#include <span>

#include "run/lanes/lanes.hpp"
#include "run/state/arena.hpp"
#include "wisp/model/model.hpp"

namespace wisp {

/// Largest number of points computed by differences. The last of them is a sum of eight rounded numbers.
inline constexpr std::uint32_t kLongestRun = 8;

/// Consecutive points in one knot span. The first point and the differences after it are weighted sums of the span's
/// slope, of the bends at its two ends, and of its twist (defined at PolylineProgram).
struct PolylineRun {
  std::uint32_t points;
  std::uint32_t control;  ///< index of the control point to which the weights of the first point add
  float along;            ///< weight of the slope in the first point
  float left;             ///< weights of the left and the right bend in the first point
  float right;
  float step_left;  ///< weights of the left and the right bend in the step to the second point, besides the slope
  float step_right;
  float bend_twist;  ///< weight of the twist by which the second difference exceeds the left bend
};

/// An outline compiled for a number of points. A slope is `slope` times a difference of control points, a bend `bend`
/// times a difference of slopes, a twist `twist` times a difference of bends; all per step of the polyline.
struct PolylineProgram {
  int points = 0;                ///< 0: no outline
  std::span<float> slope;        ///< one factor fewer than control points
  std::span<float> bend;         ///< two factors fewer than control points
  std::span<float> twist;        ///< three factors fewer than control points: one per knot span
  std::span<std::uint32_t> end;  ///< per knot span, one past its last run
  std::span<PolylineRun> runs;
};

/// Compiles an outline for `points` points at equal steps of the spline's parameter. Precondition: points >= 2.
PolylineProgram make_polyline(const OutlineView& view, int points, Arena& arena);

/// Calls show(point, values) for one coordinate (0: x, 1: y) of every point; `controls`: [control point][x, y][lane].
template <class N, class Show>
inline void polyline_lanes(const PolylineProgram& program, int coordinate, const typename N::Real* controls,
                           const Show& show) {
  using Values = Reals<N>;
  const auto control = [&](std::size_t i) { return load<Values>(controls + (2 * i + coordinate) * N::kLanes); };
  const auto times = [](float factor, const Values& values) { return all<Values>(factor) * values; };
  // Small differences are flushed to zero, so that sums cannot be denormal.
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
