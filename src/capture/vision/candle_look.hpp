#pragma once
// Appearance of the candle in the film: its width and its colour.

#include <array>
#include <optional>
#include <span>

#include "wisp/capture/vision/picture.hpp"

namespace wisp {

/// The candle below a flame.
struct CandleLook {
  double width = 0;             ///< in heights of the flame's region
  std::array<double, 3> rgb{};  ///< mean red, green and blue of its side, 0 to 255, as lit in the film
};

/// Measures the candle in a strip below `flame`, the region in which the flame moves. None if the strip's middle is as
/// dark as its sides (a flame on black), an edge is missing, the width is no candle's, or the pictures have no colour.
std::optional<CandleLook> look_of_candle(std::span<const Picture> pictures, const Region& flame);

}  // namespace wisp
