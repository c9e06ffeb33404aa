// Bézier points of a spline by its polar form: L. Ramshaw, Blossoms are polar forms, CAGD 6 (1989), section 4.

#include "export/outline.hpp"


#include "model/bspline.hpp"
#include "wisp/export/export.hpp"

namespace wisp::exporting {
namespace {

using Point = std::array<double, 2>;

// Returns the polar form of the piece between knots[span] and knots[span + 1] at three parameters.
Point blossom(const std::vector<double>& knots, std::span<const float> control, std::size_t span,
              const std::array<double, 3>& at) {
  std::array<Point, 4> points{};
  for (std::size_t k = 0; k < 4; ++k) {
    const std::size_t from = 2 * (span - 3 + k);
    points[k] = {control[from], control[from + 1]};
  }
  for (std::size_t level = 1; level <= 3; ++level) {
    for (std::size_t k = 3; k >= level; --k) {
      const double low = knots[span - 3 + k], high = knots[span + 1 + k - level];
      const double share = (at[level - 1] - low) / (high - low);
      for (std::size_t axis = 0; axis < 2; ++axis) {
        points[k][axis] = (1 - share) * points[k - 1][axis] + share * points[k][axis];
      }
    }
  }
  return points[3];
}

}  // namespace

std::vector<float> outline_points(const std::vector<double>& knots, std::span<const double> control, int points) {
  std::vector<float> out;
  for (int p = 0; p < points; ++p) {
    const BasisWeights weights = basis(knots, static_cast<double>(p) / (points - 1));
    Point sum{};
    for (std::size_t k = 0; k < 4; ++k) {
      const std::size_t from = 2 * (static_cast<std::size_t>(weights.first) + k);
      if (weights.weight[k] == 0) continue;
      for (std::size_t axis = 0; axis < 2; ++axis) sum[axis] += weights.weight[k] * control[from + axis];
    }
    out.insert(out.end(), {static_cast<float>(sum[0]), static_cast<float>(sum[1]), 0});
  }
  return out;
}

std::vector<std::array<double, 2>> bezier_points(const std::vector<double>& knots, std::span<const float> control) {
  std::vector<Point> points{{control[0], control[1]}};
  for (std::size_t span = 3; span + 4 < knots.size(); ++span) {
    const double a = knots[span], b = knots[span + 1];
    if (a == b) continue;
    points.push_back(blossom(knots, control, span, {a, a, b}));
    points.push_back(blossom(knots, control, span, {a, b, b}));
    points.push_back(blossom(knots, control, span, {b, b, b}));
  }
  return points;
}

std::vector<double> operating_point(const Model& model) {
  if (const auto* outline = std::get_if<OutlineView>(&model.view); outline && !outline->shape.empty()) {
    return control_points(outline->shape, std::vector<double>(outline->shape.count(), 0.0));
  }
  if (const auto* arx = std::get_if<ArxModel>(&model.dynamics)) return arx->output_mean;
  if (const auto* switched = std::get_if<SwitchedArxModel>(&model.dynamics)) return switched->output_mean;
  return std::vector<double>(model.outputs.size(), 0.0);
}

Result<void> check_take(const Model& model, const Take& take) {
  const bool right = take.frames > 0 && take.instances > 0 && take.outputs == model.outputs.size() &&
                     take.values.size() == take.sides * take.frames * take.instances * take.outputs && take.rate_hz > 0;
  if (right) return {};
  return Error{"the take has " + std::to_string(take.outputs) + " outputs and " + std::to_string(take.frames) +
               " frames, expected one of this model, which has " + std::to_string(model.outputs.size()) + " outputs"};
}

}  // namespace wisp::exporting

namespace wisp {

std::vector<float> outline_of(const Model& model, const Take& take, std::size_t frame, std::size_t instance,
                              int points) {
  const auto row = take.at(frame, instance);
  const auto spatial = exporting::outline_points(std::get<OutlineView>(model.view).knots,
                                                 std::vector<double>(row.begin(), row.end()), points);
  std::vector<float> flat;
  for (std::size_t k = 0; k < spatial.size(); k += 3) flat.insert(flat.end(), {spatial[k], spatial[k + 1]});
  return flat;
}

}  // namespace wisp
