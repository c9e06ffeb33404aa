#include <algorithm>
#include <cmath>
#include <functional>
#include <span>
#include <string>

#include "wisp/model/extinction.hpp"
#include "wisp/model/file.hpp"
#include "wisp/model/model.hpp"
#include "wisp/model/shape_components.hpp"
#include "wisp/model/switched.hpp"

namespace wisp {
namespace {

constexpr int kPowers = 6;  // regressors of a wind in the plane, and of each part of a vector

// Which outputs and regressors those of the plane become. Rows of coefficients stay as they are.
struct Places {
  int symmetric;
  int vectors;

  int outputs() const { return symmetric + 2 * vectors; }
  bool is_across(int output) const { return output >= symmetric + vectors; }
  int source(int output) const { return is_across(output) ? output - vectors : output; }
  int first_regressor(int output) const { return output < symmetric ? 0 : is_across(output) ? 2 * kPowers : kPowers; }
};

ArxOrders orders_of(const ArxOrders& plane, const Places& places) {
  const int ny = places.outputs(), nu = 3 * plane.inputs();
  ArxOrders out{OrderMatrix(ny, ny), OrderMatrix(ny, nu), OrderMatrix(ny, nu)};
  for (int i = 0; i < ny; ++i) {
    const int from = places.source(i), shift = places.is_across(i) ? places.vectors : 0;
    for (int j = 0; j < plane.outputs(); ++j) {
      out.na(i, j < places.symmetric ? j : j + shift) = plane.na(from, j);
    }
    for (int k = 0; k < plane.inputs(); ++k) {
      out.nb(i, places.first_regressor(i) + k) = plane.nb(from, k);
      out.nk(i, places.first_regressor(i) + k) = plane.nk(from, k);
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

// Across the picture it stands upright: how it leans there no camera saw.
void turn_dynamics(ArxModel& arx, const Places& places) {
  const auto vectors = static_cast<std::size_t>(places.vectors);
  arx.orders = orders_of(arx.orders, places);
  repeat_last(arx.theta, vectors);
  arx.std_error.clear();
  for (auto* values : {&arx.constant, &arx.output_mean}) values->resize(values->size() + vectors, 0.0);
  arx.input_mean.resize(3 * arx.input_mean.size(), 0.0);
  repeat_last(arx.noise.sd, vectors);
  repeat_last(arx.noise.sd_ci95, vectors);
  arx.noise.mixing.resize(arx.noise.mixing.size() + vectors * static_cast<std::size_t>(arx.noise.rank), 0.0);
  ResampledResiduals& resampled = arx.noise.resampled;
  resampled.across = places.vectors;
  for (int* regressor : {&resampled.toward, &resampled.against}) *regressor += *regressor < 0 ? 0 : kPowers;
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

// Whether symmetric components move without antisymmetric ones, and these without them.
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
  const int vectors = shape == InputShape::kWindAlong ? 2 : 1;
  return vectors * (splits_sign(shape) ? 2 : 1) * (has_powers(shape) ? 3 : 1);
}

bool splits_sign(InputShape shape) { return shape == InputShape::kSplitSign || has_powers(shape); }

bool has_powers(InputShape shape) { return shape == InputShape::kSplitSignPowers || is_vector(shape); }

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
  const bool sided = resampled.toward == 0 && resampled.against == 3 && !resampled.mirror.empty();
  if (!plane.inputs.empty() && (plane.inputs.size() > 1 || plane.inputs[0].shape != InputShape::kSplitSignPowers ||
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

namespace {

constexpr double kProbabilityError = 1e-6;

Result<void> check_numbers(std::span<const double> values, std::size_t expected, const std::string& what) {
  if (values.size() != expected) {
    return Error{what + " has " + std::to_string(values.size()) + " values, expected " + std::to_string(expected)};
  }
  for (double value : values) {
    if (!std::isfinite(value)) return Error{what + " holds a number that is not finite"};
  }
  return {};
}

Result<void> check_probabilities(std::span<const double> values, std::size_t modes, const std::string& what) {
  if (auto ok = check_numbers(values, modes, what); !ok) return ok;
  double sum = 0;
  for (double value : values) {
    if (value < 0) return Error{what + " holds a probability below 0"};
    sum += value;
  }
  if (std::abs(sum - 1) > kProbabilityError) {
    return Error{what + " adds up to " + std::to_string(sum) + ", expected 1"};
  }
  return {};
}

Result<void> check_shock(std::span<const double> shock, int ny, const std::string& mode) {
  const auto size = static_cast<std::size_t>(ny);
  if (auto ok = check_numbers(shock, size * size, mode + "the size of shocks"); !ok) return ok;
  for (int i = 0; i < ny; ++i) {
    for (int j = i + 1; j < ny; ++j) {
      if (shock[i * size + j] != 0) return Error{mode + "the matrix of shocks is not lower triangular"};
    }
  }
  return {};
}

Result<void> check_mode(const SwitchedArxModel& model, std::size_t k) {
  const std::string mode = "mode " + std::to_string(k) + ": ";
  if (auto ok = check_shock(model.modes[k].shock, model.orders.outputs(), mode); !ok) return ok;
  if (auto ok = check(mode_model(model, k)); !ok) return Error{mode + ok.error().message};
  return {};
}

Result<void> check_quantiles(const std::vector<double>& quantiles) {
  if (quantiles.empty()) return {};
  if (auto ok = check_numbers(quantiles, kShockQuantiles, "the list of a shock's quantiles"); !ok) return ok;
  if (std::is_sorted(quantiles.begin(), quantiles.end())) return {};
  return Error{"a shock's quantiles do not ascend"};
}

Result<void> check_chain(const SwitchedArxModel& model) {
  const std::size_t modes = model.modes.size();
  if (auto ok = check_probabilities(model.initial, modes, "the probability of the first mode"); !ok) return ok;
  if (auto ok = check_numbers(model.transitions, modes * modes, "the matrix of transitions"); !ok) return ok;
  for (std::size_t from = 0; from < modes; ++from) {
    const auto of_mode = std::span(model.transitions).subspan(from * modes, modes);
    if (auto ok = check_probabilities(of_mode, modes, "what follows mode " + std::to_string(from)); !ok) return ok;
  }
  return {};
}

}  // namespace

ArxModel mode_model(const SwitchedArxModel& model, std::size_t mode) {
  const ArxMode& of = model.modes[mode];
  const auto ny = static_cast<std::size_t>(std::max(0, model.orders.outputs()));
  ArxModel arx{model.orders, of.theta, of.std_error, of.constant, model.output_mean, model.input_mean, {}};
  arx.noise.sd.assign(ny, 0.0);
  arx.noise.rank = static_cast<int>(ny);
  arx.noise.mixing = of.shock;
  return arx;
}

Result<void> check(const SwitchedArxModel& model) {
  if (model.modes.empty() || model.modes.size() > kMaxArxModes) {
    return Error{"a switched model has " + std::to_string(model.modes.size()) + " modes, expected 1 to 64"};
  }
  for (std::size_t k = 0; k < model.modes.size(); ++k) {
    if (auto ok = check_mode(model, k); !ok) return ok;
  }
  if (auto ok = check_quantiles(model.shock_quantiles); !ok) return ok;
  return check_chain(model);
}

namespace {

struct Range {
  const char* name;
  double value;
  double lowest;
  double highest;
};

// Of the candle rig at 60 rows a second: a clip of --wind puffs.
constexpr double kBorrowedHz = 60;
constexpr std::uint8_t kDying[] = {191, 128, 64, 237, 178, 119, 59, 242, 161, 121, 81, 40, 230, 173, 115, 58};
constexpr std::uint32_t kDyingEnds[] = {3, 7, 12, 16};
constexpr std::uint8_t kCatching[] = {
    167, 222, 255, 255, 197, 197, 207, 220, 228, 231, 234, 237, 240, 244, 246, 243, 241, 242, 246, 249, 250,
    250, 249, 251, 251, 253, 253, 253, 254, 254, 254, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255,
    167, 219, 255, 255, 199, 197, 207, 219, 227, 231, 235, 237, 239, 243, 246, 243, 241, 241, 245, 249, 250,
    249, 249, 249, 251, 252, 253, 253, 253, 254, 254, 254, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255,
    165, 220, 254, 255, 199, 197, 207, 219, 228, 231, 235, 237, 240, 243, 246, 244, 241, 241, 244, 249, 249,
    249, 249, 250, 251, 253, 253, 252, 253, 254, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255};
constexpr std::uint32_t kCatchingEnds[] = {42, 84, 126};

// Events at another rate, their sizes interpolated.
SizeEvents borrowed(std::span<const std::uint8_t> sizes, std::span<const std::uint32_t> ends, double rate_hz) {
  SizeEvents out;
  std::size_t begin = 0;
  for (const std::uint32_t end : ends) {
    const auto rows = static_cast<double>(end - begin);
    const auto steps = std::clamp<std::size_t>(static_cast<std::size_t>(std::lround(rows * rate_hz / kBorrowedHz)), 1,
                                               SizeEvents::kMaxSizes / SizeEvents::kMaxEvents);
    for (std::size_t k = 0; k < steps; ++k) {
      const double at = std::min(rows - 1, static_cast<double>(k) * kBorrowedHz / rate_hz), share = at - std::floor(at);
      const std::size_t row = begin + static_cast<std::size_t>(at);
      out.sizes.push_back(static_cast<std::uint8_t>(
          std::lround((1 - share) * sizes[row] + share * sizes[std::min<std::size_t>(row + 1, end - 1)])));
    }
    out.ends.push_back(static_cast<std::uint32_t>(out.sizes.size()));
    begin = end;
  }
  return out;
}

Result<void> check(const SizeEvents& events, const std::string& what) {
  const bool counted =
      events.ends.size() <= SizeEvents::kMaxEvents && events.sizes.size() <= SizeEvents::kMaxSizes &&
      (events.empty() ? 0 : events.ends.back()) == events.sizes.size() && (events.empty() || events.ends.front() > 0) &&
      std::adjacent_find(events.ends.begin(), events.ends.end(), std::greater_equal<>()) == events.ends.end();
  if (counted) return {};
  return Error{"the extinction rule's events of " + what + " are " + std::to_string(events.ends.size()) + " with " +
               std::to_string(events.sizes.size()) +
               " sizes, expected at most 64, one after the other, each with some"};
}

}  // namespace

SizeEvents dying_of(const Extinction& rule, double rate_hz) {
  return rule.dying.empty() ? borrowed(kDying, kDyingEnds, rate_hz) : rule.dying;
}

SizeEvents catching_of(const Extinction& rule, double rate_hz) {
  return rule.catching.empty() ? borrowed(kCatching, kCatchingEnds, rate_hz) : rule.catching;
}

Result<void> check(const Extinction& rule, std::size_t inputs) {
  if (rule.input >= inputs) {
    return Error{"the extinction rule listens to input " + std::to_string(rule.input) + ", the model has " +
                 std::to_string(inputs)};
  }
  for (const Range& range : {Range{"level", rule.level, 1e-6, 1e6}, Range{"seconds", rule.seconds, 1e-3, 3600},
                             Range{"haste", rule.haste, 0, 100}, Range{"recovery", rule.recovery, 1e-3, 3600}}) {
    if (range.value >= range.lowest && range.value <= range.highest) continue;
    return Error{std::string("the extinction rule's ") + range.name + " is " + std::to_string(range.value) +
                 ", expected " + std::to_string(range.lowest) + " to " + std::to_string(range.highest)};
  }
  if (auto ok = check(rule.dying, "dying"); !ok) return ok;
  return check(rule.catching, "catching");
}

namespace {

constexpr std::size_t kMaxComponents = 256;

bool is_range(const ValueRange& range) {
  return std::isfinite(range.lowest) && std::isfinite(range.highest) && range.lowest <= range.highest;
}

bool are_finite(const std::vector<double>& values) {
  return std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); });
}

}  // namespace

std::vector<double> shape_coordinates(std::span<const double> control_points) {
  const std::size_t points = control_points.size() / 2;
  std::vector<double> out(2 * points);
  for (std::size_t p = 0; p < points / 2; ++p) {
    const double *left = &control_points[2 * p], *right = &control_points[2 * (points - 1 - p)];
    out[2 * p] = (right[0] - left[0]) / 2;
    out[2 * p + 1] = (right[1] + left[1]) / 2;
    out[points + 2 * p] = (right[0] + left[0]) / 2;
    out[points + 2 * p + 1] = (right[1] - left[1]) / 2;
  }
  if (points % 2 == 1) {
    out[points - 1] = control_points[points];
    out[2 * points - 1] = control_points[points - 1];
  }
  return out;
}

std::vector<double> control_points(std::span<const double> shape_coordinates) {
  const std::size_t points = shape_coordinates.size() / 2;
  std::vector<double> out(2 * points);
  for (std::size_t p = 0; p < points / 2; ++p) {
    const double half = shape_coordinates[2 * p], height = shape_coordinates[2 * p + 1];
    const double lean = shape_coordinates[points + 2 * p], tilt = shape_coordinates[points + 2 * p + 1];
    double *left = &out[2 * p], *right = &out[2 * (points - 1 - p)];
    left[0] = lean - half;
    left[1] = height - tilt;
    right[0] = lean + half;
    right[1] = height + tilt;
  }
  if (points % 2 == 1) {
    out[points] = shape_coordinates[points - 1];
    out[points - 1] = shape_coordinates[2 * points - 1];
  }
  return out;
}

std::vector<double> control_points(const ShapeComponents& shape, std::span<const double> components) {
  std::vector<double> at(shape.rest.begin(), shape.rest.begin() + static_cast<std::ptrdiff_t>(2 * shape.points()));
  const double* basis = shape.basis.data();
  for (std::size_t i = 0; i < at.size(); ++i) {
    const bool symmetric = i < shape.points();
    const std::size_t first = symmetric ? 0 : shape.symmetric;
    const std::size_t count = symmetric ? shape.symmetric : shape.antisymmetric;
    for (std::size_t k = 0; k < count; ++k) at[i] += *basis++ * components[first + k];
    at[i] = std::clamp(at[i], shape.coordinates[i].lowest, shape.coordinates[i].highest);
  }
  return control_points(at);
}

Result<void> check(const ShapeComponents& shape, std::size_t points) {
  if (shape.empty()) return {};
  if (shape.across != 0 && shape.across != shape.antisymmetric) {
    return Error{"the shape is in the round, and its antisymmetric components are not of one length"};
  }
  const std::size_t coordinates = (shape.across > 0 ? 3 : 2) * points;
  if (shape.rest.size() != coordinates) {
    return Error{"the shape at rest has " + std::to_string(shape.rest.size()) + " coordinates, expected " +
                 std::to_string(coordinates)};
  }
  if (shape.count() == 0 || shape.symmetric > kMaxComponents || shape.antisymmetric > kMaxComponents) {
    return Error{"the shape has " + std::to_string(shape.count()) + " components, expected 1 to 256 of a kind"};
  }
  if (shape.basis.size() != points * (shape.symmetric + shape.antisymmetric))
    return Error{"the basis of the shape is not points x components"};
  if (shape.coordinates.size() != shape.rest.size() || shape.components.size() != shape.count()) {
    return Error{"the shape has not one range a coordinate and one a component"};
  }
  if (!are_finite(shape.rest) || !are_finite(shape.basis)) return Error{"the shape holds a number that is not finite"};
  for (const auto* ranges : {&shape.coordinates, &shape.components}) {
    if (!std::all_of(ranges->begin(), ranges->end(), is_range)) return Error{"the shape has a range that is not one"};
  }
  return {};
}

}  // namespace wisp
