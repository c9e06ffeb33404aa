#pragma once
// A segment chain, as a value: pieces of motion between critical events, classified into modes; a Markov chain of order
// one or two over the modes; and how one piece joins the next.
//
// Segments are stored as 16-bit integers with one scale for all positions. Each has a frame of its own: the segment
// begins at the origin and, in a heading-free chain, its heading is arbitrary.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "wisp/base/result.hpp"

namespace wisp {

/// Channels of a chain's rows.
enum class ChainMotion : std::uint8_t {
  kPosition,  ///< x, y, z
  kPose,      ///< x, y, z, then the quaternion w, x, y, z (unit, body to world)
};

/// Returns the number of channels: 3 or 7.
int channel_count(ChainMotion motion);

/// Returns the size of row_scale, and of rate_scale: 1 or 2.
int scale_count(ChainMotion motion);

/// Returns the number of rates stored for each end of a segment: 3 of velocity and, for poses, 3 of angular velocity.
int rate_count(ChainMotion motion);

inline constexpr std::size_t kMaxSegments = 65535;
inline constexpr std::size_t kMaxModes = 64;
inline constexpr std::size_t kMaxSegmentSteps = 65535;

/// All segments, grouped by mode, with modes in ascending order.
struct ChainSegments {
  std::vector<std::uint16_t> mode;    ///< mode per segment
  std::vector<std::uint16_t> steps;   ///< per segment, steps of the model's clock from its event to the next; ≥ 1
  std::vector<std::int16_t> rows;     ///< per segment (steps + 1) rows of all channels; its successor joins at the last
  std::vector<double> row_scale;      ///< scale of positions and, for poses, of quaternions: value = scale · row; > 0
  std::vector<std::int16_t> rates;    ///< per segment the rates at its start, then at its end, per second
  std::vector<double> rate_scale;     ///< scale of velocities and, for poses, of angular velocities; > 0
  std::vector<std::uint16_t> follow;  ///< segments × modes × breadth: per segment and mode, the segments of that mode
                                      ///< that join best, best first; empty if breadth is 0
  int breadth = 0;                    ///< successors per segment and mode, 0 to 256; 0: any segment of the mode
  std::vector<std::int16_t> height;   ///< recorded initial z per segment, for motion between a floor and a ceiling:
                                      ///< joins lead z back to this height. Empty: z continues from its current value
  double height_scale = 0;            ///< metres = scale · height; > 0 if there are heights

  std::size_t size() const { return mode.size(); }
};

/// Effect of wind on the velocity of a chain's body: v_windy − v_calm = F(wind, attitude), an autoregression with
/// exogenous inputs. Regressors are the velocity change one step before, the wind, and the normal wind n (n·u), where n
/// is the body's normal and u the wind minus that velocity change. If the coefficients of change and wind sum to 1, a
/// steady wind carries the body along at any attitude, as Galilean invariance demands. The response is isotropic in the
/// horizontal plane: one set of coefficients holds for x and y; z has its own.
struct GustResponse {
  struct Axis {
    double change = 0;  ///< coefficient of the velocity change one step before
    double wind = 0;
    double press = 0;  ///< coefficient of the normal wind; 0 for a chain without orientation
  };
  Axis ground;    ///< coefficients of x and of y
  Axis vertical;  ///< coefficients of z
};

/// Predicted displacement of a walk given its present segment; steering weights successors by it. A time τ after the
/// end of segment s the body's expected position, relative to that end, is drift · τ + lead(s) · τ / (τ + memory),
/// where lead(s) is rotated with s. The variance of the position grows by `spread` per second.
struct ChainDrift {
  std::vector<std::int16_t> lead;  ///< segments × 3, in the frame of each segment
  double lead_scale = 0;           ///< metres = scale · lead; > 0
  std::array<double, 3> drift{};   ///< mean velocity, metres per second; 0 horizontally if heading is free
  double spread_ground = 0;        ///< variance growth along each horizontal direction, m² per second; > 0
  double spread_height = 0;        ///< variance growth along z, m² per second; > 0
  double memory_seconds = 0;       ///< time after which half of the lead is reached; ≥ 0
};

struct ChainModel {
  ChainMotion motion = ChainMotion::kPose;
  bool heading_free = true;  ///< segments are rotated about z to join; otherwise only translated
  int modes = 0;
  ChainSegments segments;
  std::vector<double> initial;        ///< per mode, probability that a recording begins in it; sums to 1
  int history = 1;                    ///< number of past modes that determine the next one, 1 or 2
  std::vector<double> probabilities;  ///< transition probabilities, rows of `modes` numbers that sum to 1: row b after
                                      ///< mode b; for history 2, row modes · (1 + a) + b after modes a and then b
  int blend_steps = 30;  ///< largest number of steps to blend on either side of a join, where both segments meet at
                         ///< their mean attitude and rates; 0 … 4096, 0: no blending
  std::optional<GustResponse> gust;  ///< if set, the model's inputs are the wind's x, y and z, metres per second
  std::optional<ChainDrift> drift;   ///< none: the chain cannot be steered
  /// Returns transition probabilities given the last mode alone, modes × modes, row-major.
  std::vector<double> transitions() const;
};

/// Returns the index of each segment's first row, and one past the last row; a row has channel_count() numbers.
std::vector<std::uint32_t> segment_rows(const ChainSegments& segments);

/// Checks shapes, ranges of indices, order of the modes, sums of probabilities, scales and finiteness. Errors name the
/// field and what was expected.
Result<void> check(const ChainModel& model);

}  // namespace wisp
