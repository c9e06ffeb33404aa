#pragma once
// Films of one flame from several level directions, joined to its body: rings on an axis.
//
// A level camera sees of a horizontal place (x, z) its part to the right, x cos α − z sin α: of an outline's symmetric
// parts the body's own, of its antisymmetric ones such parts of vectors, which views at two angles and more give.

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "wisp/base/result.hpp"
#include "wisp/capture/clip/clip_capture.hpp"

namespace wisp {

/// Where two series fit best: by normalised cross-correlation over all offsets that leave enough in common.
struct TimeOffset {
  double rows = 0;         ///< the second series begins so much later than the first
  double correlation = 0;  ///< there, −1 to 1
  double next_best = 0;    ///< of the offsets at least a second away
  /// Two films of one flame correlate by 0.9 and more, 0.3 above the next best; films of two flames by at most 0.3.
  bool certain() const { return correlation >= 0.6 && correlation - next_best >= 0.15; }
};

/// The offset of two series of one rate; NaN is what is not known. Nothing where no offset leaves two seconds in
/// common, or nothing varies.
std::optional<TimeOffset> time_offset(std::span<const double> first, std::span<const double> second, double rate_hz);

/// One film, captured with the first one's curve.
struct FilmedView {
  double azimuth_degrees = 0;  ///< of the camera, anticlockwise from above
  Recording recording{};
  std::vector<double> loudness{};  ///< root mean square of the sound, one a row of the recording's rate; empty: none
  double heard_from = 0;           ///< when the first of them begins, seconds after the film's first frame
};

/// Adds to rings the outline as a camera beside each blow sees it, so that it blows to the right, less the lean at
/// rest, and the first input of `film` (null: none), whose row `first_row` is theirs first; as motion wind.x and
/// wind.z, the blow's vector, towards where the flame leans in it. A new blow begins an episode. Returns what each blow
/// was.
ReportSection see_from_beside(const Recording* film, double first_row, Recording& rings);

/// What a blow did: where it blew to (radians), its mean wind weighted by itself, and the lean for each 1 of wind.
struct BlowAnswer {
  double azimuth = 0, strength = 0, lean = 0;
};

inline constexpr std::size_t kMinSymmetryBlows = 9;

/// By how much the lean for each 1 of wind depends on the direction, in percent of its mean, beside a line in the
/// strength: the root mean square over all directions of two harmonics, less what chance shows; and its 95 % interval,
/// from leans that are shuffled among the blows. Nothing of fewer blows than kMinSymmetryBlows, or from one side.
std::optional<std::array<double, 3>> asymmetry_of(std::span<const BlowAnswer> blows);

/// Joins films, in pixels of the first: x to the right of a camera at 0°, y up from the base at rest, z towards that
/// camera. Returns, for every frame that all have and every ring k from the base to the tip, as motion ringk.x, .y, .z,
/// .r (its radius), .tx and .tz (by how much it rises to its rim towards +x and +z), and what see_from_beside() adds.
/// Errors, naming the film: as check_azimuths(); an odd number of points, another number or rate than the first film's,
/// not usable itself, no time in common with it.
Result<Captured> join_views(std::span<const FilmedView> views);

/// Errors: fewer than two films, not one angle each, a direction that another film has, or its opposite.
Result<void> check_azimuths(std::span<const double> azimuths, std::span<const std::string> names);

}  // namespace wisp
