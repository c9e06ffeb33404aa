#pragma once
// Pictures of a model beside its recording: overlay on the clip, and film strip.

#include <filesystem>
#include <string>
#include <vector>

#include "films/filmed_flame.hpp"
#include "terminal.hpp"
#include "wisp/learn/validate.hpp"
#include "wisp/record/recording.hpp"

namespace wisp::cli {

struct OverlayContent {
  const OutlineRows& captured;
  const OutlineRows& simulated;
  std::string simulated_label;  ///< for example "predicted 5 frames ahead"
};

/// Writes the clip with captured and simulated outlines drawn over it.
/// Errors: the recording lacks its picture's width or height; the clip cannot be read; the film cannot be written.
Result<void> write_overlay(const std::filesystem::path& out, const ClipFrames& clip, const Recording& recording,
                           const OverlayContent& content, Terminal& terminal);

/// Contents of a film strip: frames of the recording above, synthesized frames at the same times below.
struct StripContent {
  std::vector<std::size_t> rows;   ///< one per column
  double rate_hz = 0;              ///< rows per second of `captured` and `synthesized`
  const OutlineRows& captured;     ///< all rows, in pixels
  const OutlineRows& synthesized;  ///< all rows, in pixels
  double pixels_per_unit = 1;
  bool flame = true;  ///< draw a flame; false: a plain shape
  std::string synthesized_caption;
};

/// Writes the strip: filmed frames above (drawn from the captured outline without a clip), synthesized frames below in
/// the clip's own crop, colours and exposure. Errors: the clip cannot be read; the strip cannot be drawn or written.
Result<void> write_film_strip(const std::filesystem::path& out, const ClipFrames& clip, const StripContent& content);

}  // namespace wisp::cli
