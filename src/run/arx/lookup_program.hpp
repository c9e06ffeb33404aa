#pragma once
// Rows of residuals as places to go on from: where the model's state has been when each was played. Rows that no input
// drives are followed from place to place by it.

#include <cstdint>
#include <span>

#include "run/state/arena.hpp"
#include "wisp/model/model.hpp"

namespace wisp {

/// Components of the state that places are compared by: those that move most.
inline constexpr int kMaxTraits = 6;
/// Most places; of more rows those at even distances are places.
inline constexpr std::uint32_t kMaxPlaces = 128;
/// Places that are compared at once.
inline constexpr std::uint32_t kPlacesAtOnce = 8;
/// A jump leads to one of so many best places, by chance.
inline constexpr int kNearestPlaces = 4;
/// Parts of all rows whose play is counted.
inline constexpr std::uint32_t kPlayedParts = 32;

struct LookupProgram {
  int traits = 0;              ///< of the position, and as many of the speed; 0: nothing is looked up
  std::uint32_t places = 0;    ///< from 1
  std::uint32_t shortest = 1;  ///< steps from a jump to the next; fewer where a stretch ends
  std::uint32_t longest = 1;
  std::uint32_t beside = 0;     ///< rows on either side of those that would follow, to which no jump leads
  std::uint32_t recent = 0;     ///< rows played last, to which no jump leads
  std::uint32_t part_rows = 1;  ///< rows of each part but the last
  float coverage = 0;           ///< the cost of a place: this, times the counts of its two parts, over the count of all
  float quickness = 0;          ///< by which a difference of positions is multiplied to make a speed
  std::span<float> position;    ///< row × traits, together of variance 1 where all components are among them
  std::span<float> place;       ///< group × (position, speed) × kPlacesAtOnce
  std::span<std::uint32_t> row;   ///< per place, the row that is played first
  std::span<std::uint8_t> ahead;  ///< per place, the parts in which its next half second lies, two

  bool empty() const { return traits == 0; }
  std::uint32_t groups() const { return (places + kPlacesAtOnce - 1) / kPlacesAtOnce; }
};

/// Lays the program out for residuals that nothing drives and, unless the arena measures, fills it. `left`: per row,
/// how many follow it in its stretch; empty while measuring.
///
/// Precondition: the model has passed check().
LookupProgram make_lookup_program(const Model& model, const ArxModel& arx, std::span<const std::uint32_t> left,
                                  Arena& arena);

}  // namespace wisp
