#include "learn/outline/outline_curve.hpp"

#include <algorithm>
#include <cmath>

namespace wisp {
namespace {

std::vector<CurvedInput> curved_inputs(const PreparedOutlines& prepared) {
  std::vector<CurvedInput> out;
  for (const OutlineInput& input : prepared.inputs) {
    CurvedInput curved{regressor_names({&input, 1}, prepared.shape), input.lowest, input.highest};
    if (prepared.shape.split_sign) {
      curved.lowest = 0;
      curved.highest = std::max(std::abs(input.lowest), std::abs(input.highest));
    }
    if (curved.lowest >= 0) curved.calm = kCalmShare;
    out.push_back(std::move(curved));
  }
  return out;
}

CurveFitOptions fit_options(const PreparedOutlines& prepared, const ArxOrders& orders) {
  return {.orders = orders, .inputs = curved_inputs(prepared)};
}

std::vector<InputCurve> curves_of(std::span<const CurveEstimate> estimates) {
  std::vector<InputCurve> out;
  for (const CurveEstimate& one : estimates) out.push_back(one.curve);
  return out;
}

}  // namespace

Result<CurveChoice> choose_outline_curves(const PreparedOutlines& prepared, bool mirror, const ArxOrders& orders,
                                          std::optional<int> knots) {
  const std::vector<Recording>& own = prepared.recordings;
  std::vector<arx::Fold> folds = arx::folds_of(mirror ? with_mirror_images(own, prepared) : own);
  // A mirror image would tell nothing that its original has not.
  for (arx::Fold& fold : folds) fold.held_out.resize(own.size());
  return choose_input_curves(folds, prepared.channels, fit_options(prepared, orders), knots);
}

Result<std::vector<CurveEstimate>> outline_curves(std::span<const Recording> recordings,
                                                  const PreparedOutlines& prepared, const ArxOrders& orders,
                                                  int knots) {
  CurveFitOptions options = fit_options(prepared, orders);
  options.knots = knots;
  auto fit = fit_input_curves(recordings, prepared.channels, options);
  if (!fit) return fit.error();
  return std::move(fit->curves);
}

std::vector<Recording> bent_outlines(std::span<const Recording> recordings, const PreparedOutlines& prepared,
                                     std::span<const CurveEstimate> curves) {
  std::vector<Recording> out;
  for (const Recording& one : recordings) {
    out.push_back(with_curves(one, curved_inputs(prepared), curves_of(curves)));
  }
  return out;
}

PreparedOutlines bent_preparation(PreparedOutlines prepared, std::span<const CurveEstimate> curves) {
  prepared.recordings = bent_outlines(prepared.recordings, prepared, curves);
  prepared.shape.curve = true;
  for (std::size_t k = 0; k < curves.size(); ++k) prepared.inputs[k].curve = curves[k].curve;
  return prepared;
}

}  // namespace wisp
