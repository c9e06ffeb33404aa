#include "wisp/model/model.hpp"

#include <algorithm>

#include "wisp/model/file.hpp"

namespace wisp {
namespace {

constexpr int kPowers = 3;  // regressors of a wind's magnitude, and of each component: size, root, square

// Outputs of the body's dynamics: symmetric components, vectors' x, vectors' z. x and z have equal coefficients.
struct Places {
  int symmetric;
  int vectors;

  int outputs() const { return symmetric + 2 * vectors; }
  bool is_across(int output) const { return output >= symmetric + vectors; }
  int source(int output) const { return is_across(output) ? output - vectors : output; }
  // Returns the offset of a row's regressors: z components are driven by the wind's z instead of its x.
  int shift(int output) const { return is_across(output) ? kPowers : 0; }
};

ArxOrders orders_of(const ArxOrders& plane, const Places& places) {
  const int ny = places.outputs(), nu = plane.inputs() == 0 ? 0 : plane.inputs() + kPowers;
  ArxOrders out{OrderMatrix(ny, ny), OrderMatrix(ny, nu), OrderMatrix(ny, nu)};
  for (int i = 0; i < ny; ++i) {
    const int from = places.source(i), shift = places.is_across(i) ? places.vectors : 0;
    for (int j = 0; j < plane.outputs(); ++j) {
      out.na(i, j < places.symmetric ? j : j + shift) = plane.na(from, j);
    }
    for (int k = 0; k < plane.inputs(); ++k) {
      if (plane.nb(from, k) == 0) continue;
      out.nb(i, places.shift(i) + k) = plane.nb(from, k);
      out.nk(i, places.shift(i) + k) = plane.nk(from, k);
    }
  }
  return out;
}

template <class T>
void repeat_last(std::vector<T>& values, std::size_t count) {
  if (values.empty()) return;
  const std::vector<T> last(values.end() - static_cast<std::ptrdiff_t>(count), values.end());
  values.insert(values.end(), last.begin(), last.end());
}

// Extends the dynamics by z components. Their mean and constant are 0, as the camera sees no lean towards itself.
void turn_dynamics(ArxModel& arx, const Places& places) {
  const auto vectors = static_cast<std::size_t>(places.vectors);
  arx.orders = orders_of(arx.orders, places);
  repeat_last(arx.theta, vectors);
  arx.std_error.clear();
  for (auto* values : {&arx.constant, &arx.output_mean}) values->resize(values->size() + vectors, 0.0);
  arx.input_mean.resize(static_cast<std::size_t>(arx.orders.inputs()), 0.0);
  repeat_last(arx.noise.sd, vectors);
  repeat_last(arx.noise.sd_ci95, vectors);
  arx.noise.resampled.across = places.vectors;
}

void turn_shape(ShapeComponents& shape) {
  const std::size_t points = shape.points();
  for (std::size_t k = points; k < 2 * points; ++k) {
    const ValueRange& range = shape.coordinates[k];
    const double far = std::max(shape.rest[k] - range.lowest, range.highest - shape.rest[k]);
    shape.coordinates.push_back({-far, far});
  }
  shape.rest.resize(3 * points, 0.0);
  repeat_last(shape.components, shape.antisymmetric);
  shape.across = shape.antisymmetric;
}

void turn_wind(Model& model) {
  Input across = model.inputs[0];
  model.inputs[0].name += ".x";
  model.inputs[0].shape = InputShape::kWindAlong;
  across.name += ".z";
  across.shape = InputShape::kWindAcross;
  model.inputs.push_back(std::move(across));
  repeat_last(model.training.inputs, 1);
}

// Returns whether no symmetric component depends on the past of an antisymmetric one, nor the reverse.
bool is_of_two_kinds(const ArxOrders& orders, int symmetric) {
  for (int i = 0; i < orders.outputs(); ++i) {
    for (int j = 0; j < orders.outputs(); ++j) {
      if ((i < symmetric) != (j < symmetric) && orders.na(i, j) != 0) return false;
    }
  }
  return true;
}

}  // namespace

std::size_t regressor_count(const std::vector<Input>& inputs) {
  std::size_t count = 0;
  for (const Input& input : inputs) count += static_cast<std::size_t>(regressor_count(input.shape));
  return count;
}

int regressor_count(InputShape shape) {
  if (shape == InputShape::kWindAcross) return 3;
  return has_powers(shape) ? 6 : 1;
}

bool has_powers(InputShape shape) { return shape == InputShape::kEvenOdd || is_vector(shape); }

bool is_vector(InputShape shape) { return shape == InputShape::kWindAlong || shape == InputShape::kWindAcross; }

bool is_in_the_round(const Model& model) {
  const auto* outline = std::get_if<OutlineView>(&model.view);
  return outline && outline->shape.across > 0;
}

Result<Model> in_the_round(const Model& plane) {
  if (is_in_the_round(plane)) return plane;
  if (auto ok = check(plane); !ok) return ok.error();
  const auto* arx = std::get_if<ArxModel>(&plane.dynamics);
  const auto* outline = std::get_if<OutlineView>(&plane.view);
  if (!arx || !outline || outline->shape.antisymmetric == 0 || arx->noise.resampled.empty() ||
      !is_of_two_kinds(arx->orders, static_cast<int>(outline->shape.symmetric))) {
    return Error{
        "the model can't be turned about the vertical: expected a flame that moves in symmetric and "
        "antisymmetric components; learn it with wisp learn flame"};
  }
  const bool still = std::any_of(arx->input_mean.begin(), arx->input_mean.end(), [](double mean) { return mean != 0; });
  const auto& resampled = arx->noise.resampled;
  const bool sided = resampled.toward == kPowers && !resampled.mirror.empty();
  if (!plane.inputs.empty() && (plane.inputs.size() > 1 || plane.inputs[0].shape != InputShape::kEvenOdd ||
                                plane.inputs[0].lowest != -plane.inputs[0].highest || still || !sided)) {
    return Error{"the model can't be turned about the vertical: expected one input, a wind from either side"};
  }
  const Places places{static_cast<int>(outline->shape.symmetric), static_cast<int>(outline->shape.antisymmetric)};
  Model model = plane;
  turn_dynamics(std::get<ArxModel>(model.dynamics), places);
  turn_shape(std::get<OutlineView>(model.view).shape);
  if (!model.inputs.empty()) turn_wind(model);
  return model;
}

}  // namespace wisp
