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

/// Examines the strip below the region `flame` in which the flame moves. Empty where the strip is as dark as its
/// surroundings (a flame on black), has no edge on both sides, or the pictures have no colour.
std::optional<CandleLook> look_of_candle(std::span<const Picture> pictures, const Region& flame);

}  // namespace wisp
