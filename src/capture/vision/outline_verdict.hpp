#pragma once
// Verdict whether an outline is a usable flame's, and if not, why: two logistic models of the facts, monotone in every
// fact, fitted by tools/fit_verdict.py to films and scenes with human labels.

#include "capture/vision/spline_table.hpp"
#include "wisp/capture/vision/outline_capture.hpp"

namespace wisp {

/// Computes the report's facts and `out_at` from the recording's outlines; facts of still pictures (light, contrast,
/// clipped, steadiness) come from the survey. Returns whether there is any outline.
///
/// Precondition: the recording's first channels are the outline's control points, x and y alternating.
bool gather_facts(const Recording& recording, const SplineTable& table, CaptureReport& report);

/// Computes `likely_flame`, `likely_right`, `usable` and `reason` from the facts. The reason is the heaviest fact
/// without which the verdict would be yes; absence of a flame is tested first.
void judge_outline(CaptureReport& report);

}  // namespace wisp
