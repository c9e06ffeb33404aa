#pragma once
// What only a bank of a segment chain has (Bank::chain()): where its instances are in the chain and in the world.

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "wisp/run/bank.hpp"

namespace wisp {

/// Where an instance of a segment chain is, and how it moves.
struct ChainPlace {
  std::uint32_t segment = 0;        ///< index into ChainModel::segments
  std::uint32_t step = 0;           ///< of that segment; at 0 it was joined to the one before
  std::uint32_t mode = 0;           ///< of that segment
  std::array<float, 3> velocity{};  ///< over the last step, metres a second
  std::array<float, 3> spin{};      ///< over the last step, radians a second, world axes
  bool lies = false;                ///< at rest on the ground
  bool landed = false;  ///< touched it in the last call of step() or advance(), in the last 0.35 s of a longer one
};

/// A body at one moment, in the world: metres, seconds, radians, z up.
struct BodyMoment {
  std::array<float, 3> position{};
  std::array<float, 4> orientation{1, 0, 0, 0};  ///< body to world, w first; its length does not matter
  std::array<float, 3> velocity{};
  std::array<float, 3> spin{};  ///< angular velocity, world axes
};

/// Where a body is to be, and when.
struct SteerTarget {
  std::array<float, 3> position{};  ///< in the world, metres
  std::chrono::nanoseconds in{};    ///< from now; above 0, at most 10 000 s
  float near = 0.1f;  ///< metres, 0.001 to 1000: how near is near enough. The nearer, the more the fall is bent to it
};

/// The chain of a bank. It lives as long as the bank, and moves with it; it allocates nothing.
class ChainFacet {
 public:
  /// Where in its chain an instance is; nothing when `id` is not valid.
  std::optional<ChainPlace> place_of(InstanceId id) const;

  /// Sets an instance where a body is, as after a collision or a kick: it goes on with the segment that begins most as
  /// the body moves, the rest fading as at any join. Where the chain is not free of heading, or has no orientation,
  /// that part of the body is not taken over. Looks at every segment once: not for every frame.
  /// Returns false, and does nothing, when `id` is not valid or a number is not finite.
  bool place(InstanceId id, const BodyMoment& body);

  /// Whether the chain knows where its segments lead: one that was learned before chains could be steered does not.
  bool can_steer() const;

  /// Steers an instance: at joins it prefers what leads to the target, weighed against how likely that is, until the
  /// time has come; then it falls on as before. In the last second it is carried to it, at no more than the speed that
  /// falls have at joins: what lies beyond that reach is not reached. A new target takes the place of the one before;
  /// placing and resetting end it. A join costs more meanwhile; docs/explanation/chains.md has figures. Returns false,
  /// and does nothing, when `id` is not valid, a number is out of its range, or can_steer() is false.
  bool steer(InstanceId id, const SteerTarget& target);

  /// Lets an instance fall as it will. Returns false when `id` is not valid.
  bool release(InstanceId id);

  /// The height of level ground, on which instances come to rest until they are placed or reset; nothing: they fall for
  /// ever, as at first. A body whose size the view knows touches with its lowest corner, and no corner sinks in while
  /// it lies down.
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
