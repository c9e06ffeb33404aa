#pragma once
// What holds the flame, as the film shows it: its width and its colour.

#include <array>
#include <optional>
#include <span>

#include "wisp/capture/vision/picture.hpp"

namespace wisp {

/// A candle below a flame.
struct CandleLook {
  double width = 0;             ///< in heights of the flame
  std::array<double, 3> rgb{};  ///< its side's mean red, green and blue, 0 to 255, as it is lit in the film
};

/// Looks at the strip below the flame, whose usual place is `flame`. Nothing where it is as dark as the ground beside
/// it (a flame on black), where there is no edge on both sides, or where the pictures have no colour.
std::optional<CandleLook> look_of_candle(std::span<const Picture> pictures, const Region& flame);

}  // namespace wisp
