#pragma once
// Wind over a leaf's fall, as a function of place and time, with how it changes along the leaf's way.

#include <array>
#include <cstdint>
#include <vector>

#include "wisp/base/result.hpp"

namespace wisp {

/// What a leaf feels of the wind, in the world's axes.
struct WindSample {
  std::array<double, 3> velocity{};  ///< m/s
  std::array<double, 3> change{};    ///< m/s², for one who goes along with the leaf
};

/// What the wind does.
enum class LeafWindKind {
  kCalm,        ///< nothing
  kConstant,    ///< one speed, one direction
  kGusts,       ///< gusts of random strength, length and direction that travel, with rests between them
  kTurbulence,  ///< a steady wind and eddies of one size that it carries along
};

/// The wind. Directions are in the horizontal plane, counted from x towards y.
struct LeafWindOptions {
  LeafWindKind kind = LeafWindKind::kCalm;
  double speed = 1;            ///< m/s, 0 … 30: of the steady wind, or a typical gust's
  double direction = 0;        ///< degrees: where the steady wind blows to
  double spread = 180;         ///< degrees, 0 … 180: gusts blow to `direction` ± this, evenly
  double gust_seconds = 0.3;   ///< a typical gust's length, 0.02 … 60; each is 0.6 to 1.8 times as long
  double rest_seconds = 1.5;   ///< typical calm between gusts, 0 … 60
  double edge_seconds = 0.06;  ///< in which a gust rises and falls, 0.001 … 10; what begins at once has no derivative
  double travel_speed = 8;     ///< m/s, 0.1 … 1000: how fast a gust's front comes along
  double turbulence = 0.3;     ///< m/s, 0 … 30: standard deviation of each component of the eddies' velocity
  double eddy_metres = 0.5;    ///< length of a typical eddy, 0.01 … 1000
  std::uint64_t seed = 1;
};

/// One gust of a train: its front passes the origin at `start`.
struct Gust {
  double start = 0;                  ///< seconds
  double seconds = 0;                ///< from the start to the end, edges included
  double edge = 0;                   ///< seconds of each edge, at most half of the length
  std::array<double, 3> velocity{};  ///< at its height, m/s
  std::array<double, 3> slowness{};  ///< s/m: along its way, 1 / travel speed
};

/// A wind that was measured: the same everywhere, between its rows along a smooth curve through them, before the first
/// and after the last as there.
struct MeasuredWind {
  std::vector<std::array<double, 3>> rows;  ///< m/s, world's axes; none: there is no such wind
  double rate_hz = 60;                      ///< > 0
  double begins = 0;                        ///< seconds: when the first row is
};

/// The wind at any place and time.
class LeafWind {
 public:
  /// Nothing blows.
  LeafWind() = default;

  /// Wind of the given kind, gusts for `seconds`.
  /// Errors: an option outside its range.
  static Result<LeafWind> create(const LeafWindOptions& options, double seconds);

  /// A train of given gusts.
  ///
  /// Precondition: seconds > 0 and 0 < edge <= seconds / 2 for each.
  static LeafWind of_gusts(std::vector<Gust> gusts);

  /// What was measured.
  ///
  /// Precondition: rate_hz > 0, all rows finite.
  static LeafWind of_track(MeasuredWind track);

  /// The wind where a leaf is, and how fast it changes for a leaf that moves so (world's axes).
  WindSample at(const std::array<double, 3>& place, const std::array<double, 3>& moving, double seconds) const;

  /// Nothing blows anywhere, ever.
  bool calm() const { return !steady_ && gusts_.empty() && eddies_.empty() && track_.rows.empty(); }

  /// The greatest speed of the steady wind, the gusts or the rows that were measured, m/s; eddies apart.
  double fastest() const;

  const std::vector<Gust>& gusts() const { return gusts_; }

 private:
  struct Eddy {
    std::array<double, 3> amplitude;  // m/s, at right angles to the wave, so that no air comes from nowhere
    std::array<double, 3> wave;       // rad/m
    double pulsation;                 // rad/s
    double phase;
  };
  void add_gusts(const LeafWindOptions& options, double seconds);
  void add_eddies(const LeafWindOptions& options);

  bool steady_ = false;
  std::array<double, 3> mean_{};
  std::vector<Gust> gusts_;  // by their start
  std::vector<Eddy> eddies_;
  MeasuredWind track_;
};

}  // namespace wisp
