#pragma once
// Pictures that hold a model against its recording: the overlay on the clip, and the film strip.

#include <filesystem>
#include <string>
#include <vector>

#include "terminal.hpp"
#include "wisp/draw/image.hpp"
#include "wisp/learn/outline_units.hpp"
#include "wisp/model/model.hpp"
#include "wisp/record/recording.hpp"

namespace wisp::cli {

/// Outlines of one recording, row by row, in the clip's pixels. An empty polyline is a row without one.
struct OutlineRows {
  std::vector<std::vector<Point>> captured;
  std::vector<std::vector<Point>> simulated;
  std::string simulated_label;  ///< "simulated from the wind", "predicted 5 frames ahead"
};

/// The clip that a recording was captured from: its frames are row after row from `first_frame` (0-based).
struct ClipFrames {
  std::filesystem::path path;  ///< empty: there is no clip, pictures are black
  double rate_hz = 0;          ///< for a folder of images; 0 otherwise
  std::size_t first_frame = 0;
};

/// Writes the clip with captured and simulated outlines drawn over it.
/// Errors: the clip or the film cannot be read or written.
Result<void> write_overlay(const std::filesystem::path& out, const ClipFrames& clip, const Recording& recording,
                           const OutlineRows& rows, Terminal& terminal);

/// What a film strip shows: columns of a recording above, the same moments of a synthesized life below.
struct StripContent {
  std::vector<std::size_t> rows;           ///< of the recording, one a column
  const Recording* recording = nullptr;    ///< in pixels
  const Recording* synthesized = nullptr;  ///< in pixels, the same rows
  OutlineLayout layout;                    ///< of the recording
  OutlineLayout synthesized_layout;        ///< of the synthesized life
  double pixels_per_unit = 1;
  std::string synthesized_caption;
};

/// Writes the strip: filmed frames above (drawn from the captured outline where there is no clip), synthesized below.
/// Errors: as write_overlay().
Result<void> write_film_strip(const std::filesystem::path& out, const ClipFrames& clip, const StripContent& content);

}  // namespace wisp::cli
