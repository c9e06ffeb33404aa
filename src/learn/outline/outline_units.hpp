#pragma once
// A captured outline in the model's own units, and back.
//
// A capture is in its clip's pixels: origin top left, y down. A model is in its own: origin at the middle of the base
// in every frame, x right, y up, mean height of the calm outline 1. The base's own motion stays a separate channel.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "wisp/base/result.hpp"
#include "wisp/record/recording.hpp"

namespace wisp {

/// What a recording of an outline is made of.
struct OutlineLayout {
  std::size_t points = 0;            ///< control points, at least 4
  std::vector<double> knots;         ///< full, clamped, cubic: points + 4
  std::vector<std::size_t> outputs;  ///< channel indices of p0.x, p0.y, p1.x, …
};

/// The layout of a recording with outputs p0.x, p0.y, p1.x, … and, where its knots are not uniform, an attribute
/// `knots`.
/// Errors, with the recording's name: fewer than four control points, one without its x or y, knots that are not
/// numbers, not as many as the points need, or not a valid knot vector.
Result<OutlineLayout> outline_layout(const Recording& recording);

/// Checks that recordings can be learned from together: as many control points in all of them. Their knots may differ
/// (outline_preparation.hpp brings them together). Returns the first one's layout.
/// Errors: as outline_layout(); another number of points than the first recording has, naming both.
Result<OutlineLayout> common_layout(std::span<const Recording> recordings);

/// The names of an outline's outputs: p0.x, p0.y, p1.x, …
std::vector<std::string> outline_outputs(std::size_t points);

/// Where the model's origin lies in a frame, and how long its unit is.
struct OutlineFrame {
  double base_x = 0;  ///< pixels
  double base_y = 0;
  double pixels_per_unit = 1;  ///< > 0
};

/// Control points x0, y0, x1, y1, … of one frame from pixels to the model's units, and back.
std::vector<double> to_model_units(std::span<const double> pixels, const OutlineFrame& frame);
std::vector<double> to_pixels(std::span<const double> units, const OutlineFrame& frame);

/// The control points x0, y0, x1, … of one row; empty where one is missing.
std::vector<double> whole_row(const Recording& recording, const OutlineLayout& layout, std::size_t row);

/// Whether an outline runs on along its underside until both ends meet (attribute `underside`, 1 or 0); nothing where
/// the recording does not say.
std::optional<bool> follows_underside(const Recording& recording);

/// The distance in pixels from the middle of the base to the tip, of every row in which `rows` is not 0 (empty: all)
/// and no control point is missing.
std::vector<double> heights_pixels(const Recording& recording, const OutlineLayout& layout,
                                   std::span<const std::uint8_t> rows);

/// Their mean; 0 where there is no such row.
double mean_height_pixels(const Recording& recording, const OutlineLayout& layout, std::span<const std::uint8_t> rows);

/// A whole recording in the model's units: its outputs are changed; base.x and base.y (motion, pixels) say where the
/// middle of the base was, as the first and last control point have it; the attribute `pixels_per_unit` is set. All
/// else stays.
///
/// Precondition: layout is the recording's; pixels_per_unit > 0.
Recording to_model_units(const Recording& recording, const OutlineLayout& layout, double pixels_per_unit);

/// Back to pixels: inverts to_model_units() up to rounding.
/// Errors: the recording has no base.x, base.y or `pixels_per_unit`.
Result<Recording> to_pixels(const Recording& recording);

}  // namespace wisp
