#pragma once
// Tracks of objects over frames, and the falls among them.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "capture/clip/fall/fall_scene.hpp"

namespace wisp::fall {

/// Picture size and frame rate of the tracking.
struct Scale {
  double rate_hz = 0;
  double width = 0;   ///< picture width, reduced pixels
  double height = 0;  ///<
};

struct Track {
  std::vector<std::size_t> frames{};
  std::vector<Thing> things{};

  /// Mean speed over the last steps, reduced pixels a frame; 0 for a single row.
  double speed(double Thing::*axis, std::size_t steps) const;
  /// Mean speed over the first steps, likewise.
  double first_speed(double Thing::*axis, std::size_t steps) const;
};

/// Tracks objects by nearest prediction at constant velocity. An object that is briefly invisible or splits briefly
/// stays one track.
std::vector<Track> tracks_in(std::span<const Seen> frames, const Scale& scale);

/// Reason why a fall was not followed from its release to its end.
enum class Cut {
  kNo,
  kSide,    ///< it leaves or enters the picture at a side
  kLost,    ///< it disappears in the air
  kPasses,  ///< it comes so near to another object that the two may be confused
  kQuick,   ///< it lasts less than 0.3 s or 8 frames
};

/// A falling object: one row per frame from its release until it lies or leaves the picture.
struct Fall {
  std::size_t first = 0;             ///< frame of the first row
  std::vector<Thing> rows;           ///< `angle` is unwrapped, beyond ±π/2
  std::vector<std::uint8_t> filled;  ///< per row, 1: not seen, interpolated
  Cut cut = Cut::kNo;
};

struct Falls {
  std::vector<Fall> falls;  ///< in order of their first frames
  std::vector<Cut> missed;  ///< sinking tracks that are too short to be falls, or pass another object
};

/// Finds the falls in the frames: objects in view for at least 0.3 s and 8 frames that sink by at least a quarter of
/// the picture's height.
Falls falls_in(std::span<const Seen> frames, const Scale& scale);

}  // namespace wisp::fall
