#pragma once
// What a film is like, whatever is in it: cuts, a moving camera, light. All on a coarse grid of luma.
//
// Where a flame goes out its scene darkens, and little becomes brighter: a lamp that stood beside it stays, and what
// puts it out is small. Where a film is cut to another scene, its light is where none was before.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "wisp/capture/vision/outline_capture.hpp"

namespace wisp {

/// How far b is a moved along, as a share of its length, in whole steps; 0 where no move explains most of what differs.
double step_between(const std::vector<double>& a, const std::vector<double>& b);

class FilmLook {
 public:
  /// Takes in the next picture of the film; all have one size.
  void look(const Picture& picture);

  FilmFacts facts() const;  ///< of the pictures so far

  /// Takes in a picture that shows the thing.
  void remember(const Picture& picture);

  /// Whether no picture that shows the thing was taken in.
  bool empty() const { return brightest_.empty(); }

  /// Whether most of the light in a picture is where there was none in those that show the thing.
  bool another(const Picture& picture);

 private:
  void sample(const Picture& picture);

  std::vector<std::uint8_t> now_;        // luma of a coarse grid
  std::vector<std::uint8_t> brightest_;  // … of what shows the thing, at its brightest so far
  std::size_t columns_ = 0;
  std::vector<double> blocks_, across_, down_;  // means of the last picture's blocks, columns and rows
  std::vector<double> changes_;                 // how unlike a picture is to the one before: 1 less their correlation
  double brightest_point_ = 0;
  std::vector<double> flat_;  // share of each picture that is as bright as a camera shows anything
  double moved_ = 0;          // sum of steps, shares of the picture
};

/// Why no flame can be told in a film, whatever is in it: too short, too dark, moved, too bright.
std::optional<std::string> film_reason(const FilmFacts& film);

}  // namespace wisp
