#pragma once
// Rows of residuals as jump targets, each with the model's state when it was recorded. Used to replay rows without a
// driving input.

#include <cstdint>
#include <span>

#include "run/state/arena.hpp"
#include "wisp/model/model.hpp"

namespace wisp {

/// Number of state components by which targets are compared: those that contribute most to motion.
inline constexpr int kMaxTraits = 6;
/// Largest number of targets; more rows are subsampled evenly.
inline constexpr std::uint32_t kMaxPlaces = 128;
/// Number of targets compared at once.
inline constexpr std::uint32_t kPlacesAtOnce = 8;
/// Number of best targets among which a jump chooses at random.
inline constexpr int kNearestPlaces = 4;
/// Number of parts of the residuals whose use is counted.
inline constexpr std::uint32_t kPlayedParts = 32;

struct LookupProgram {
  int traits = 0;              ///< number of position components, and of speed components; 0: no lookup
  std::uint32_t places = 0;    ///< number of jump targets
  std::uint32_t shortest = 1;  ///< fewest steps from one jump to the next; fewer where a stretch ends
  std::uint32_t longest = 1;
  std::uint32_t beside = 0;       ///< number of rows, on either side of the natural successors, excluded as targets
  std::uint32_t recent = 0;       ///< number of recently played rows excluded as targets
  std::uint32_t part_rows = 1;    ///< rows of each part but the last
  float coverage = 0;             ///< cost of usage: this × the counts of a target's two parts / the total count
  float quickness = 0;            ///< factor that converts a difference of positions to a speed
  std::span<float> position;      ///< row × traits, scaled to total variance 1 over all components
  std::span<float> place;         ///< group × (position, speed) × kPlacesAtOnce
  std::span<std::uint32_t> row;   ///< per target, the row that is played first
  std::span<std::uint8_t> ahead;  ///< per target, the two parts that contain its next half second

  bool empty() const { return traits == 0; }
  std::uint32_t groups() const { return (places + kPlacesAtOnce - 1) / kPlacesAtOnce; }
};

/// Lays the program out for residuals without a driving input and, unless the arena measures, fills it. `left`: per
/// row, the number of rows that follow in its stretch; empty while measuring.
///
/// Precondition: the model has passed check().
LookupProgram make_lookup_program(const Model& model, const ArxModel& arx, std::span<const std::uint32_t> left,
                                  Arena& arena);

}  // namespace wisp
