#pragma once
// A segment chain compiled for stepping: probabilities as thresholds of 32-bit words, scales in single precision.

#include <array>
#include <cstdint>
#include <span>

#include "run/state/arena.hpp"
#include "wisp/base/result.hpp"
#include "wisp/model/model.hpp"

namespace wisp {

/// A response to gusts: one lag after the other of the change of velocity, the wind, and its press on the body.
struct GustProgram {
  int order = 0;  ///< 0: none
  // Per lag the coefficients of the change, of the wind, and of a quarter of its press.
  std::array<std::array<float, 3>, kMaxGustOrder> ground{};
  std::array<std::array<float, 3>, kMaxGustOrder> vertical{};
};

/// The curve over so many steps that goes from one number and slope to others: two parabolas. What their second
/// differences are, of what is lacking beyond the first slope, and of the change of slope.
struct ChainSpread {
  std::array<float, 2> way{};     ///< of the first half, and of the latter
  std::array<float, 2> change{};  ///< likewise
  float slope = 0;                ///< of a straight line from the first step to the last
};

/// Steps of the first parabola.
inline std::uint32_t first_half(std::uint32_t steps) { return (steps + 1) / 2; }

/// Rows are read so many numbers at once, and there are as many behind the last one.
inline constexpr std::size_t kRowReach = 8;

struct ChainProgram {
  int channels = 0;  ///< 3 or 7
  int rate_count = 0;
  int modes = 0;
  int breadth = 0;
  int history = 1;  ///< modes that the next one depends on
  bool heading_free = true;
  float position_scale = 1;
  float orientation_scale = 1;
  float velocity_scale = 1;
  float spin_scale = 1;
  float step_seconds = 0;
  std::uint32_t blend_steps = 0;  ///< most that a join fades over, on either side; 0: not at all
  float height_scale = 0;         ///< of the heights at which segments begin
  float max_return = 0;           ///< metres a step: how fast a join leads back to them at most
  float speed_unit = 1;  ///< root-mean-square of the speeds at joins: what differences of speed are measured in
  float spin_unit = 1;   ///< the same of angular speeds
  GustProgram gust{};
  std::span<std::int16_t> rows;
  std::span<std::int16_t> rates;
  std::span<float> changes;            ///< of poses: per segment, at its start and its end, of the stored quaternion in
                                       ///< half a step
  std::span<ChainSpread> spread;       ///< by steps, up to twice those of a blend
  std::span<std::uint32_t> first_row;  ///< per segment, and one past the last
  std::span<std::uint16_t> mode;       ///< per segment
  std::span<std::uint16_t> follow;
  std::span<std::int16_t> height;          ///< per segment; empty: height is free
  std::span<std::uint32_t> first_of_mode;  ///< per mode its first segment, and one past the last
  std::span<std::uint32_t> threshold;      ///< states × modes: the first mode whose threshold a word is below is drawn
  std::span<std::int16_t> lead;            ///< segments × 3; empty: it can't be steered
  float lead_scale = 0;
  std::array<float, 3> drift{};  ///< metres a second
  float spread_ground = 0;       ///< m² a second
  float spread_height = 0;
  float mean_steps = 0;   ///< of the segments
  float memory = 0;       ///< seconds
  float half_width = 0;   ///< of the body, along its first axis, metres; 0: a point
  float half_length = 0;  ///< and along its second

  std::uint32_t segments() const { return static_cast<std::uint32_t>(mode.size()); }
  std::uint32_t states() const {
    return static_cast<std::uint32_t>(threshold.size()) / static_cast<std::uint32_t>(modes);
  }
  std::uint32_t state_after(std::uint32_t state, std::uint32_t drawn) const {
    const auto count = static_cast<std::uint32_t>(modes);
    if (history < 2 || state == 0) return 1 + drawn;
    return 1 + count * (1 + (state - 1) % count) + drawn;
  }
  std::uint32_t steps(std::uint32_t segment) const { return first_row[segment + 1] - first_row[segment] - 1; }
};

/// State 0 is the beginning; state k + 1 is row k of the model's probabilities.
/// `wind_unit` is what the wind of the regressors is measured in.
ChainProgram make_chain_program(const ChainModel& chain, double rate_hz, double wind_unit, Arena& arena);

/// Gives the program the size of the body that it moves, where the view knows it.
void take_size(const View& view, ChainProgram& program);

/// A hash of the program, over a hash of what came before.
std::uint64_t hash_of(const ChainProgram& program, std::uint64_t before);

/// Errors: scales so small or large that single precision can't hold what they make.
Result<void> check_chain_program(const ChainModel& chain);

}  // namespace wisp
