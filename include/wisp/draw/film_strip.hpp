#pragma once
// A film strip: rows of frames under each other, with captions and times, as L.-M. Reissell and D. K. Pai show their
// flames (Modeling Stochastic Dynamical Systems for Interactive Simulation, 2001, figures 1 and 2). And flipbooks:
// pictures with opacity in their order, as files that engines and browsers play.

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "wisp/base/result.hpp"
#include "wisp/draw/image.hpp"

namespace wisp {

/// One row of a strip.
struct FilmRow {
  std::string caption{};        ///< UTF-8, drawn above the row; empty: none
  std::vector<Image> frames{};  ///< left to right; an empty image leaves its place dark
};

/// What a strip shows. All frames are scaled into cells of one size, the proportions of the first frame.
struct FilmStrip {
  std::vector<FilmRow> rows{};
  std::vector<std::string> times{};  ///< under the columns, such as "0.25 s"; fewer than columns: the rest are bare
  int frame_height = 200;            ///< pixels of a cell, 16 … 2000
};

/// Draws the strip. Its size follows from the frames.
/// Errors: no rows, no frames, or a strip larger than kLargestImageSide.
Result<Image> draw_film_strip(const FilmStrip& strip);

/// Frames of one size.
struct Flipbook {
  std::vector<Image> frames{};
  double rate_hz = 30;
  bool loop = false;  ///< the first frame follows the last one
  int columns = 0;    ///< of an atlas; 0: as near to a square as whole frames make it
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
