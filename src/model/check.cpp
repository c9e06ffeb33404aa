// Check of a model's content. Reading and writing a file and creating a bank include it.

#include <cmath>
#include <initializer_list>
#include <set>
#include <string>

#include "model/bspline.hpp"
#include "wisp/model/file.hpp"

namespace wisp {
namespace {

constexpr double kLargestBody = 1e4;  // metres

template <class Channel>
Result<void> check_channels(const std::vector<Channel>& channels, const std::string& what) {
  std::set<std::string> names;
  for (const Channel& channel : channels) {
    if (channel.name.empty()) return Error{"an " + what + " has no name"};
    if (channel.name.find('\0') != std::string::npos) return Error{"the name of an " + what + " holds a zero byte"};
    if (!names.insert(channel.name).second) return Error{"two " + what + "s are named " + channel.name};
    const bool finite = std::isfinite(channel.lowest) && std::isfinite(channel.highest);
    if (!finite || channel.lowest > channel.highest) {
      return Error{what + " " + channel.name + " has a range that is not one: " + std::to_string(channel.lowest) +
                   " to " + std::to_string(channel.highest)};
    }
  }
  return {};
}

Result<void> check_shapes(const std::vector<Input>& inputs) {
  for (std::size_t k = 0; k < inputs.size(); ++k) {
    const Input& input = inputs[k];
    const std::size_t other = input.shape == InputShape::kWindAlong ? k + 1 : k - 1;
    const bool paired = other < inputs.size() && is_vector(inputs[other].shape) && inputs[other].shape != input.shape;
    const bool same = paired && input.lowest == -input.highest && input.highest == inputs[other].highest;
    if (!is_vector(input.shape) || same) continue;
    return Error{
        "input " + input.name +
        " is one of the two numbers of a vector, and the other is missing or its range not the same either way"};
  }
  return {};
}

Result<void> check_channels_of(const Model& model, const ArxOrders& orders) {
  const auto* outline = std::get_if<OutlineView>(&model.view);
  const bool shaped = outline != nullptr && !outline->shape.empty();
  const std::size_t moved = shaped ? outline->shape.count() : model.outputs.size();
  if (static_cast<std::size_t>(orders.outputs()) != moved) {
    return Error{"the dynamics have " + std::to_string(orders.outputs()) + " outputs, the model names " +
                 std::to_string(moved) + (shaped ? " components" : "")};
  }
  const std::size_t seen = regressor_count(model.inputs);
  if (static_cast<std::size_t>(orders.inputs()) != seen) {
    return Error{"the dynamics have " + std::to_string(orders.inputs()) + " inputs, the model's inputs make " +
                 std::to_string(seen)};
  }
  return {};
}

Result<void> check_dynamics(const Model& model, const ArxModel& arx) {
  if (auto ok = check(arx); !ok) return ok;
  if (auto ok = check_channels_of(model, arx.orders); !ok) return ok;
  const auto* outline = std::get_if<OutlineView>(&model.view);
  const ResampledResiduals& rows = arx.noise.resampled;
  if (outline && !rows.empty() && rows.across != static_cast<int>(outline->shape.across))
    return Error{"the resampled residuals have another number of components in z than the shape"};
  const double radius = spectral_radius(arx);
  if (!(radius < 1.0)) {
    return Error{"the dynamics are unstable in single precision: spectral radius " + std::to_string(radius) +
                 ", expected below 1; learn it again with stabilisation on"};
  }
  return {};
}

Result<void> check_dynamics(const Model& model, const SwitchedArxModel& switched) {
  if (auto ok = check(switched); !ok) return ok;
  if (auto ok = check_channels_of(model, switched.orders); !ok) return ok;
  for (std::size_t k = 0; k < switched.modes.size(); ++k) {
    const double radius = spectral_radius(mode_model(switched, k));
    if (radius < 1.0) continue;
    return Error{"mode " + std::to_string(k) + " is unstable in single precision: spectral radius " +
                 std::to_string(radius) + ", expected below 1; learn it again"};
  }
  return {};
}

Result<void> check_dynamics(const Model& model, const ChainModel& chain) {
  if (auto ok = check(chain); !ok) return ok;
  const auto channels = static_cast<std::size_t>(channel_count(chain.motion));
  if (model.outputs.size() != channels) {
    return Error{"the chain moves " + std::to_string(channels) + " outputs, the model names " +
                 std::to_string(model.outputs.size())};
  }
  const std::size_t inputs = chain.gust ? 3 : 0;
  if (model.inputs.size() != inputs || regressor_count(model.inputs) != inputs) {
    return Error{"the chain takes " + std::to_string(inputs) + " inputs, the wind's x, y and z for its response to " +
                 "gusts and else none; the model names " + std::to_string(model.inputs.size())};
  }
  for (const Input& input : model.inputs) {
    if (input.lowest == model.inputs[0].lowest && input.highest == model.inputs[0].highest) continue;
    return Error{"the winds x, y and z of the chain have different ranges, expected one"};
  }
  return {};
}

Result<void> check_view(const Model& model, const OutlineView& outline) {
  if (!valid_knots(outline.knots))
    return Error{"the outline's knots are not a clamped, ascending cubic knot vector over 0 to 1"};
  const std::size_t points = outline.knots.size() - kSplineDegree - 1;
  if (model.outputs.size() != 2 * points) {
    return Error{"the outline has " + std::to_string(points) + " control points, expected half of the " +
                 std::to_string(model.outputs.size()) + " outputs"};
  }
  for (double scale : {outline.metres_per_unit, outline.pixels_per_unit}) {
    if (!std::isfinite(scale) || scale < 0) return Error{"the outline's scale is not a positive number"};
  }
  if (!outline.shape.empty() && !std::holds_alternative<ArxModel>(model.dynamics)) {
    return Error{"the outline has a shape of components, which only ARX dynamics move"};
  }
  return check(outline.shape, points);
}

Result<void> check_view(const Model&, const PlainView&) { return {}; }

Result<void> check_body(const Model& model, std::size_t outputs, const std::string& what,
                        std::initializer_list<double> sizes) {
  if (model.outputs.size() != outputs) {
    return Error{"a " + what + " needs " + std::to_string(outputs) + " outputs, the model names " +
                 std::to_string(model.outputs.size())};
  }
  for (double size : sizes) {
    if (!(size >= 0 && size <= kLargestBody)) {
      return Error{"the size of the body in the " + what + " is " + std::to_string(size) + " m, expected 0 to 10000"};
    }
  }
  return {};
}

Result<void> check_view(const Model& model, const PoseView& pose) {
  return check_body(model, 7, "pose", {pose.half_width, pose.half_length});
}

Result<void> check_view(const Model& model, const PositionView& position) {
  return check_body(model, 3, "position", {position.half_width});
}

Result<void> check_inputs_training(const Model& model) {
  const auto& inputs = model.training.inputs;
  if (inputs.empty()) return {};
  if (inputs.size() != model.inputs.size()) {
    return Error{"the training says the scales of " + std::to_string(inputs.size()) + " inputs, the model has " +
                 std::to_string(model.inputs.size())};
  }
  for (std::size_t k = 0; k < inputs.size(); ++k) {
    if (std::isfinite(inputs[k].scale) && inputs[k].scale > 0 && std::isfinite(inputs[k].one_rms) &&
        inputs[k].one_rms >= 0)
      continue;
    return Error{"the training scale of the input " + model.inputs[k].name + " is not a positive number"};
  }
  return {};
}

Result<void> check_training(const Model& model) {
  const Training& made = model.training;
  for (const Figure& figure : made.figures) {
    if (!std::isfinite(figure.value)) return Error{"the figure " + figure.name + " is not a finite number"};
  }
  if (!made.residual_sd.empty() && made.residual_sd.size() != model.outputs.size()) {
    return Error{"the training has " + std::to_string(made.residual_sd.size()) + " residual deviations, the model " +
                 std::to_string(model.outputs.size()) + " outputs"};
  }
  for (double sd : made.residual_sd) {
    if (!std::isfinite(sd) || sd < 0) return Error{"a residual deviation of the training is not a number from 0"};
  }
  if (made.motion && !(made.motion->min_seconds >= 0 && made.motion->debounce >= 0)) {
    return Error{"the training's segmentation is not of numbers from 0"};
  }
  if (made.multiply_adds_per_frame < 0 || made.operations_per_frame < 0) {
    return Error{"the training says a cost below 0"};
  }
  const Preparation& prepared = made.preparation;
  for (const double hz : {prepared.highpass_hz, prepared.lowpass_hz, prepared.resample_hz}) {
    if (!std::isfinite(hz) || hz < 0) return Error{"a frequency of the training's preparation is not a number from 0"};
  }
  return check_inputs_training(model);
}

}  // namespace

Result<void> check(const Model& model) {
  if (!(std::isfinite(model.rate_hz) && model.rate_hz >= 1e-6 && model.rate_hz <= 1e6)) {
    return Error{"the model's rate is " + std::to_string(model.rate_hz) + " Hz, expected 0.000001 to 1000000"};
  }
  if (model.outputs.empty()) return Error{"the model has no outputs"};
  if (auto ok = check_channels(model.inputs, "input"); !ok) return ok;
  if (auto ok = check_shapes(model.inputs); !ok) return ok;
  if (auto ok = check_channels(model.outputs, "output"); !ok) return ok;
  if (auto ok = std::visit([&](const auto& dynamics) { return check_dynamics(model, dynamics); }, model.dynamics); !ok)
    return ok;
  if (auto ok = std::visit([&](const auto& view) { return check_view(model, view); }, model.view); !ok) return ok;
  if (model.extinction) {
    const auto* outline = std::get_if<OutlineView>(&model.view);
    const std::size_t components = outline ? outline->shape.count() - outline->shape.across : 0;
    if (auto ok = check(*model.extinction, model.inputs.size(), components); !ok) return ok;
  }
  return check_training(model);
}

}  // namespace wisp
