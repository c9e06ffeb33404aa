#pragma once
// Whether an outline is a flame's that can be learned from, and if not, why: two logistic models of the facts, each
// monotone in every fact, fitted by tools/fit_verdict.py on films and scenes that people would or would not call right.

#include "capture/vision/spline_table.hpp"
#include "wisp/capture/vision/outline_capture.hpp"

namespace wisp {

/// Fills the report's facts and `out_at` from the recording's outlines; those of a still picture (light, contrast,
/// clipped, steadiness) come from the survey. Returns whether there is any outline.
///
/// Precondition: the recording's first channels are the outline's control points, x and y alternating.
bool gather_facts(const Recording& recording, const SplineTable& table, CaptureReport& report);

/// Fills `likely_flame`, `likely_right`, `usable` and `reason` from the facts. The reason is the fact that weighs most
/// and without which the verdict would be yes; that there is no flame is asked first.
void judge_outline(CaptureReport& report);

}  // namespace wisp
