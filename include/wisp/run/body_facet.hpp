#pragma once
// Three-dimensional bodies, which a bank of a model in the round plays (in_the_round(), Bank::body()). A flame that one
// camera filmed becomes a body by assuming that it looks alike from all sides.
//
// x is to the right of the camera that filmed it, y up, z towards that camera. The inputs of its wind are the wind's x
// and z components.

#include <cstddef>
#include <cstdint>
#include <span>

#include "wisp/run/bank.hpp"

namespace wisp {

/// Numbers of a ring: the middle's x, y and z, the radius, and by how much the ring rises from its middle to its rim
/// towards +x and towards +z.
inline constexpr std::size_t kRingNumbers = 6;

/// Numbers of a vertex: its place and its normal.
inline constexpr std::size_t kVertexNumbers = 6;

/// Writes the surface of a body from two rings or more: 3 to 256 vertices a ring, `stride` numbers from one to the
/// next. Returns false, and writes nothing, where it is not so, or there is no room for rings × segments × stride.
bool ring_mesh(std::span<const float> rings, int segments, std::span<float> numbers,
               std::size_t stride = kVertexNumbers);

/// Its triangles, three indices each, anticlockwise from outside, the base's and the tip's caps included.
constexpr int ring_triangle_count(int rings, int segments) { return 2 * rings * segments - 4; }

/// Returns false likewise, or where there are not exactly 3 × ring_triangle_count() indices.
bool ring_triangles(int rings, int segments, std::span<std::uint32_t> indices);

/// The bodies of a bank. It lives as long as the bank, and moves with it. Nothing here allocates.
class BodyFacet {
 public:
  /// Sets the level camera whose view Bank::outputs() and polylines() return. (right_x, right_z), of length 1, points
  /// to the camera's right: (1, 0) for the camera that filmed the flame, (0, −1) for one a quarter turn further,
  /// anticlockwise from above. save() does not write it.
  void look(float right_x, float right_z);

  /// Rings of a body, from the base to the tip: half of the polyline's points.
  int rings() const;

  /// Reads all rings: slots() × rings() × kRingNumbers.
  void read_rings(std::span<float> values) const;

  /// Reads the rings of one instance: rings() × kRingNumbers. Returns false when `id` is not valid.
  bool read_rings(InstanceId id, std::span<float> values) const;

 private:
  friend struct Bank::State;  // makes it
  explicit BodyFacet(Bank::State& state) : state_(&state) {}
  BodyFacet(const BodyFacet&) = delete;
  BodyFacet& operator=(const BodyFacet&) = delete;

  Bank::State* state_;
};

}  // namespace wisp
