#pragma once
// Resampled residuals compiled for stepping, in channel units. Residuals with a driving input have a k-d tree over the
// input pasts of jump targets; others have a list of jump targets, each with the model's position and speed there.

#include <array>
#include <cstdint>
#include <span>

#include "run/state/arena.hpp"
#include "wisp/model/model.hpp"

namespace wisp {

/// Largest number of outputs by which targets are compared: those of largest variance in the visible motion.
inline constexpr int kMaxTraits = 6;
/// Largest number of targets; more rows are subsampled evenly.
inline constexpr std::uint32_t kMaxPlaces = 128;
/// Number of targets compared at once.
inline constexpr std::uint32_t kPlacesAtOnce = 8;
/// Number of best targets among which a jump chooses at random.
inline constexpr int kNearestPlaces = 4;
/// Number of parts into which the residuals' rows are divided to count how often they are played.
inline constexpr std::uint32_t kPlayedParts = 32;

struct LookupProgram {
  int traits = 0;              ///< number of position components, and of speed components; 0: no lookup
  std::uint32_t places = 0;    ///< number of jump targets
  std::uint32_t shortest = 1;  ///< fewest steps between jumps, unless a stretch ends before
  std::uint32_t longest = 1;
  std::uint32_t beside = 0;       ///< number of rows before and after the next recorded row that are no targets
  std::uint32_t recent = 0;       ///< number of recently played rows that are no targets
  std::uint32_t part_rows = 1;    ///< rows of each part but the last
  float coverage = 0;             ///< a target's usage costs coverage × (play counts of its two parts) / total count
  float quickness = 0;            ///< factor that converts a difference of positions to a speed
  std::span<float> position;      ///< row × traits, scaled to total variance 1 over all components
  std::span<float> place;         ///< group × (position, speed) × kPlacesAtOnce
  std::span<std::uint32_t> row;   ///< per target, the row that is played first
  std::span<std::uint8_t> ahead;  ///< per target, the parts that hold the rows 1/8 s and 3/8 s after it

  bool empty() const { return traits == 0; }
  std::uint32_t groups() const { return (places + kPlacesAtOnce - 1) / kPlacesAtOnce; }
};

/// Largest number of rows in a leaf of the tree: the candidates of a jump.
inline constexpr std::uint32_t kCandidates = 8;
/// Number of best candidates among which a jump chooses at random.
inline constexpr int kNearestRows = 3;
/// Number of earlier runs of rows, each from one jump to the next, that a jump avoids.
inline constexpr int kRecentBlocks = 3;

/// A node of the tree: the half of its rows with smaller inputs at lags[`lag`] is on the left. `value` is in between.
struct PastNode {
  float value;
  std::uint32_t lag;
};

/// The rows of one leaf of the tree, interleaved for the comparison.
struct Candidates {
  std::array<float, kCandidates> row;            ///< index of the residual row
  std::array<std::uint32_t, kCandidates> place;  ///< 2 · row, plus 1 for the mirror image
  std::uint32_t count;
};

struct ResampledProgram {
  int outputs = 0;  ///< 0: no resampling
  int across = 0;   ///< for a body: the last `across` outputs are z components, the `across` before them x components
  int sides = 1;    ///< 2: `rows` also holds mirror images, which are played for input of the opposite sign
  int toward = -1;  ///< index of the driving regressor; −1: none
  float tolerance = 0;  ///< tolerated sum over lags of absolute input differences
  float margin = 0;     ///< distance from a node's value within which a search takes a random side
  std::uint32_t longest = 1;
  int depth = 1;  ///< number of stored input samples, the present one included
  std::span<std::uint32_t> lags;
  std::span<float> rows;           ///< side × rows × columns, in the outputs' channel units
  std::span<std::uint32_t> left;   ///< per row, number of rows that follow in its stretch
  std::span<float> wind;           ///< per stretch, input before the stretch, then during it; empty without input
  std::span<std::uint32_t> now;    ///< per row, its index in `wind`
  std::span<std::uint8_t> turned;  ///< per row: 1 if the tree holds the row's input past with reversed sign
  std::span<PastNode> nodes;       ///< children of node k are 2k + 1 and 2k + 2; each gets half of the node's rows
  std::span<Candidates> leaves;    ///< a child index k beyond the nodes is leaf k − nodes.size()
  std::span<float> leaf_wind;  ///< leaf × lag × candidate: input past in the tree; infinite for missing candidates
  std::span<std::uint32_t> order;  ///< rows, leaf after leaf: for building the tree
  std::span<std::uint16_t> from;   ///< side × columns: index of the column that is played
  std::span<float> factor;  ///< side × columns, factor of that column: 1; mirrored: ± the ratio of channel units
  std::span<float> unit;    ///< per z component: factor from its x component's channel unit to its own
  LookupProgram lookup;     ///< used without a driving input

  bool empty() const { return outputs == 0; }
  bool driven() const { return toward >= 0; }
  bool mirrors() const { return sides == 2; }
  int columns() const { return outputs - across; }

  /// Returns the residuals of a place, a number that is 2 · row, plus 1 for the row's mirror image.
  const float* played(std::uint32_t place) const {
    const std::size_t side = place % 2 != 0 ? left.size() : 0;
    return rows.data() + (side + place / 2) * static_cast<std::size_t>(columns());
  }
};

/// Precondition: the model has passed check().
ResampledProgram make_resampled_program(const Model& model, const ArxModel& arx, Arena& arena);

/// Hashes the program, continuing from the hash `before`; returns `before` without resampling.
std::uint64_t hash_of(const ResampledProgram& program, std::uint64_t before);

}  // namespace wisp
