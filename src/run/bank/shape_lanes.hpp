#pragma once
// Control points of an outline from its shape components (wisp/model/shape_components.hpp), for a block of instances.
// A coordinate has either symmetric or antisymmetric components, so it takes half of the products of a full basis. For
// a body, the control points are those of the outline seen in a horizontal direction.

#include <cstdint>
#include <span>

#include "run/lanes/lanes.hpp"
#include "run/state/arena.hpp"
#include "wisp/model/model.hpp"

namespace wisp {

/// The shape of an outline, compiled for display.
struct ShapeProgram {
  std::size_t points = 0;  ///< number of control points; 0: the model has no shape
  std::size_t symmetric = 0;
  std::size_t antisymmetric = 0;
  std::size_t across = 0;    ///< number of z components: equal to `antisymmetric` for a body, else 0
  std::span<float> rest;     ///< per coordinate
  std::span<float> lowest;   ///< per coordinate
  std::span<float> highest;  ///< per coordinate
  std::span<float> basis;    ///< points × symmetric, then points × antisymmetric

  bool empty() const { return points == 0; }
  std::size_t components() const { return symmetric + antisymmetric + across; }
};

/// View direction of a body: weights of x and z in the coordinate to the right.
struct LevelView {
  float x = 1;
  float z = 0;
};

/// Takes the program's arrays from the arena and, unless the arena only measures, fills them; none without a shape.
ShapeProgram make_shape_program(const Model& model, Arena& arena);

/// Hashes the program, continuing from the hash `before`; returns `before` if the program is empty.
std::uint64_t hash_of(const ShapeProgram& program, std::uint64_t before);

/// Returns coordinate i, which is symmetric if i < points, else antisymmetric: `rest` plus the weighted sum of the
/// components of its kind, [component][lane], clamped to the coordinate's range.
template <class N>
inline Reals<N> shape_coordinate(const ShapeProgram& program, std::size_t i, const typename N::Real* components,
                                 float rest) {
  const bool symmetric = i < program.points;
  const std::size_t count = symmetric ? program.symmetric : program.antisymmetric;
  const float* basis = program.basis.data() +
                       (symmetric ? i * count : program.points * program.symmetric + (i - program.points) * count);
  auto sum = all<Reals<N>>(rest);
  for (std::size_t k = 0; k < count; ++k, components += N::kLanes) {
    if (basis[k] != 0) sum = sum + all<Reals<N>>(basis[k]) * load<Reals<N>>(components);
  }
  return hold(sum, all<Reals<N>>(program.lowest[i]), all<Reals<N>>(program.highest[i]));
}

/// Calls show(output, values) for every coordinate of every control point; `components` is [component][lane]. Vectors
/// are projected before they are summed: that takes half of the products of summing x and z.
template <class N, class Show>
inline void shape_lanes(const ShapeProgram& program, const typename N::Real* components, const Show& show,
                        LevelView view = {}) {
  const std::size_t points = program.points;
  const typename N::Real* vectors = components + program.symmetric * N::kLanes;
  typename N::Real seen[kMaxShapeComponents * N::kLanes];
  for (std::size_t k = 0; k < program.across * N::kLanes; k += N::kLanes) {
    const auto along = load<Reals<N>>(vectors + k), across = load<Reals<N>>(vectors + program.across * N::kLanes + k);
    store(all<Reals<N>>(view.x) * along + all<Reals<N>>(view.z) * across, seen + k);
  }
  if (program.across > 0) vectors = seen;
  const auto even_at = [&](std::size_t i) { return shape_coordinate<N>(program, i, components, program.rest[i]); };
  const auto vector = [&](std::size_t i) {
    const float along = program.rest[points + i];
    const float rest = program.across > 0 ? view.x * along + view.z * program.rest[2 * points + i] : along;
    return shape_coordinate<N>(program, points + i, vectors, rest);
  };
  for (std::size_t p = 0; p < points / 2; ++p) {
    const std::size_t right = points - 1 - p;
    for (std::size_t axis = 0; axis < 2; ++axis) {
      const auto even = even_at(2 * p + axis);
      const auto odd = vector(2 * p + axis);
      const auto &half = axis == 0 ? even : odd, &middle = axis == 0 ? odd : even;
      show(2 * p + axis, settle(middle - half));
      show(2 * right + axis, settle(middle + half));
    }
  }
  if (points % 2 == 0) return;
  show(points - 1, settle(vector(points - 1)));
  show(points, settle(even_at(points - 1)));
}

}  // namespace wisp
