#include "run/bank/shape_lanes.hpp"

#include <algorithm>
#include <cmath>

#include "run/state/channels.hpp"
#include "run/state/model_hash.hpp"

namespace wisp {
namespace {

constexpr double kLargestCoordinate = 1e12;  // clamp of rest, ranges and basis of a shape, so that no sum overflows

float bounded_coordinate(double value) {
  if (std::abs(value) < kMinCoefficient) return 0.0f;
  return static_cast<float>(std::clamp(value, -kLargestCoordinate, kLargestCoordinate));
}

}  // namespace

ShapeProgram make_shape_program(const Model& model, Arena& arena) {
  ShapeProgram program;
  const auto* outline = std::get_if<OutlineView>(&model.view);
  if (!outline || outline->shape.empty()) return program;
  const ShapeComponents& shape = outline->shape;
  program.points = shape.points();
  program.symmetric = shape.symmetric;
  program.antisymmetric = shape.antisymmetric;
  program.across = shape.across;
  for (auto* values : {&program.rest, &program.lowest, &program.highest}) {
    *values = arena.take<float>(shape.rest.size());
  }
  program.basis = arena.take<float>(shape.basis.size());
  if (arena.measures()) return program;
  for (std::size_t i = 0; i < shape.rest.size(); ++i) {
    program.rest[i] = bounded_coordinate(shape.rest[i]);
    program.lowest[i] = bounded_coordinate(shape.coordinates[i].lowest);
    program.highest[i] = bounded_coordinate(shape.coordinates[i].highest);
  }
  for (std::size_t k = 0; k < shape.basis.size(); ++k) program.basis[k] = bounded_coordinate(shape.basis[k]);
  return program;
}

std::uint64_t hash_of(const ShapeProgram& program, std::uint64_t before) {
  std::uint64_t hash = before;
  for (const auto numbers : {program.rest, program.lowest, program.highest, program.basis}) {
    if (!numbers.empty()) hash = hash_floats(numbers, hash);
  }
  return hash;
}

}  // namespace wisp
