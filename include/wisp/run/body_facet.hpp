#pragma once
// What only a bank of a model in the round has (Bank::body(), in_the_round()): bodies. A flame that one camera filmed
// is one by the assumption that it is the same from all sides.
//
// x is to the right of the camera that filmed it, y up, z towards that camera. The inputs of its wind are the wind's x
// and z: it blows towards them.

#include <cstddef>
#include <span>

#include "wisp/run/bank.hpp"

namespace wisp {

/// Numbers of a ring: the middle's x, y and z, the radius, and by how much the ring rises from its middle to its rim
/// towards +x and towards +z.
inline constexpr std::size_t kRingNumbers = 6;

/// The bodies of a bank. It lives as long as the bank, and moves with it. Nothing here allocates.
class BodyFacet {
 public:
  /// Outputs and polylines are the outline as it is seen, level, by a camera whose right is (x, z), a vector of length
  /// 1: (1, 0) is the camera that filmed it, (0, −1) one that went a quarter round it, anticlockwise from above. It is
  /// no part of what save() writes.
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
