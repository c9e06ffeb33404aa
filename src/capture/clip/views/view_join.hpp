#pragma once
// Films of one flame from several level directions, joined to its body: rings on an axis.
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

/// One film, captured with the curve shape of the first one.
struct FilmedView {
  double azimuth_degrees = 0;  ///< camera azimuth, anticlockwise from above
  Recording recording{};
  std::vector<double> loudness{};  ///< RMS of the sound at the recording's rate; empty: no sound
  double heard_from = 0;           ///< time of its first value, seconds after the film's first frame
};

/// Adds to rings the outline as seen by a camera beside each blow, so that the wind blows to the right, minus the lean
/// at rest. Adds the first input of `film` (null: none), whose row `first_row` is the rings' first, and this wind as a
/// vector in the direction in which the flame leans, as motion wind.x and wind.z. Every blow begins an episode. Returns
/// a report on the blows.
ReportSection see_from_beside(const Recording* film, double first_row, Recording& rings);

/// Response to a blow: its direction (radians), mean wind weighted by its square, and lean per unit of wind.
struct BlowAnswer {
  double azimuth = 0, strength = 0, lean = 0;
};

inline constexpr std::size_t kMinSymmetryBlows = 9;

/// Dependence of the lean per unit of wind on direction, in percent of its mean, after a linear dependence on strength:
/// the RMS over directions of two harmonics, minus its expectation by chance; and its 95 % interval from permuted
/// leans. Empty for fewer blows than kMinSymmetryBlows, or unevenly distributed directions.
std::optional<std::array<double, 3>> asymmetry_of(std::span<const BlowAnswer> blows);

/// Joins films, in pixels of the first: x to the right of a camera at 0°, y up from the base at rest, z towards that
/// camera. Returns, for every frame present in all films and every ring k from the base to the tip, as motion ringk.x,
/// .y, .z, .r (radius), .tx and .tz (rise of its rim towards +x and +z), and the channels of see_from_beside().
/// Errors, naming the film: as check_azimuths(); an odd number of points, a number or rate other than the first film's,
/// an unusable film, no time in common with the first.
Result<Captured> join_views(std::span<const FilmedView> views);

/// Errors: fewer than two films, not one angle each, a direction equal or opposite to another film's.
Result<void> check_azimuths(std::span<const double> azimuths, std::span<const std::string> names);

}  // namespace wisp
