#pragma once
// The look of a clip: colours by position relative to the outline, and the surroundings. Another outline drawn with it
// looks as if the same camera had filmed it, with the clip's own wax, room and exposure.

#include <array>
#include <span>
#include <vector>

#include "wisp/draw/image.hpp"

namespace wisp::cli {

/// A view of the clip around the flame's base, in pixels.
struct FilmView {
  int width = 0;
  int height = 0;
  float unit = 1;  ///< mean flame height in pixels
  Point base{};    ///< middle of the flame's base
};

class FilmLook {
 public:
  /// Precondition: width, height >= 1 and unit > 0.
  explicit FilmLook(const FilmView& view);

  /// Learns from a frame's view and its captured outline, both in the view's pixels.
  ///
  /// Precondition: the frame has the view's size, and the outline at least three points.
  void learn(const Image& frame, std::span<const Point> outline);

  /// Whether any frame was learned.
  bool known() const { return frames_ > 0; }

  /// Draws the view with another outline burning in it.
  ///
  /// Precondition: known().
  Image draw(std::span<const Point> outline) const;

 private:
  using Sum = std::array<float, 4>;  // sums of red, green and blue codes, and their count

  float stillness(std::size_t pixel, float height) const;

  std::vector<Sum> flame_colours() const;
  std::vector<Sum> surroundings() const;

  FilmView view_;
  int frames_ = 0;
  std::vector<Sum> flame_;      // by height in the flame and depth inside its outline
  std::vector<Sum> around_;     // per pixel, over frames with the flame elsewhere
  std::vector<Sum> still_;      // per pixel, over all frames: wick and wax
  std::vector<float> squares_;  // per pixel, over all frames: squared sum of its codes
};

}  // namespace wisp::cli
