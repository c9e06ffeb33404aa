#pragma once
// The regression of an ARX model with its outputs side by side, where a block has instances: for banks of so few that
// most of a block's lanes would be empty.

#include <cstdint>
#include <span>

#include "run/lanes/blocks.hpp"
#include "run/state/arena.hpp"

namespace wisp {

struct Regression;

/// Whether there is a kernel for few instances beside the one for blocks; builds for size leave it out.
inline constexpr bool kFewApart = WISP_BLOCKS_AT_ONCE > 1;

/// Outputs that are computed at once.
inline constexpr std::size_t kOutputsAtOnce = 8;

/// Lags of one column, each one less than the one before.
struct ColumnRun {
  std::uint32_t column;
  std::uint32_t first_lag;  ///< the longest
  std::uint32_t count;
};

/// Where the newest numbers of a column come from.
enum class ColumnSource : std::uint8_t {
  kGroup,      ///< they are what a group has made
  kOneOutput,  ///< one for all places
  kOutputs,
  kOneRegressor,
  kRegressors
};

/// Groups of up to kOutputsAtOnce outputs whose sums go over the same lags in the same order, each over its own
/// channels. A column holds, of one run of a group, every output's channel. Places that a group leaves empty make its
/// first output once more: what a group makes may be another's column too.
struct OutputProgram {
  std::size_t groups = 0;            ///< known while measuring, when all arrays are empty; 0: blocks are as fast
  std::size_t columns = 0;           ///< the same
  std::span<std::uint32_t> output;   ///< [group][place]: which
  std::span<std::uint32_t> count;    ///< per group, its outputs
  std::span<std::uint32_t> run_end;  ///< per group, one past its last run
  std::span<ColumnRun> runs;
  std::span<std::uint32_t> channel;    ///< [column][place]: where in a block's sample, [channel][lane], its lanes begin
  std::span<ColumnSource> source;      ///< per column
  std::span<std::uint32_t> own;        ///< per group, the column of what it makes; one past the last: there is none
  std::span<float> coefficients;       ///< [tap][place], in the order of groups, runs and lags
  std::span<float> constant;           ///< [group][place]
  std::size_t shock_rows = 0;          ///< of all groups: the most shocks of an output, added up
  std::span<std::uint32_t> shock_end;  ///< per group, one past its last row
  std::span<std::uint32_t> shock;      ///< [row][place]: which shock of the regression; one past the last: none
  std::span<std::uint32_t> shock_place;  ///< [row][place]: where its standard normal number is drawn to
};

/// Where the standard normal number of a channel is drawn to: of every kOutputsAtOnce pairs first the first ones.
constexpr std::uint32_t normal_place(std::uint32_t channel) {
  constexpr auto kOnce = static_cast<std::uint32_t>(kOutputsAtOnce);
  return channel / (2 * kOnce) * (2 * kOnce) + channel % 2 * kOnce + channel % (2 * kOnce) / 2;
}

/// Lays the program out and, unless the arena measures, fills it. It is empty where there is more than one mode, or
/// where groups would be half empty.
OutputProgram make_output_program(const Regression& regression, Arena& arena);

}  // namespace wisp
