#pragma once
// Whether an outline is a flame's that can be learned from, and if not, why.

#include "capture/vision/spline_table.hpp"
#include "wisp/capture/vision/outline_capture.hpp"

namespace wisp {

// Of what is less, or wider, it is known at first sight that it is not usable as a flame.
inline constexpr double kMinNarrowing = 0.25;
inline constexpr double kMinLight = 0.85;
inline constexpr double kMinContrast = 20;  ///< levels of 255: flames in films have 40, a wall's bright middle 6
inline constexpr double kMaxWidth = 0.8;    ///< heights: flames in films have 0.6 at most

/// Fills the report's facts (light and solidity come from the survey), `out_at`, `usable` and `reason` from the
/// recording's outlines and the report's dropped frames. What only flames do (taper, give light) is checked where
/// `report.flames` is not 0.
///
/// Precondition: the recording's first channels are the outline's control points, x and y alternating.
void judge_outline(const Recording& recording, const SplineTable& table, CaptureReport& report);

}  // namespace wisp
