#pragma once
// Things that are seen in frame after frame, alone and as falls.

#include <cstddef>
#include <cstdint>
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

/// Why a fall was not followed from its release to its end.
enum class Cut {
  kNo,
  kSide,    ///< it leaves the picture at a side, or comes in there
  kLost,    ///< it is lost from view in the air
  kPasses,  ///< it comes so near to another that either may have been taken for the other
  kQuick,   ///< it is over in less than 0.3 s or 8 frames
};

/// Something on its way down: a row for every frame from its release until it lies or leaves the picture.
struct Fall {
  std::size_t first = 0;             ///< frame of the first row
  std::vector<Thing> rows;           ///< `angle` goes on without jumps, beyond ±π/2
  std::vector<std::uint8_t> filled;  ///< 1: not seen, interpolated
  Cut cut = Cut::kNo;
};

struct Falls {
  std::vector<Fall> falls;  ///< in the order of their beginnings
  std::vector<Cut> missed;  ///< of what sinks, but is followed for too short to be one of them, or passes another
};

/// The falls among what was seen. Something falls if it is in view for at least 0.3 s and 8 frames and sinks by at
/// least a quarter of the picture's height.
Falls falls_in(std::span<const Seen> frames, const Scale& scale);

}  // namespace wisp::fall
