#pragma once
// Arguments of a step of any kind of dynamics: random keys and counters, clamp flags, number of lanes in use.

#include "run/lanes/random_lanes.hpp"

namespace wisp {

template <class N>
struct Moment {
  const RandomKeys* keys = nullptr;
  LaneCounters counters{};           ///< counters of the block
  std::uint32_t* clamped = nullptr;  ///< per lane: set to nonzero if an output was clamped, else to 0
  int used = N::kLanes;              ///< number of lanes in use in this block and all later ones

  /// Returns the number of lanes in use in the block: code that works lane by lane skips the others.
  int lanes() const { return used < N::kLanes ? used : N::kLanes; }

  /// Returns the moment for the block that lies `blocks` after this one.
  Moment later(int blocks) const {
    Moment of = *this;
    of.counters.stream += blocks * N::kLanes;
    of.counters.born += blocks * N::kLanes;
    of.clamped += blocks * N::kLanes;
    of.used -= blocks * N::kLanes;
    return of;
  }
};

}  // namespace wisp
