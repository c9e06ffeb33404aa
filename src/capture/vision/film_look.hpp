#pragma once
// Properties of a film independent of its subject (cuts, camera motion, light), computed from a coarse grid of luma.
//
// When a flame goes out, the scene darkens and little becomes brighter: lamps beside the flame stay lit, and the object
// that extinguishes it is small. After a cut, light appears where none was before.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "wisp/capture/vision/outline_capture.hpp"

namespace wisp {

/// Returns the shift from a to b, at most 8 elements, over their length; 0 if no shift removes 30 % of the difference.
double step_between(const std::vector<double>& a, const std::vector<double>& b);

class FilmLook {
 public:
  /// Takes in the next picture of the film; all pictures have one size.
  void look(const Picture& picture);
  void lost() { ++rows_; }  ///< a frame was lost here

  FilmFacts facts() const;  ///< properties of the pictures so far

  /// Takes in the light of a picture in which the object was found.
  void remember(const Picture& picture);

  /// Returns whether no picture with the object was taken in.
  bool empty() const { return brightest_.empty(); }

  /// Returns whether over 40 % of the light in `within` exceeds the maximum over the pictures with the object.
  bool another(const Picture& picture, const Region& within);

 private:
  void sample(const Picture& picture);

  std::vector<std::uint8_t> now_;        // luma of the last picture sampled, on a coarse grid
  std::vector<std::uint8_t> brightest_;  // maximum luma of each grid point over the pictures with the object
  std::size_t columns_ = 0;
  int step_ = 1;                                // pixels between the grid's points
  std::vector<double> blocks_, across_, down_;  // means of the last picture's blocks, columns, rows
  std::vector<double> changes_;                 // dissimilarity of each picture to the one before: 1 − correlation
  std::vector<std::size_t> change_rows_;        // row of each entry of changes_
  std::size_t rows_ = 0;                        // number of rows so far
  double brightest_point_ = 0;
  std::vector<double> flat_;  // share of saturated points in each picture
  double moved_ = 0;          // sum of shifts, as shares of the picture
};

/// Returns why no flame can be identified in a film (too short, dark, unsteady or bright); none if it is suitable.
std::optional<std::string> film_reason(const FilmFacts& film);

}  // namespace wisp
