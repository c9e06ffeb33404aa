#pragma once
// What is known of each frame once it has been looked at, and how that becomes the rows of a recording.

#include <cstdint>
#include <vector>

#include "wisp/capture/vision/outline_capture.hpp"

namespace wisp {

/// What one frame gave.
struct FrameFinding {
  enum class Kind : std::uint8_t { kTracked, kNothing, kLost };
  Kind kind = Kind::kNothing;
  float change = 0;        ///< mean absolute difference from the frame before, in the thing's neighbourhood
  float brightness = 0;    ///< of the thing
  float residual = 0;      ///< root mean square, pixels
  bool elsewhere = false;  ///< kNothing: something as bright and about as large stands elsewhere
};

/// Findings and control points of all frames so far.
struct FrameFindings {
  std::vector<FrameFinding> frames;
  std::vector<double> controls;  ///< 2N a frame, whatever its kind

  std::size_t size() const { return frames.size(); }
};

/// Decides, with all frames known, which are duplicates and fades, fills single gaps, cuts episodes, and writes the
/// recording's channels, flag and episodes and the report's counts.
void assemble_rows(const FrameFindings& findings, int points, Recording& recording, CaptureReport& report);

}  // namespace wisp
