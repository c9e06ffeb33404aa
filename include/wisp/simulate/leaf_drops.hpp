#pragma once
// Simulation of many falls of one leaf as a recording, from which a chain is learned.

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "wisp/base/result.hpp"
#include "wisp/record/recording.hpp"

namespace wisp {

/// Coefficients of the air's forces, dimensionless unless stated. The default is fitted jointly to paper discs released
/// on edge and paper discs released flat.
struct LeafAir {
  double rotational_lift = 0.33;     ///< C_R, 0 … 10
  double translational_lift = 2.66;  ///< C_T, 0 … 10
  double drag_broadside = 3.09;      ///< C_D90, 0 … 20
  double drag_edgewise = 0.20;       ///< C_D0, 0 … drag_broadside
  double damping_by_speed = 0.57;    ///< μ, 1/m: torque about the axes in the leaf's plane ∝ spin · speed, 0 … 20
  double damping_by_spin = 5.7;      ///< C_r: torque about these axes ∝ spin², 0 … 100
  double spin_drag = 0.05;  ///< C_3, 1/m: torques ∝ spin · speed and ∝ spin² about the leaf's normal, 0 … 20
};

/// Properties of the leaf and the air in which it falls. The default is the leaf of the training recordings.
struct Leaf {
  double length = 0.073;        ///< full axis along the midrib (body x), metres, 0.001 … 1
  double width = 0.049;         ///< full axis across it (body y), metres, 0.001 … length
  double areal_density = 0.07;  ///< kg/m², 0.001 … 10; 0.07 is typical of office paper and dry leaves
  double air_density = 1.2;     ///< kg/m³, 0.01 … 100
  double gravity = 9.81;        ///< m/s², 0 … 100
  LeafAir air{};
};

/// A measured wind: uniform in space, interpolated by cubics between its rows, constant before and after them.
struct MeasuredWind {
  std::vector<std::array<double, 3>> rows;  ///< m/s, world axes, −30 … 30 each; empty: no measured wind
  double rate_hz = 60;                      ///< > 0
  double begins = 0;                        ///< time of the first row, seconds
};

/// Options for falls of one leaf from random attitudes, velocities and spins. A chain learned from the recording joins
/// pieces of its falls, which is valid only for one leaf.
struct LeafDropsOptions {
  Leaf leaf{};
  bool gusts = false;         ///< each drop has its own gusts of random strength, length and direction, with rests
                              ///< between them
  MeasuredWind track{};       ///< if it has rows, the wind of every drop in place of gusts; time 0: first recorded row
  int drops = 200;            ///< episodes, 1 … 100000
  double seconds = 20;        ///< recorded duration of each drop, 0.1 … 3600
  double settle_seconds = 2;  ///< simulated before the recording, 0 … 60: until the initial state is forgotten
  double rate_hz = 60;        ///< rows per second, 1 … 10000
  std::uint64_t seed = 1;
  int threads = 0;                               ///< 0 … 256; 0: one per core. The result does not depend on it
  std::function<void(double)> on_progress = {};  ///< called on the calling thread with the share of falls done
};

/// Simulates all falls.
/// Returns one episode per drop: outputs `pos.x pos.y pos.z` [m], relative to the episode's first row, and `q.w … q.z`,
/// unit quaternions, leaf to world, whose sign never jumps; inputs `wind.x wind.y wind.z` [m/s] at the leaf.
/// Errors: an option outside its range, more than 2^31 rows, or a state that is no longer finite (the drop is named).
Result<Recording> simulate_leaf_drops(const LeafDropsOptions& options);

/// Options for gusts that hit a leaf in many states. Each gust is repeated with clones, leaves whose states differ
/// slightly: falls are chaotic, and only the mean over clones separates the effect of the wind from chance.
struct LeafPairsOptions {
  LeafDropsOptions drops{};  ///< `drops` is the number of gusts; its own `gusts` and `track` are ignored
  int clones = 32;           ///< clones per gust, 1 … 10000
};

/// Falls with one gust each, and without: episode k starts alike in both. The clones of a gust are consecutive.
struct LeafPairs {
  Recording windy;
  Recording calm;
};

/// Simulates the pairs. Both recordings have the same attributes `pair` (an identifier) and `clones` (the number of
/// consecutive episodes per gust). Errors: those of simulate_leaf_drops().
Result<LeafPairs> simulate_leaf_pairs(const LeafPairsOptions& options);

}  // namespace wisp
