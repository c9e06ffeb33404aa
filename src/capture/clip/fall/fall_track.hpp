#pragma once
// One thing that is seen in frame after frame.

#include <cstddef>
#include <span>
#include <vector>

#include "capture/clip/fall/fall_scene.hpp"

namespace wisp::fall {

/// What it is measured against.
struct Scale {
  double rate_hz = 0;
  double width = 0;   ///< of the picture, small pixels
  double height = 0;  ///<
};

struct Track {
  std::vector<std::size_t> frames{};
  std::vector<Thing> things{};

  /// Small pixels a frame, over its last steps; 0 for a single one.
  double speed(double Thing::*axis, std::size_t steps) const;
  /// The same over its first.
  double first_speed(double Thing::*axis, std::size_t steps) const;
};

/// Tracks by nearest prediction, with constant velocity. What is out of sight for a moment, or falls into two for one,
/// goes on as one track.
std::vector<Track> tracks_in(std::span<const Seen> frames, const Scale& scale);

}  // namespace wisp::fall
