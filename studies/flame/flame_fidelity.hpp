#pragma once
// What a classifier is given: windows of outlines as an eye has them.

#include <ostream>
#include <string>
#include <vector>

#include "wisp/record/recording.hpp"

namespace wisp::verify {

/// A recording of control points as 8 points at equal steps along the curve: what an eye sees, and not where along it
/// the control points lie.
///
/// Precondition: it is an outline with as many control points as the knots are for.
Recording as_seen(const Recording& recording, const std::vector<double>& knots);

/// Writes the feature windows of half a second of an outline as seen, at most 500: one line each, side, clip, block,
/// the points and their differences.
void write_windows(std::ostream& out, const std::string& side, std::size_t clip, const Recording& seen);

}  // namespace wisp::verify
