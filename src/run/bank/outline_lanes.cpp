#include "run/bank/outline_lanes.hpp"

#include <algorithm>

#include "model/bspline.hpp"

namespace wisp {
namespace {

constexpr double kMinWeight = 1e-8;  // basis weights below this are lost in rounding, and taken as 0

// Factors that turn differences of control points into derivatives of the spline, per step of the polyline. A factor is
// 0 where its knots coincide, since no point lies there.
struct Factors {
  std::span<const double> knots;
  double step;

  double of(int degree, std::size_t first, std::size_t last) const {
    const double support = knots[last] - knots[first];
    return support > 0 ? degree * step / support : 0;
  }
  double slope(std::size_t i) const { return of(3, i + 1, i + 4); }
  double bend(std::size_t i) const { return of(2, i + 2, i + 4); }
  double twist(std::size_t span) const { return of(1, span + 3, span + 4); }
};

float share(double weight, double factor) { return weight < kMinWeight ? 0.0f : static_cast<float>(weight / factor); }

// Returns a run that begins at parameter s: the weights of the span's slope, bends and twist in the first point, from
// the basis weights, and in the next two points, from Taylor's series for one step and for two.
PolylineRun run_from(const Factors& factors, const BasisWeights& weights, double s) {
  const auto span = static_cast<std::size_t>(weights.first);
  const auto& weight = weights.weight;
  PolylineRun run{};
  run.control = static_cast<std::uint32_t>(span + 1);
  if (s == 0 || s == 1) {
    run.control = static_cast<std::uint32_t>(s == 0 ? 0 : span + 3);
  } else {
    run.along = static_cast<float>((weight[2] + weight[3]) / factors.slope(span + 1) +
                                   weight[3] / factors.slope(span + 2) - weight[0] / factors.slope(span));
    run.left = share(weight[0], factors.slope(span) * factors.bend(span));
    run.right = share(weight[3], factors.slope(span + 2) * factors.bend(span + 1));
  }
  const double twist = factors.twist(span);
  const double since = (s - factors.knots[span + 3]) / factors.step;
  const double to_go = 1 / twist - since;
  run.step_left = static_cast<float>(twist * (to_go / 2 - to_go * to_go / 2 - 1.0 / 6));
  run.step_right = static_cast<float>(twist * (since / 2 + since * since / 2 + 1.0 / 6));
  run.bend_twist = static_cast<float>(since + 1);
  return run;
}

// Calls add(span, run) for every run, in order.
template <class Add>
void for_each_run(std::span<const double> knots, int points, Add add) {
  const double step = 1.0 / (points - 1);
  const auto at = [&](int point) { return static_cast<double>(point) / (points - 1); };
  const auto span_of = [&](int point) { return basis(knots, at(point)).first; };
  for (int point = 0; point < points;) {
    PolylineRun run = run_from({knots, step}, basis(knots, at(point)), at(point));
    const int span = span_of(point);
    // The last point equals a control point and is a run of its own.
    do {
      ++run.points;
      ++point;
    } while (run.points < kLongestRun && point < points - 1 && span_of(point) == span);
    add(static_cast<std::size_t>(span), run);
  }
}

}  // namespace

PolylineProgram make_polyline(const OutlineView& view, int points, Arena& arena) {
  const std::span<const double> knots = view.knots;
  const std::size_t controls = knots.size() - kSplineDegree - 1;
  std::size_t runs = 0;
  for_each_run(knots, points, [&](std::size_t, const PolylineRun&) { ++runs; });
  PolylineProgram program;
  program.points = points;
  program.slope = arena.take<float>(controls - 1);
  program.bend = arena.take<float>(controls - 2);
  program.twist = arena.take<float>(controls - 3);
  program.end = arena.take<std::uint32_t>(controls - 3);
  program.runs = arena.take<PolylineRun>(runs);
  if (arena.measures()) return program;
  const Factors factors{knots, 1.0 / (points - 1)};
  for (std::size_t i = 0; i < program.slope.size(); ++i) program.slope[i] = static_cast<float>(factors.slope(i));
  for (std::size_t i = 0; i < program.bend.size(); ++i) program.bend[i] = static_cast<float>(factors.bend(i));
  for (std::size_t i = 0; i < program.twist.size(); ++i) program.twist[i] = static_cast<float>(factors.twist(i));
  runs = 0;
  for_each_run(knots, points, [&](std::size_t span, const PolylineRun& run) {
    program.runs[runs++] = run;
    program.end[span] = static_cast<std::uint32_t>(runs);
  });
  for (std::size_t span = 1; span < program.end.size(); ++span) {
    program.end[span] = std::max(program.end[span], program.end[span - 1]);
  }
  return program;
}

}  // namespace wisp
