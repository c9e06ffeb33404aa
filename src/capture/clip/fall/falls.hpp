#pragma once
// Finds falls in a film: estimates the wall (the static background) from frames of the whole film, finds the objects
// before the wall in each frame, tracks them, selects the falls, and reports whether they are usable or why none is.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "wisp/base/report.hpp"
#include "wisp/base/result.hpp"

namespace wisp::fall {

/// A reduced luma picture, row by row; empty: the frame is lost.
using Frame = std::vector<std::uint8_t>;

/// Aspect below which an object has no measurable long axis.
inline constexpr double kRound = 1.3;

/// The static background, and its variation.
struct Wall {
  int width = 0;
  int height = 0;
  std::vector<float> brightness;  ///< median over the film
  std::vector<float> tolerance;   ///< difference above which a pixel shows an object
  double noise = 0;               ///< standard deviation of the median pixel, grey levels
  double shake = 0;               ///< RMS shift in reduced pixels; 0 also for a wall without texture
  double unsteady = 0;            ///< share of pixels that change in 30 % of the frames or more, as if the camera moved
};

/// Estimates the wall. Precondition: a frame is not empty, and all that are not empty have width × height pixels.
Wall wall_of(std::span<const Frame> frames, int width, int height);

/// An object before the wall. Units: pixels of the reduced picture, y down.
struct Thing {
  double x = 0, y = 0;  ///< centroid
  double contrast = 0;  ///< difference from the wall, grey levels
  double angle = 0;     ///< from the horizontal to the long axis, anticlockwise, −π/2 to π/2
  double aspect = 1;    ///< length / width
  double left = 0;      ///< first column
  double right = 0;     ///< last column
  double bottom = 0;    ///< lowest row
};

struct Seen {
  std::vector<Thing> things{};  ///< objects that touch no border of the picture
  bool at_border = false;       ///< whether another object touches the border
};

/// Finds the objects of a frame. Precondition: the frame has the wall's size.
Seen seen_in(const Frame& frame, const Wall& wall);

/// Picture size and frame rate of the tracking.
struct Scale {
  double rate_hz = 0;
  double width = 0, height = 0;  ///< of the picture, reduced pixels
};

/// Whether a fall was followed from its release to its end or the film's (kNo), or why not.
enum class Cut {
  kNo,
  kSide,    ///< the object leaves or enters the picture at a side
  kLost,    ///< the object disappears in the air
  kPasses,  ///< the object comes so near to another that the two may be confused
  kQuick,   ///< the fall lasts less than 0.3 s or 8 frames
};

/// A falling object: one row per frame from its release until it lies or leaves the picture.
struct Fall {
  std::size_t first = 0;             ///< frame of the first row
  std::vector<Thing> rows;           ///< `angle` is unwrapped, beyond ±π/2
  std::vector<std::uint8_t> filled;  ///< per row, 1: interpolated, as the object was not detected
  Cut cut = Cut::kNo;
};

struct Falls {
  std::vector<Fall> falls;  ///< in order of their first frames
  std::vector<Cut> missed;  ///< reason for each fall that was not followed or that passes another object
};

/// Finds falls: objects in view for at least 0.3 s and 8 frames that sink by at least 1/4 of the picture's height.
Falls falls_in(std::span<const Seen> frames, const Scale& scale);

struct Facts {
  std::size_t rows = 0;
  std::size_t filled = 0;  ///< number of rows interpolated between frames with the object
  double aspect = 0;       ///< median of length / width
  double short_share = 0;  ///< share of rows in which the object is too round to measure attitude
  double jerks = 0;        ///< share of rows in which the object's axis jumps

  /// Returns whether the object is long enough and its axis steady enough to measure attitude; tilt_reason(): why.
  bool tilt() const;
  const char* tilt_reason() const;
};

/// Precondition: `falls` is not empty, and each fall has rows.
Facts facts_of(const std::vector<Fall>& falls);

/// Returns the reason why a film contains no usable track of a fall.
Error no_fall(const std::string& source, const Wall& wall, const std::vector<Seen>& frames, const Falls& found);

ReportVerdict verdict_on(const Falls& found, const Wall& wall);

/// Returns a warning if more than 20 % of the rows were interpolated.
std::optional<std::string> filled_warning(const Facts& facts);

/// `frames`: all frames, lost ones empty; `repeated`: number of frames equal to the frame before.
ReportSection frames_section(const std::vector<Frame>& frames, std::size_t repeated, const Wall& wall, double rate_hz);

ReportSection falls_section(const Falls& found, const Facts& facts, double metres_per_pixel, double rate_hz);

}  // namespace wisp::fall
