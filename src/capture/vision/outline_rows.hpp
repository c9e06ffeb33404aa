#pragma once
// Findings of each frame, and their assembly to the rows of a recording.

#include <cstdint>
#include <vector>

#include "wisp/capture/vision/outline_capture.hpp"

namespace wisp {

/// Findings in one frame.
struct FrameFinding {
  enum class Kind : std::uint8_t { kTracked, kNothing, kLost };
  Kind kind = Kind::kNothing;
  float change = 0;        ///< mean absolute difference from the last frame, near the object
  float brightness = 0;    ///< brightness of the object
  float residual = 0;      ///< RMS, pixels
  bool elsewhere = false;  ///< kNothing: whether an object of similar brightness and size is elsewhere
};

/// Findings and control points of all frames so far.
struct FrameFindings {
  std::vector<FrameFinding> frames;
  std::vector<double> controls;  ///< 2N values per frame, whatever its kind

  std::size_t size() const { return frames.size(); }
};

/// With all frames known, identifies duplicates and fades, fills single gaps, cuts episodes, and writes the recording's
/// channels, flag and episodes and the report's counts.
void assemble_rows(const FrameFindings& findings, int points, Recording& recording, CaptureReport& report);

}  // namespace wisp
