#pragma once
// Pictures with opacity in their order, as files that engines and browsers play: an atlas, or an animated picture.

#include <filesystem>
#include <span>
#include <vector>

#include "wisp/base/result.hpp"
#include "wisp/draw/image.hpp"

namespace wisp {

/// Frames of one size.
struct Flipbook {
  std::vector<Image> frames{};
  double rate_hz = 30;
  bool loop = false;  ///< the first frame follows the last one
  Point pivot{};      ///< what stands still, in pixels of a frame: a flame's base
};

/// A picture of light on black as light on nothing: its opacity is its brightest channel, so that over black it is what
/// it was.
void make_light(Image& image);

/// Writes all frames side by side in one PNG of premultiplied RGBA, and where they are beside it in
/// NAME.atlas.json (the list form that sprite packers write, with rate, loop and pivot).
/// Errors: no frames, frames of several sizes, an atlas larger than 16384 pixels, or the disk.
Result<void> write_atlas(const std::filesystem::path& path, const Flipbook& book);

/// Writes an animated picture with straight opacity: APNG (.apng) or WebM with VP9 (.webm), by the name.
/// Errors: as write_atlas(); another name; an encoder that this FFmpeg does not have.
Result<void> write_animation(const std::filesystem::path& path, const Flipbook& book);

}  // namespace wisp
