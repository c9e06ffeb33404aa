#pragma once
// A film strip: rows of frames under each other, with captions and times, as L.-M. Reissell and D. K. Pai show their
// flames (Modeling Stochastic Dynamical Systems for Interactive Simulation, 2001, figures 1 and 2).

#include <string>
#include <vector>

#include "wisp/draw/image.hpp"

namespace wisp {

/// One row of a strip.
struct FilmRow {
  std::string caption{};        ///< UTF-8, drawn above the row; empty: none
  std::vector<Image> frames{};  ///< left to right; an empty image leaves its place dark
};

/// What a strip shows. All frames are scaled into cells of one size, the proportions of the first frame.
struct FilmStrip {
  std::string title{};  ///< above everything; empty: none
  std::vector<FilmRow> rows{};
  std::vector<std::string> times{};  ///< under the columns, such as "0.25 s"; fewer than columns: the rest are bare
  int frame_height = 200;            ///< pixels of a cell, 16 … 2000
  int gap = 4;                       ///< pixels between frames, 0 … 100
};

/// Draws the strip. Its size follows from the frames.
/// Errors: no rows, no frames, or a strip larger than kLargestImageSide.
Result<Image> draw_film_strip(const FilmStrip& strip);

}  // namespace wisp
