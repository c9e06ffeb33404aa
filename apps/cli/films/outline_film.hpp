#pragma once
// Pictures of a model beside its recording: the overlay on the clip, and the film strip.

#include <filesystem>
#include <string>
#include <vector>

#include "terminal.hpp"
#include "wisp/learn/validate.hpp"
#include "wisp/record/recording.hpp"

namespace wisp::cli {

/// Outlines of an overlay, row by row.
struct OverlayContent {
  const OutlineRows& captured;
  const OutlineRows& simulated;
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
                           const OverlayContent& content, Terminal& terminal);

/// Contents of a film strip: moments of the recording above, the same moments of the synthesized play below.
struct StripContent {
  std::vector<std::size_t> rows;   ///< one a column
  double rate_hz = 0;              ///< of both
  const OutlineRows& captured;     ///< all rows, in pixels
  const OutlineRows& synthesized;  ///< likewise
  double pixels_per_unit = 1;
  int clip_width = 0, clip_height = 0;  ///< pixels; 0: not known
  bool flame = true;                    ///< drawn as a flame; else as a plain shape
  std::string synthesized_caption;
};

/// Writes the strip: filmed frames above (drawn from the captured outline where there is no clip), below the
/// synthesized ones in the clip's own crop, colours and exposure. Errors: as write_overlay().
Result<void> write_film_strip(const std::filesystem::path& out, const ClipFrames& clip, const StripContent& content);

}  // namespace wisp::cli
