#pragma once
// Many falls of one leaf as a recording: what a chain is learned from.

#include <cstdint>
#include <functional>

#include "wisp/base/result.hpp"
#include "wisp/record/recording.hpp"
#include "wisp/simulate/leaf_flight.hpp"

namespace wisp {

/// Falls of one leaf from random attitudes, velocities and spins. One leaf, since segments of different leaves must not
/// be joined.
struct LeafDropsOptions {
  Leaf leaf{};
  LeafWindOptions wind{};  ///< each drop has gusts and eddies of its own
  MeasuredWind track{};    ///< where it has rows, this is the wind of every drop, from where the recording begins
  LeafStepping stepping{};
  int drops = 200;            ///< episodes, 1 … 100000
  double seconds = 20;        ///< recorded of each, 0.1 … 3600
  double settle_seconds = 2;  ///< before that, 0 … 60: until the fall has forgotten how it began
  double rate_hz = 60;        ///< rows a second, 1 … 10000
  std::uint64_t seed = 1;
  int threads = 0;                               ///< 0 … 256; 0: one a core. The result does not depend on it
  std::function<void(double)> on_progress = {};  ///< called now and then with the share that is done
};

/// Falls them all.
/// Returns one episode a drop: outputs `pos.x pos.y pos.z` [m], counted from the episode's first row, and `q.w … q.z`,
/// unit quaternions, leaf to world, whose sign never jumps; inputs `wind.x wind.y wind.z` [m/s] where the leaf is.
/// Errors: an option outside its range, more than 2^31 rows, or an integrator that gives up (the drop is named).
Result<Recording> simulate_leaf_drops(const LeafDropsOptions& options);

/// Gusts that hit a leaf in many states, each many times over. Falls are chaotic, and only the mean over clones that
/// differ a little tells what the wind did and what chance.
struct LeafPairsOptions {
  LeafDropsOptions
      drops{};      ///< `drops` is the number of gusts; `wind` says how they blow, its kind and `track` are ignored
  int clones = 32;  ///< of each, 1 … 10000
  double difference = 0.05;   ///< between clones when the recording begins, 0 … 1: radians, m/s, tenths of a rad/s
  double lead_seconds = 0.5;  ///< from there to the gust's onset, give or take a fifth, 0 … 60
};

/// The same falls with a gust each, and without. Episode k of both began alike; clones of one gust follow each other.
struct LeafPairs {
  Recording windy;
  Recording calm;
};

/// Falls them. The recordings share the value of their attribute `pair`; `clones` says how many episodes in a row
/// belong to one gust.
/// Errors: as simulate_leaf_drops().
Result<LeafPairs> simulate_leaf_pairs(const LeafPairsOptions& options);

}  // namespace wisp
