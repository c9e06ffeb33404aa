#pragma once
// Wind as a function of position and time, with its rate of change along a leaf's path.

#include <array>
#include <cstdint>
#include <vector>

#include "wisp/simulate/leaf_drops.hpp"

namespace wisp {

/// The wind at a leaf, in world axes.
struct WindSample {
  std::array<double, 3> velocity{};  ///< m/s
  std::array<double, 3> change{};    ///< m/s², along the leaf's path
};

/// One gust of a train: its front passes the origin at `start`.
struct Gust {
  double start = 0;                  ///< seconds
  double seconds = 0;                ///< duration from start to end, edges included
  double edge = 0;                   ///< duration of each edge, at most half of the length
  std::array<double, 3> velocity{};  ///< velocity at the maximum, m/s
  std::array<double, 3> slowness{};  ///< s/m: direction of travel / travel speed
};

/// The wind at any position and time.
class LeafWind {
 public:
  /// Creates a calm.
  LeafWind() = default;

  static constexpr double kRestSeconds = 1.5;  ///< typical calm between gusts

  /// Creates a train of random gusts for `seconds`, in random horizontal directions.
  static LeafWind gusty(std::uint64_t seed, double seconds);

  /// Creates a train of given gusts.
  ///
  /// Precondition: seconds > 0 and 0 < edge <= seconds / 2 for each.
  static LeafWind of_gusts(std::vector<Gust> gusts);

  /// Creates a measured wind.
  ///
  /// Precondition: rate_hz > 0, all rows finite.
  static LeafWind of_track(MeasuredWind track);

  /// Returns the wind at a position and its rate of change for a leaf of that velocity (world axes).
  WindSample at(const std::array<double, 3>& place, const std::array<double, 3>& moving, double seconds) const;

  /// Returns whether there is no wind at any position and time.
  bool calm() const { return gusts_.empty() && track_.rows.empty(); }

  /// Returns the greatest speed of gusts and measured rows, m/s.
  double fastest() const;

  const std::vector<Gust>& gusts() const { return gusts_; }

 private:
  std::vector<Gust> gusts_;  // sorted by start
  MeasuredWind track_;
};

}  // namespace wisp
