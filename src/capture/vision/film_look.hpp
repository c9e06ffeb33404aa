#pragma once
// Properties of a film independent of its subject: cuts, camera motion, light. All from a coarse grid of luma.
//
// Where a flame goes out its scene darkens and little becomes brighter: lamps beside it stay, and the object that
// extinguishes it is small. After a cut, light appears where none was before.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "wisp/capture/vision/outline_capture.hpp"

namespace wisp {

/// Level of 255 from which a point counts as saturated.
inline constexpr int kSaturated = 250;

/// Shift from a to b as a share of the length, in whole steps, at most 8; 0 where none removes 30 % of the difference.
double step_between(const std::vector<double>& a, const std::vector<double>& b);

class FilmLook {
 public:
  /// Takes in the next picture of the film; all have one size.
  void look(const Picture& picture);
  void lost() { ++rows_; }  ///< a frame was lost here

  FilmFacts facts() const;  ///< facts of the pictures so far

  /// Takes in a picture in which the object was found.
  void remember(const Picture& picture);

  /// Whether no picture with the object was taken in.
  bool empty() const { return brightest_.empty(); }

  /// Whether over 40 % of the light in a part of a picture is where the pictures with the object had none.
  bool another(const Picture& picture, const Region& within);

 private:
  void sample(const Picture& picture);

  std::vector<std::uint8_t> now_;        // luma of a coarse grid
  std::vector<std::uint8_t> brightest_;  // … its maximum over the pictures with the object
  std::size_t columns_ = 0;
  int step_ = 1;                                // pixels between the grid's points
  std::vector<double> blocks_, across_, down_;  // means of the last picture's blocks, columns and rows
  std::vector<double> changes_;                 // dissimilarity of each picture to the one before: 1 − correlation
  std::vector<std::size_t> change_rows_;        // row of each of these
  std::size_t rows_ = 0;                        // number of rows so far
  double brightest_point_ = 0;
  std::vector<double> flat_;  // share of saturated points in each picture
  double moved_ = 0;          // sum of shifts, as shares of the picture
};

/// Reason why no flame can be identified in a film, whatever its subject: too short, dark, unsteady or bright.
std::optional<std::string> film_reason(const FilmFacts& film);

}  // namespace wisp
