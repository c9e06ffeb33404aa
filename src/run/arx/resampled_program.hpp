#pragma once
// Resampled residuals compiled for stepping: in channel units, with a k-d tree over every row's input past.

#include <array>
#include <cstdint>
#include <span>

#include "run/arx/lookup_program.hpp"
#include "run/state/arena.hpp"
#include "wisp/model/model.hpp"

namespace wisp {

/// Largest number of rows in a leaf of the tree: the candidates of a jump.
inline constexpr std::uint32_t kCandidates = 8;
/// Number of best candidates among which a jump chooses at random.
inline constexpr int kNearestRows = 3;
/// Number of earlier blocks whose rows a jump avoids.
inline constexpr int kRecentBlocks = 3;

/// A node of the tree: rows whose input at `lag` (an index of lags) is below `value` are on the left.
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
  int across = 0;   ///< for a body, number of last outputs across the input; as many before them are along it
  int sides = 1;    ///< 2: input of the opposite sign plays mirror images
  int toward = -1;
  float tolerance = 0;  ///< tolerance of the sum over lags
  float margin = 0;     ///< distance from a node's value within which the side is random
  std::uint32_t longest = 1;
  int depth = 1;  ///< steps of input past that are read, the present one included
  std::span<std::uint32_t> lags;
  std::span<float> rows;           ///< side × rows × columns, in the outputs' channel units
  std::span<std::uint32_t> left;   ///< per row, number of rows that follow in its stretch
  std::span<float> wind;           ///< per stretch, input before it, then during it; empty without a driving input
  std::span<std::uint32_t> now;    ///< per row, its index in `wind`
  std::span<std::uint8_t> turned;  ///< per row: 1 if the tree holds its mirror image's past
  std::span<PastNode> nodes;       ///< children of node k are 2k + 1 and 2k + 2; each halves its rows
  std::span<Candidates> leaves;    ///< child k of the tree is leaf k − nodes
  std::span<float> leaf_wind;      ///< leaf × lag × candidate: past as stored in the tree, infinite for a missing one
  std::span<std::uint32_t> order;  ///< rows, leaf after leaf: for building the tree
  std::span<std::uint16_t> from;   ///< side × columns: output whose residual is taken
  std::span<float> factor;         ///< side × columns, factor of that residual: 1, or −1 on the mirrored side
  std::span<float> unit;           ///< per output across: factor from its residual to its own unit
  LookupProgram lookup;            ///< used without a driving input

  bool empty() const { return outputs == 0; }
  bool driven() const { return toward >= 0; }
  bool mirrors() const { return sides == 2; }
  int columns() const { return outputs - across; }

  /// Returns the residuals of a place: twice the row, plus 1 for its mirror image.
  const float* played(std::uint32_t place) const {
    const std::size_t side = place % 2 != 0 ? left.size() : 0;
    return rows.data() + (side + place / 2) * static_cast<std::size_t>(columns());
  }
};

/// Lays the program out and, unless the arena measures, fills it.
///
/// Precondition: the model has passed check().
ResampledProgram make_resampled_program(const Model& model, const ArxModel& arx, Arena& arena);

/// Hashes the program, continuing from the hash `before`; returns `before` without resampling.
std::uint64_t hash_of(const ResampledProgram& program, std::uint64_t before);

}  // namespace wisp
