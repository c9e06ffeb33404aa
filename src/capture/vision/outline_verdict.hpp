#pragma once
// Whether an outline is a flame's that can be learned from, and if not, why.

#include "capture/vision/spline_table.hpp"
#include "wisp/capture/vision/outline_capture.hpp"

namespace wisp {

/// Fills the report's facts (light and solidity come from the survey), `out_at`, `usable` and `reason` from the
/// recording's outlines and the report's dropped frames. What only flames do (taper, give light) is requested where
/// `report.flames` is not 0.
///
/// Precondition: the recording's first channels are the outline's control points, x and y alternating.
void judge_outline(const Recording& recording, const SplineTable& table, CaptureReport& report);

}  // namespace wisp
