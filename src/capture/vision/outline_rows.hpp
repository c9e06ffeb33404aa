#pragma once
// Findings of each frame, their assembly to the rows of a recording, and the verdict whether the outline is usable,
// with the reason. The verdict is made by two logistic models of the facts (flame or not; outline right or not),
// monotone in every fact, fitted by tools/fit_verdict.py to films and scenes with human labels.

#include <cstdint>
#include <vector>

#include "capture/vision/spline_table.hpp"
#include "wisp/capture/vision/outline_capture.hpp"

namespace wisp {

/// Number of points of the polyline by which an outline is measured and shown.
inline constexpr int kCurvePoints = 64;

/// Maximum duration of a glint, which is not the object, and of an absence that is no extinction; these last 0.13 s.
inline constexpr double kGlintSeconds = 0.2;

struct FrameFinding {
  enum class Kind : std::uint8_t { kTracked, kNothing, kLost };
  Kind kind = Kind::kNothing;
  float change = 0;        ///< mean absolute difference from the frame before, near the object
  float brightness = 0;    ///< brightness of the object
  float residual = 0;      ///< RMS distance of the edge points from the curve, pixels
  bool elsewhere = false;  ///< for kNothing: whether another bright object is in the picture
};

/// Findings and control points of all frames so far.
struct FrameFindings {
  std::vector<FrameFinding> frames;
  std::vector<double> controls;  ///< 2N values per frame, whatever its kind

  std::size_t size() const { return frames.size(); }
};

/// Identifies duplicates and fades among all frames, fills short gaps, cuts episodes, and writes the recording's
/// channels, flags and episodes and the report's counts.
void assemble_rows(const FrameFindings& findings, int points, Recording& recording, CaptureReport& report);

/// Computes the report's facts and `out_at` from the recording's outlines; facts of still pictures (light, contrast,
/// clipped, steadiness) come from the survey. Returns whether there is any outline. Precondition: the recording's first
/// channels are the outline's control points, x and y alternating.
bool gather_facts(const Recording& recording, const SplineTable& table, CaptureReport& report);

/// Computes `likely_flame`, `likely_right`, `usable` and `reason` from the facts. The reason of an unusable outline is
/// film_reason(), if any; else the fact with the largest penalty, if possible one without which the verdict would be
/// "flame" or, for a likely flame, "usable".
void judge_outline(CaptureReport& report);

}  // namespace wisp
