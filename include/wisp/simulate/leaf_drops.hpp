#pragma once
// Many falls of one leaf as a recording: what a chain is learned from.

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "wisp/base/result.hpp"
#include "wisp/record/recording.hpp"

namespace wisp {

/// Coefficients of the air's forces, without dimension where nothing else is said. The default is fitted to discs let
/// go vertically and, apart from that, horizontally.
struct LeafAir {
  double rotational_lift = 0.33;     ///< C_R, 0 … 10
  double translational_lift = 2.66;  ///< C_T, 0 … 10
  double drag_broadside = 3.09;      ///< C_D90, 0 … 20
  double drag_edgewise = 0.20;       ///< C_D0, 0 … 20
  double damping_by_speed = 0.57;    ///< μ, of rotation in a stream, 0 … 20
  double damping_by_spin = 5.7;      ///< C_r, of rotation in still air, 0 … 100
  double spin_drag = 0.05;           ///< C_3, of rotation in the leaf's own plane, 0 … 20
};

/// The leaf and the air it falls in. The default is the leaf of the training recordings.
struct Leaf {
  double length = 0.073;        ///< full axis along the midrib (body x), metres, 0.001 … 1
  double width = 0.049;         ///< full axis across it (body y), metres, 0.001 … length
  double areal_density = 0.07;  ///< kg/m², 0.001 … 10; 0.07 is office paper and many a dry leaf
  double air_density = 1.2;     ///< kg/m³, 0.01 … 100
  double gravity = 9.81;        ///< m/s², 0 … 100
  LeafAir air{};
};

/// A wind that was measured: the same everywhere, between its rows along a smooth curve through them, before the first
/// and after the last as there.
struct MeasuredWind {
  std::vector<std::array<double, 3>> rows;  ///< m/s, world's axes; none: there is no such wind
  double rate_hz = 60;                      ///< > 0
  double begins = 0;                        ///< seconds: when the first row is
};

/// Falls of one leaf from random attitudes, velocities and spins. One leaf, since segments of different leaves must not
/// be joined.
struct LeafDropsOptions {
  Leaf leaf{};
  bool gusts = false;         ///< each drop has gusts of its own, of random strength, length and direction, with rests
                              ///< between them
  MeasuredWind track{};       ///< where it has rows, this is the wind of every drop, from where the recording begins
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
/// Errors: an option outside its range, more than 2^31 rows, or a state that is no longer finite (the drop is named).
Result<Recording> simulate_leaf_drops(const LeafDropsOptions& options);

/// Gusts that hit a leaf in many states, each many times over. Falls are chaotic, and only the mean over clones that
/// differ a little tells what the wind did and what chance.
struct LeafPairsOptions {
  LeafDropsOptions drops{};  ///< `drops` is the number of gusts; its own `gusts` and `track` are ignored
  int clones = 32;           ///< of each, 1 … 10000
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
