#pragma once
// Wind as a function of place and time, with its rate of change along a leaf's path.

#include <array>
#include <cstdint>
#include <vector>

#include "wisp/simulate/leaf_drops.hpp"

namespace wisp {

/// The wind at a leaf, in the world's axes.
struct WindSample {
  std::array<double, 3> velocity{};  ///< m/s
  std::array<double, 3> change{};    ///< m/s², along the leaf's path
};

/// One gust of a train: its front passes the origin at `start`.
struct Gust {
  double start = 0;                  ///< seconds
  double seconds = 0;                ///< from the start to the end, edges included
  double edge = 0;                   ///< seconds of each edge, at most half of the length
  std::array<double, 3> velocity{};  ///< at its height, m/s
  std::array<double, 3> slowness{};  ///< s/m: along its way, 1 / travel speed
};

/// The wind at any place and time.
class LeafWind {
 public:
  /// No wind.
  LeafWind() = default;

  static constexpr double kRestSeconds = 1.5;  ///< typical calm between gusts

  /// A train of random gusts for `seconds`, which blow to any direction of the horizontal plane.
  static LeafWind gusty(std::uint64_t seed, double seconds);

  /// A train of given gusts.
  ///
  /// Precondition: seconds > 0 and 0 < edge <= seconds / 2 for each.
  static LeafWind of_gusts(std::vector<Gust> gusts);

  /// A measured wind.
  ///
  /// Precondition: rate_hz > 0, all rows finite.
  static LeafWind of_track(MeasuredWind track);

  /// Returns the wind at a place and its rate of change for a leaf of that velocity (world's axes).
  WindSample at(const std::array<double, 3>& place, const std::array<double, 3>& moving, double seconds) const;

  /// Whether there is no wind at any place and time.
  bool calm() const { return gusts_.empty() && track_.rows.empty(); }

  /// The greatest speed of gusts and measured rows, m/s.
  double fastest() const;

  const std::vector<Gust>& gusts() const { return gusts_; }

 private:
  std::vector<Gust> gusts_;  // by their start
  MeasuredWind track_;
};

}  // namespace wisp
