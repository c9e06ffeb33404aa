#include "wisp/model/shape_components.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <string>

namespace wisp {
namespace {

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
  if (shape.count() == 0 || shape.symmetric > kMaxShapeComponents || shape.antisymmetric > kMaxShapeComponents) {
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
