#pragma once
// A segment chain, as a value: pieces of motion between critical events, sorted into modes; a Markov chain of order one
// or two over the modes; and how one piece joins the next.
//
// Segments are whole numbers of 16 bits and one scale for all positions, each in a frame of its own: its
// position begins at the origin and, in a chain that is free of heading, what "ahead" means is the segment's own
// business.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "wisp/base/result.hpp"

namespace wisp {

/// What the channels of a chain are, and so how a segment is placed where the one before it ended.
enum class ChainMotion : std::uint8_t {
  kPosition,  ///< x, y, z: placed by moving it
  kPose,      ///< x, y, z, then the quaternion w, x, y, z (unit, body to world)
};

/// Channels of a motion: 3 or 7.
int channel_count(ChainMotion motion);

/// Scales of its rows, and of its rates: 1 or 2.
int scale_count(ChainMotion motion);

/// Numbers of the rates at a segment's end: velocity x, y, z and, for poses, angular velocity x, y, z. 3 or 6.
int rate_count(ChainMotion motion);

inline constexpr std::size_t kMaxSegments = 65535;
inline constexpr std::size_t kMaxModes = 64;
inline constexpr std::size_t kMaxSegmentSteps = 65535;

/// All segments, those of one mode together and modes in ascending order.
struct ChainSegments {
  std::vector<std::uint16_t> mode;   ///< per segment
  std::vector<std::uint16_t> steps;  ///< per segment, ≥ 1: steps of the model's clock from its event to the next one
  std::vector<std::int16_t> rows;    ///< per segment (steps + 1) rows of all channels; the last is where the next joins
  std::vector<double> row_scale;     ///< of positions and, for poses, of quaternions: value = scale · row; > 0
  std::vector<std::int16_t> rates;   ///< per segment the rates at its start, then at its end, a second
  std::vector<double> rate_scale;    ///< of velocities and, for poses, of angular velocities; > 0
  std::vector<std::uint16_t> follow;  ///< segments × modes × breadth: the segments of that mode that join it best, best
                                      ///< first; empty where breadth is 0
  int breadth = 0;                   ///< 0: any segment of the mode follows
  std::vector<std::int16_t> height;  ///< per segment z where it begins, of motion that stays between a floor and a
                                     ///< ceiling: joins lead back to it. Empty: z goes on from where it is
  double height_scale = 0;           ///< metres = scale · height; > 0 where there are heights

  std::size_t size() const { return mode.size(); }
};

/// How wind changes the velocity of what the chain moves: v_windy − v_calm = F(wind, attitude), an autoregression with
/// exogenous inputs. Lags 1 … n of the change itself, lags 0 … n−1 of the wind and of its press: the part that is
/// square to the body, n (n·u) for a normal n, of the wind u that the body feels beyond the change that it has. Where
/// the lags of change and wind sum to 1, a steady wind carries the body along with it, whatever its attitude: a change
/// of frame. All directions over ground are alike, so that one set of coefficients stands for x and y and the response
/// turns with the heading; z has its own.
struct GustResponse {
  struct Axis {
    std::vector<double> change;
    std::vector<double> wind;
    std::vector<double> press;  ///< zeros for a chain without orientation
  };
  Axis ground;    ///< of x and of y
  Axis vertical;  ///< of z

  int order() const { return static_cast<int>(ground.change.size()); }
};

inline constexpr int kMaxGustOrder = 4;

/// Where a walk will be, as far as its present segment tells: what steering weighs the next segment by. A time τ after
/// the end of segment s the body is, on average, `drift` · τ plus τ / (τ + memory) of s's lead (turned as s is) from
/// there, with variances that grow by `spread` a second.
struct ChainDrift {
  std::vector<std::int16_t> lead;  ///< segments × 3, in the frame of each
  double lead_scale = 0;           ///< metres = scale · lead; > 0
  std::array<double, 3> drift{};   ///< mean velocity, metres a second; 0 over ground where heading is free
  double spread_ground = 0;        ///< along each direction over ground, m² a second; > 0
  double spread_height = 0;        ///< > 0
  double memory_seconds = 0;       ///< ≥ 0
};

struct ChainModel {
  ChainMotion motion = ChainMotion::kPose;
  bool heading_free = true;  ///< segments are turned about z to join; otherwise only moved
  int modes = 0;
  ChainSegments segments;
  std::vector<double> initial;        ///< per mode: how a recording begins; sums to 1
  int history = 1;                    ///< modes that the next one depends on, 1 or 2
  std::vector<double> probabilities;  ///< rows of one number a mode, each of which sums to 1: what follows mode b is
                                      ///< row b and, where the history is 2, what follows a and then b is row
                                      ///< modes · (1 + a) + b
  int blend_steps = 30;  ///< most steps over which a join is spread, on either side of it: neighbours meet half-way in
                         ///< attitude and rates; 0 … 4096, 0 leaves joins as they are
  std::optional<GustResponse>
      gust;  ///< where there is one, the model's inputs are the wind's x, y and z, metres a second
  std::optional<ChainDrift> drift;  ///< none: it can't be steered
  /// Probabilities after exactly one mode, modes × modes, row-major.
  std::vector<double> transitions() const;
};

/// Index of the first row of each segment, and one past the last: rows, not numbers.
std::vector<std::uint32_t> segment_rows(const ChainSegments& segments);

/// Checks shapes, ranges of indices, order of the modes, that probabilities sum to 1, scales and finiteness. Errors say
/// which of them and what was expected.
Result<void> check(const ChainModel& model);

}  // namespace wisp
