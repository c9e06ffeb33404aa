#pragma once
// Things that are seen in frame after frame, as falls.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "capture/clip/fall/fall_scene.hpp"

namespace wisp::fall {

/// Something on its way down: a row for every frame from its release until it lies or leaves the picture.
struct Fall {
  std::size_t first = 0;             ///< frame of the first row
  std::vector<Thing> rows;           ///< `angle` goes on without jumps, beyond ±π/2
  std::vector<std::uint8_t> filled;  ///< 1: not seen, interpolated
};

/// The falls among what was seen, in the order of their beginnings. Something falls if it is in view for at least 0.3 s
/// and 8 frames and sinks by at least a quarter of `height`, the picture's, in small pixels.
std::vector<Fall> falls_in(std::span<const Seen> frames, double rate_hz, int height);

}  // namespace wisp::fall
