#pragma once
// Conversion of a captured outline to the model's units, and back.
//
// Captures are in pixels of the clip: origin top left, y down. Model units: origin at the middle of the base in every
// frame, x right, y up, height of the calm outline 1. The base's motion is a separate channel.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "wisp/base/result.hpp"
#include "wisp/record/recording.hpp"

namespace wisp {

struct OutlineLayout {
  std::size_t points = 0;            ///< number of control points, at least 4
  std::vector<double> knots;         ///< full clamped cubic knot vector, points + 4 values
  std::vector<std::size_t> outputs;  ///< channel indices of p0.x, p0.y, p1.x, …
};

/// Layout of a recording with outputs p0.x, p0.y, p1.x, … and, for non-uniform knots, an attribute `knots`.
/// Errors, naming the recording: fewer than four control points, a point without its x or y, knots that are not
/// numbers, are not points + 4, or are not a valid knot vector.
Result<OutlineLayout> outline_layout(const Recording& recording);

/// Checks that recordings have equal numbers of control points, so that they can be learned together. Their knots may
/// differ (outline_preparation.hpp converts them). Returns the first one's layout.
/// Errors: as outline_layout(); a number of points other than the first recording's, naming both.
Result<OutlineLayout> common_layout(std::span<const Recording> recordings);

/// Names of an outline's outputs: p0.x, p0.y, p1.x, …
std::vector<std::string> outline_outputs(std::size_t points);

std::vector<std::string> input_names(const Recording& recording);

/// Samples of the channel of that name. Precondition: the recording has it.
const std::vector<double>& samples_of(const Recording& recording, const std::string& name);

/// Origin and unit of the model's frame, in pixels.
struct OutlineFrame {
  double base_x = 0;  ///< pixels
  double base_y = 0;
  double pixels_per_unit = 1;  ///< > 0
};

/// Converts control points x0, y0, x1, y1, … of one frame from pixels to the model's units, and back.
std::vector<double> to_model_units(std::span<const double> pixels, const OutlineFrame& frame);
std::vector<double> to_pixels(std::span<const double> units, const OutlineFrame& frame);

/// Control points x0, y0, x1, … of one row; empty where one is missing.
std::vector<double> whole_row(const Recording& recording, const OutlineLayout& layout, std::size_t row);

/// Whether an outline continues along its underside until both ends meet (attribute `underside`, 1 or 0); empty where
/// the recording does not say.
std::optional<bool> follows_underside(const Recording& recording);

/// Pixels from the middle of the base to the tip, for every complete row in which `rows` is not 0 (empty: all rows).
std::vector<double> heights_pixels(const Recording& recording, const OutlineLayout& layout,
                                   std::span<const std::uint8_t> rows);

/// Converts a whole recording to the model's units: changes its outputs, adds base.x and base.y (motion, pixels), the
/// middle between the first and last control point, and sets the attribute `pixels_per_unit`. Other channels stay
/// unchanged. Precondition: layout is the recording's; pixels_per_unit > 0.
Recording to_model_units(const Recording& recording, const OutlineLayout& layout, double pixels_per_unit);

/// Inverts to_model_units() up to rounding. Errors: the recording has no base.x, base.y or `pixels_per_unit`.
Result<Recording> to_pixels(const Recording& recording);

}  // namespace wisp
