#pragma once
// A segment chain compiled for stepping: probabilities as thresholds of 32-bit words, scales in single precision.

#include <array>
#include <cstdint>
#include <span>

#include "run/state/arena.hpp"
#include "wisp/base/result.hpp"
#include "wisp/model/model.hpp"

namespace wisp {

/// A response to gusts: coefficients of the velocity change, the wind, and a quarter of the normal wind.
struct GustProgram {
  bool present = false;
  std::array<float, 3> ground{};
  std::array<float, 3> vertical{};
};

/// A curve of two parabolas from a value x and slope s to a value X and slope S in a number of steps. The second
/// difference of each half is −way · (X − x − steps · s) − change · (S − s).
struct ChainSpread {
  std::array<float, 2> way{};     ///< factors of the first half, and of the latter
  std::array<float, 2> change{};  ///< factors of the first half, and of the latter
  float slope = 0;                ///< −1 / (steps − 1): factor of linear offsets; 0 for one step
};

/// Returns the number of steps of the first parabola.
inline std::uint32_t first_half(std::uint32_t steps) { return (steps + 1) / 2; }

/// Number of values read at once from a row, and of padding values behind the last row.
inline constexpr std::size_t kRowReach = 8;

struct ChainProgram {
  int channels = 0;  ///< 3 or 7
  int rate_count = 0;
  int modes = 0;
  int breadth = 0;  ///< successors per segment and mode; 0: any segment of the mode
  int history = 1;  ///< number of past modes that determine the next one
  bool heading_free = true;
  float position_scale = 1;
  float orientation_scale = 1;
  float velocity_scale = 1;
  float spin_scale = 1;
  float step_seconds = 0;
  std::uint32_t blend_steps = 0;  ///< largest number of steps of a join, on either side; 0: no blending
  float height_scale = 0;         ///< metres per unit of the segments' initial heights
  float max_return = 0;           ///< metres per step: largest speed of return to the initial heights
  float speed_unit = 1;           ///< root-mean-square speed at both ends of the segments, metres per second
  float spin_unit = 1;            ///< root-mean-square angular speed there, radians per second
  GustProgram gust{};
  std::span<std::int16_t> rows;
  std::span<std::int16_t> rates;
  std::span<float> changes;            ///< poses: per segment, change of the stored quaternion in half a step, at its
                                       ///< start and its end
  std::span<ChainSpread> spread;       ///< by number of steps, up to twice those of a blend
  std::span<std::uint32_t> first_row;  ///< per segment, and one past the last
  std::span<std::uint16_t> mode;       ///< per segment
  std::span<std::uint16_t> follow;     ///< segments × modes × breadth: successors, the best-joining first
  std::span<std::int16_t> height;      ///< per segment; empty: unbounded heights
  std::span<std::uint32_t> first_of_mode;  ///< per mode its first segment, and one past the last
  std::span<std::uint32_t> threshold;  ///< states × modes: the first mode whose threshold exceeds the word is drawn
  std::span<std::int16_t> lead;        ///< segments × 3, as in ChainDrift; empty: no steering
  float lead_scale = 0;
  std::array<float, 3> drift{};  ///< mean velocity, metres per second
  float spread_ground = 0;       ///< variance growth, m² per second
  float spread_height = 0;
  float mean_steps = 0;   ///< mean number of steps per segment
  float memory = 0;       ///< seconds
  float half_width = 0;   ///< of the body, along its first axis, metres; 0: a point
  float half_length = 0;  ///< of the body, along its second axis

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

/// Compiles a chain. State 0 of the Markov chain precedes the first segment; state k + 1 has row k of the model's
/// probabilities. `wind_unit`: unit of the wind regressors.
ChainProgram make_chain_program(const ChainModel& chain, double rate_hz, double wind_unit, Arena& arena);

/// Sets the size of the program's body from a PoseView; other views change nothing.
void take_size(const View& view, ChainProgram& program);

std::uint64_t hash_of(const ChainProgram& program, std::uint64_t before);

/// Checks the scales. Errors: one so small or large that products leave the range of single precision.
Result<void> check_chain_program(const ChainModel& chain);

}  // namespace wisp
