#pragma once
// Joins films of one flame from several level cameras to its body: rings on an axis.
//
// A camera at azimuth α sees the projection x cos α − z sin α of a horizontal position (x, z). Symmetric parts of an
// outline are those of the body; antisymmetric parts are projections of vectors, which two or more angles determine.

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "wisp/base/result.hpp"
#include "wisp/capture/clip/clip_capture.hpp"

namespace wisp {

/// One film, captured with the knots of the first film.
struct FilmedView {
  double azimuth_degrees = 0;  ///< camera azimuth, anticlockwise from above
  Recording recording{};
  std::vector<double> loudness{};  ///< RMS of the sound at the recording's rate; empty: no sound
  double heard_from = 0;           ///< time of the first loudness value, seconds after the film's first frame
};

/// Adds to `rings` the outline seen from beside each blow, wind from the left, with its lean at rest subtracted; the
/// wind, which is the first input of `film` (null: none) from row `first_row` on; and, as motion wind.x and wind.z, the
/// wind as a vector in the direction in which the flame leans. Every blow after the first begins an episode. Returns a
/// report on the blows.
ReportSection see_from_beside(const Recording* film, double first_row, Recording& rings);

/// Response to a blow: its direction (radians), mean wind weighted by its square, and lean per unit of wind.
struct BlowAnswer {
  double azimuth = 0, strength = 0, lean = 0;
};

inline constexpr std::size_t kMinSymmetryBlows = 9;

/// Returns how much the lean per unit of wind depends on direction, in percent of its mean, after removing a linear
/// dependence on strength: the RMS of two harmonics over all directions, less the part expected by chance, and the two
/// ends of its 95 % interval from permuted leans. None for fewer blows than kMinSymmetryBlows or uneven directions.
std::optional<std::array<double, 3>> asymmetry_of(std::span<const BlowAnswer> blows);

/// Joins films, in pixels of the first: x to the right of a camera at 0°, y up from the base at rest, z towards that
/// camera. Returns one row per frame of the common time, with the channels of see_from_beside() and, for every ring k
/// from the base to the tip, as motion ringk.x, .y, .z, .r (radius), .tx and .tz (rise of its rim towards +x and +z).
/// Errors, naming the film: as check_azimuths(); an odd number of control points, another number of points or another
/// rate than the first film, an unusable film, no time in common with the first.
Result<Captured> join_views(std::span<const FilmedView> views);

/// Checks camera directions. Errors: fewer than two films, not one angle each, directions equal or opposite within 1°.
Result<void> check_azimuths(std::span<const double> azimuths, std::span<const std::string> names);

}  // namespace wisp
