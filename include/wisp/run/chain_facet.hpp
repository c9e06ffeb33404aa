#pragma once
// Functions of a segment chain's bank (Bank::chain()): an instance's state in the chain, placement, steering, ground.

#include <array>
#include <chrono>
#include <cstdint>
#include <optional>

#include "wisp/run/bank.hpp"

namespace wisp {

/// Position of an instance in its segment chain, and its motion.
struct ChainPlace {
  std::uint32_t segment = 0;        ///< index into ChainModel::segments
  std::uint32_t step = 0;           ///< step within that segment; 0: the join with the previous segment
  std::uint32_t mode = 0;           ///< mode of that segment
  std::array<float, 3> velocity{};  ///< mean over the last step, metres per second
  std::array<float, 3> spin{};      ///< mean angular velocity over the last step, radians per second, world axes
  bool lies = false;                ///< at rest on the ground
  bool landed = false;              ///< touched ground in the last call of step() or advance(), and does not lie yet
};

/// A body at one moment, in the world: metres, seconds, radians, z up.
struct BodyMoment {
  std::array<float, 3> position{};
  std::array<float, 4> orientation{1, 0, 0, 0};  ///< body to world, w first, of norm 0.001 to 1e15
  std::array<float, 3> velocity{};
  std::array<float, 3> spin{};  ///< angular velocity, world axes
};

/// Position that a body shall reach, and when.
struct SteerTarget {
  std::array<float, 3> position{};  ///< in the world, metres
  std::chrono::nanoseconds in{};    ///< time from now; above 0, at most 10 000 s
  float near = 0.1f;                ///< tolerance, metres, 0.001 to 1000. A smaller tolerance alters the fall more
};

/// Access to the chain of a bank. It lives as long as the bank, and moves with it. No function allocates.
class ChainFacet {
 public:
  /// Returns the position of an instance in its chain; nothing when `id` is not valid.
  std::optional<ChainPlace> place_of(InstanceId id) const;

  /// Sets the state of an instance, as after a collision or a kick: it continues with the segment whose initial motion
  /// is nearest to the body's; the difference decays as at any join. A chain that is not heading-free searches without
  /// the orientation; one of positions ignores orientation and spin. Compares all segments: too expensive for every
  /// frame. Returns false, and does nothing, when `id` is not valid, a position or rate is not within ±10⁶, or the
  /// orientation's norm is out of range.
  bool place(InstanceId id, const BodyMoment& body);

  /// Returns whether the model has a ChainDrift, which steering needs.
  bool can_steer() const;

  /// Steers an instance: until the given time, joins prefer segments that lead to the target, weighed against their
  /// probability; afterwards it falls as before. In the last second the instance is also moved to the target, along
  /// each axis by no more than the segments' root-mean-square speed at joins: a target beyond that reach is missed. A
  /// new target replaces the previous one; place() and reset() cancel it. Joins of steered instances cost more. Returns
  /// false, and does nothing, when `id` is not valid, a number is out of its range, or can_steer() is false.
  bool steer(InstanceId id, const SteerTarget& target);

  /// Cancels steering. Returns false when `id` is not valid.
  bool release(InstanceId id);

  /// Sets the height of level ground, on which instances come to rest until they are placed or reset. Without a height
  /// (the default), or with one not within ±10⁶ m, there is no ground. If the model's view has the body's size, its
  /// lowest corner touches first, and no corner sinks in while it settles.
  void set_ground(std::optional<float> height);
  std::optional<float> ground() const;

 private:
  friend struct Bank::State;  // makes it
  explicit ChainFacet(Bank::State& state) : state_(&state) {}
  ChainFacet(const ChainFacet&) = delete;
  ChainFacet& operator=(const ChainFacet&) = delete;

  Bank::State* state_;
};

}  // namespace wisp
