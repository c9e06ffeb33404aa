#pragma once
// Resampled residuals compiled for stepping: in channel units, with a tree over the input's recent past at every row.

#include <array>
#include <cstdint>
#include <span>

#include "run/arx/lookup_program.hpp"
#include "run/state/arena.hpp"
#include "wisp/model/model.hpp"

namespace wisp {

/// A leaf of the tree has at most so many rows: the candidates of a jump.
inline constexpr std::uint32_t kCandidates = 8;
/// A jump takes one of so many best of them, by chance.
inline constexpr int kNearestRows = 3;
/// Blocks before the present one whose rows a jump avoids.
inline constexpr int kRecentBlocks = 3;

/// A node of the tree: rows whose input was lower `lag` (an index of lags) steps before lie on the left.
struct PastNode {
  float value;
  std::uint32_t lag;
};

/// The rows of one leaf of the tree, side by side for the comparison.
struct Candidates {
  std::array<float, kCandidates> row;            ///< index of the residual row
  std::array<std::uint32_t, kCandidates> place;  ///< 2 · row, plus 1 for the mirror image
  std::uint32_t count;
};

struct ResampledProgram {
  int outputs = 0;  ///< 0: nothing is resampled
  int across = 0;   ///< in the round, outputs at the end that take across the input what as many before take along it
  int sides = 1;    ///< 2: an input from the other side plays mirror images
  int toward = -1;
  float tolerance = 0;  ///< of the sum over lags
  float margin = 0;     ///< nearer to a node's value than this, chance takes the side
  std::uint32_t longest = 1;
  int depth = 1;  ///< steps of the input that are looked back at, the present one included
  std::span<std::uint32_t> lags;
  std::span<float> rows;           ///< side × rows × columns, in the outputs' channel units
  std::span<std::uint32_t> left;   ///< per row, how many follow it in its stretch
  std::span<float> wind;           ///< of every stretch, first what was before it; empty where nothing drives it
  std::span<std::uint32_t> now;    ///< per row, its place in `wind`
  std::span<std::uint8_t> turned;  ///< per row: 1 where its past lies in the tree as its mirror image
  std::span<PastNode> nodes;       ///< children of node k are 2k + 1 and 2k + 2; halves of what it has
  std::span<Candidates> leaves;    ///< child k of the tree is leaf k − nodes
  std::span<float> leaf_wind;  ///< leaf × lag × candidate: its past as it lies in the tree, infinite where none is
  std::span<std::uint32_t> order;  ///< rows, leaf after leaf: to build the tree
  std::span<std::uint16_t> from;   ///< side × columns: whose residual an output takes
  std::span<float> factor;         ///< side × columns, of what is taken: 1, on the mirrored side −1 where it negates
  std::span<float> unit;           ///< per output across: what its residual is multiplied with for units of its own
  LookupProgram lookup;            ///< where nothing drives it

  bool empty() const { return outputs == 0; }
  bool driven() const { return toward >= 0; }
  bool mirrors() const { return sides == 2; }
  int columns() const { return outputs - across; }

  /// The residuals of a place: twice the row, and 1 more where its mirror image is played.
  const float* played(std::uint32_t place) const {
    const std::size_t side = place % 2 != 0 ? left.size() : 0;
    return rows.data() + (side + place / 2) * static_cast<std::size_t>(columns());
  }
};

/// Lays the program out and, unless the arena measures, fills it.
///
/// Precondition: the model has passed check().
ResampledProgram make_resampled_program(const Model& model, const ArxModel& arx, Arena& arena);

/// A hash of the program, over a hash of what came before: the latter itself where nothing is resampled.
std::uint64_t hash_of(const ResampledProgram& program, std::uint64_t before);

}  // namespace wisp
