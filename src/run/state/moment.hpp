#pragma once
// What a step needs to know of the moment, beside the state: the same for every kind of dynamics.

#include "run/lanes/random_lanes.hpp"

namespace wisp {

template <class N>
struct Moment {
  const RandomKeys* keys = nullptr;
  LaneCounters counters{};           ///< of the block
  std::uint32_t* clamped = nullptr;  ///< per lane: not 0 afterwards where an output was clamped
  int used = N::kLanes;              ///< lanes in use from the block's first on, those of later blocks too

  /// Lanes of the block in use: what moves lanes one by one leaves out the rest.
  int lanes() const { return used < N::kLanes ? used : N::kLanes; }

  /// Of a block that comes later, where this is of the first.
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
