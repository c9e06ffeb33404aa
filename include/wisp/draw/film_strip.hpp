#pragma once
// Film strips: rows of frames under each other, with captions and times, as in L.-M. Reissell and D. K. Pai (Modeling
// Stochastic Dynamical Systems for Interactive Simulation, 2001, figures 1 and 2). Also flipbooks: image sequences with
// opacity, as files for engines and browsers.

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "wisp/base/result.hpp"
#include "wisp/draw/image.hpp"

namespace wisp {

/// One row of a strip.
struct FilmRow {
  std::string caption{};        ///< UTF-8, drawn above the row; empty: none
  std::vector<Image> frames{};  ///< left to right; an empty image leaves its cell dark
};

/// Content of a strip. Frames are scaled into cells of equal size, with the proportions of the first frame.
struct FilmStrip {
  std::vector<FilmRow> rows{};
  std::vector<std::string> times{};  ///< column labels such as "0.25 s"; columns beyond the last have none
  int frame_height = 200;            ///< cell height, pixels, 16 … 2000
};

/// Draws the strip. Its size follows from the frames.
/// Errors: no rows, no frames, or a strip larger than kLargestImageSide.
Result<Image> draw_film_strip(const FilmStrip& strip);

/// Frames of equal size, with their rate.
struct Flipbook {
  std::vector<Image> frames{};
  double rate_hz = 30;  ///< 0.1 … 1000
  bool loop = false;    ///< the first frame follows the last one
  int columns = 0;      ///< columns of an atlas; 0: as close to square as whole frames allow
  Point pivot{};        ///< fixed point of the motion, pixels of a frame: a flame's base
};

/// Converts a picture of light on black to light on transparency: its opacity is its brightest channel, so that over
/// black it looks unchanged.
void make_light(Image& image);

/// Writes all frames as a grid in one PNG of premultiplied RGBA, and their positions in NAME.atlas.json beside it (the
/// list form of sprite packers, with rate, loop and pivot).
/// Errors: no frames, frames of several sizes, a rate out of range, a side above 16384 pixels, or the disk.
Result<void> write_atlas(const std::filesystem::path& path, const Flipbook& book);

/// Writes an animated picture with straight opacity: APNG (.apng) or WebM with VP9 (.webm), by the extension.
/// Errors: no frames, frames of several sizes, another extension, and those of VideoWriter.
Result<void> write_animation(const std::filesystem::path& path, const Flipbook& book);

/// As above, but of `count` frames that `frame` draws one after the other, in the place of book.frames.
Result<void> write_animation(const std::filesystem::path& path, const Flipbook& book, std::size_t count,
                             const std::function<Image(std::size_t)>& frame);

}  // namespace wisp
