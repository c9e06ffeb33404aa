#pragma once
// Functions of a bank whose model in_the_round() made (Bank::body()): three-dimensional bodies. A flame filmed by one
// camera becomes a body by assuming rotational symmetry.
//
// x points to the right of the camera that filmed the flame, y up, z towards that camera. The inputs of a driven model
// are the wind's x and z components.

#include <cstddef>
#include <cstdint>
#include <span>

#include "wisp/run/bank.hpp"

namespace wisp {

/// Number of values per ring: the centre's x, y, z, the radius, and the rise from centre to rim towards +x and +z.
inline constexpr std::size_t kRingNumbers = 6;

/// Number of values per vertex: position and normal.
inline constexpr std::size_t kVertexNumbers = 6;

/// Writes the vertices of the surface of two or more rings: 3 to 256 (`segments`) per ring, `stride` numbers apart.
/// Returns false, and writes nothing, for an argument out of range or room below rings × segments × stride numbers.
bool ring_mesh(std::span<const float> rings, int segments, std::span<float> numbers,
               std::size_t stride = kVertexNumbers);

/// Returns the number of triangles, three indices each, anticlockwise from outside, including the caps at base and tip.
constexpr int ring_triangle_count(int rings, int segments) { return 2 * rings * segments - 4; }

/// Writes the vertex indices of the triangles. Returns false, and writes nothing, for an argument out of range or
/// unless there is room for exactly 3 × ring_triangle_count() indices.
bool ring_triangles(int rings, int segments, std::span<std::uint32_t> indices);

/// Access to the bodies of a bank. It lives as long as the bank, and moves with it. No function allocates.
class BodyFacet {
 public:
  /// Sets the level camera whose view Bank::outputs() and polylines() return. The unit vector (right_x, right_z) points
  /// to the camera's right: (1, 0) for the camera that filmed the flame, (0, −1) for one a quarter turn further,
  /// anticlockwise as seen from above. save() does not write the view.
  void look(float right_x, float right_z);

  /// Returns the number of rings of a body, from base to tip: half of the polyline's points, rounded up.
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
