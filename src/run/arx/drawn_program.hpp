#pragma once
// Drawn residuals compiled for stepping: in channel units, with an index of rows by the strength of the input.

#include <array>
#include <cstdint>
#include <span>

#include "run/bank/arena.hpp"
#include "wisp/model/model.hpp"

namespace wisp {

/// Rows near in strength of which a jump looks at some, and at how many: the one whose input rose most alike is taken.
/// More of either find rows that are no more alike, and cost more.
inline constexpr std::uint32_t kNearRows = 64;
inline constexpr int kCandidates = 8;

struct DrawnProgram {
  int outputs = 0;  ///< 0: nothing is drawn
  int sides = 1;    ///< 2: an input from the other side plays mirror images
  int toward = -1;
  int against = -1;
  int trend_steps = 1;
  float tolerance = 0;
  std::uint32_t shortest = 1;
  std::uint32_t longest = 1;
  std::span<float> rows;           ///< rows × outputs, in the outputs' channel units
  std::span<std::uint32_t> left;   ///< per row, how many follow it in its stretch
  std::span<float> wind;           ///< per row; empty where nothing drives it
  std::span<float> trend;          ///< per row
  std::array<int, 4> lean_of{};    ///< outputs whose sums, two by two, are an instance's lean
  std::array<float, 4> lean{};     ///< their factors
  std::span<float> leans;          ///< rows × 2, or empty
  std::span<std::uint32_t> order;  ///< rows by rising strength of the wind, or by rising wind where there is no mirror
  std::span<std::uint16_t> from;   ///< side × outputs: whose residual an output takes
  std::span<float> factor;         ///< side × outputs, of what is taken: 1, on the mirrored side −1 where it negates

  bool empty() const { return outputs == 0; }
  bool driven() const { return toward >= 0; }
  bool mirrors() const { return sides == 2; }
};

/// Lays the program out and, unless the arena measures, fills it.
///
/// Precondition: the model has passed check().
DrawnProgram make_drawn_program(const Model& model, const ArxModel& arx, Arena& arena);

/// Whether output b always gets the negative of what output a gets.
bool residuals_mirror(const DrawnProgram& program, int a, int b);

/// A hash of the program, over a hash of what came before: the latter itself where nothing is drawn.
std::uint64_t hash_of(const DrawnProgram& program, std::uint64_t before);

}  // namespace wisp
