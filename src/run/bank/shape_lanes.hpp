#pragma once
// Control points of an outline from the components that its dynamics move (wisp/model/shape_components.hpp), for a
// block of instances. It takes half of the products of a full basis, since a coordinate has components of one kind
// only. In the round they are points of the outline as it is seen from a level direction.

#include <cstdint>
#include <span>

#include "run/lanes/lanes.hpp"
#include "run/state/arena.hpp"
#include "wisp/model/model.hpp"

namespace wisp {

/// The shape of an outline, compiled for showing.
struct ShapeProgram {
  std::size_t points = 0;  ///< 0: outputs are shown as the dynamics make them
  std::size_t symmetric = 0;
  std::size_t antisymmetric = 0;
  std::size_t across = 0;    ///< as many where vectors have a z too
  std::span<float> rest;     ///< per coordinate
  std::span<float> lowest;   ///< per coordinate
  std::span<float> highest;  ///< per coordinate
  std::span<float> basis;    ///< points × symmetric, then points × antisymmetric

  bool empty() const { return points == 0; }
  std::size_t components() const { return symmetric + antisymmetric + across; }
};

/// From where a body is seen: what of x and of z points to the right.
struct LevelView {
  float x = 1;
  float z = 0;
};

/// Lays the program out and, unless the arena measures, fills it. It is empty where the model has no such shape.
ShapeProgram make_shape_program(const Model& model, Arena& arena);

/// Combines the program with the hash `before`. Returns `before` where the program is empty.
std::uint64_t hash_of(const ShapeProgram& program, std::uint64_t before);

/// A shape coordinate as the weighted sum of components, [component][lane]. Those from 2N on are z.
template <class N>
inline Reals<N> shape_coordinate(const ShapeProgram& program, std::size_t i, const typename N::Real* components) {
  const bool symmetric = i < program.points;
  const std::size_t count = symmetric ? program.symmetric : program.antisymmetric;
  const bool across = i >= 2 * program.points;
  const std::size_t row = i - (across ? 2 : symmetric ? 0 : 1) * program.points;
  const float* basis = program.basis.data() + (symmetric ? 0 : program.points * program.symmetric) + row * count;
  if (!symmetric) components += (program.symmetric + (across ? count : 0)) * N::kLanes;
  auto sum = all<Reals<N>>(program.rest[i]);
  for (std::size_t k = 0; k < count; ++k, components += N::kLanes) {
    if (basis[k] != 0) sum = sum + all<Reals<N>>(basis[k]) * load<Reals<N>>(components);
  }
  return hold(sum, all<Reals<N>>(program.lowest[i]), all<Reals<N>>(program.highest[i]));
}

/// Calls show(output, values) for every coordinate of every control point; `components` is [component][lane].
template <class N, class Show>
inline void shape_lanes(const ShapeProgram& program, const typename N::Real* components, const Show& show,
                        LevelView view = {}) {
  const std::size_t points = program.points;
  const auto vector = [&](std::size_t i) {
    const auto along = shape_coordinate<N>(program, points + i, components);
    if (program.across == 0) return along;
    const auto across = shape_coordinate<N>(program, 2 * points + i, components);
    return all<Reals<N>>(view.x) * along + all<Reals<N>>(view.z) * across;
  };
  for (std::size_t p = 0; p < points / 2; ++p) {
    const std::size_t right = points - 1 - p;
    for (std::size_t axis = 0; axis < 2; ++axis) {
      const auto even = shape_coordinate<N>(program, 2 * p + axis, components);
      const auto odd = vector(2 * p + axis);
      const auto &half = axis == 0 ? even : odd, &middle = axis == 0 ? odd : even;
      show(2 * p + axis, settle(middle - half));
      show(2 * right + axis, settle(middle + half));
    }
  }
  if (points % 2 == 0) return;
  show(points - 1, settle(vector(points - 1)));
  show(points, settle(shape_coordinate<N>(program, points - 1, components)));
}

}  // namespace wisp
