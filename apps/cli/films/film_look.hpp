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
  FilmLook() = default;

  /// Creates an empty look. Precondition: width, height >= 1 and unit > 0.
  explicit FilmLook(const FilmView& view);

  /// Learns from a frame's view and its captured outline, both in the view's pixels; without an outline learns the look
  /// of the view without a flame. Precondition: the frame has the view's size, an outline at least three points.
  void learn(const Image& frame, std::span<const Point> outline);

  /// Computes what draw() needs, after the last frame.
  void finish();

  /// Returns whether any frame with an outline was learned.
  bool known() const { return frames_ > 0; }

  /// Draws the view with another outline burning in it; empty: none. `light`, 0 to 1, is the share of the flame's light
  /// that falls on the surroundings: at 0 they look as in frames without a flame or, if there were none, at a quarter
  /// of their brightness. Precondition: known() and finish().
  Image draw(std::span<const Point> outline, float light = 1) const;

 private:
  using Sum = std::array<float, 4>;  // weighted sums of red, green and blue codes, and sum of the weights

  float stillness(std::size_t pixel, float height) const;

  FilmView view_{};
  int frames_ = 0;
  std::vector<Sum> flame_;      // by height in the flame and depth inside the outline
  std::vector<Sum> around_;     // per pixel, over frames with the flame elsewhere
  std::vector<Sum> still_;      // per pixel, over frames with an outline: wick and wax
  std::vector<float> squares_;  // per pixel, over frames with an outline: sum of squares of its brightness
  std::vector<Sum> out_;        // per pixel, over frames without a flame

  // Means, computed by finish().
  std::vector<Sum> colours_;
  std::vector<Sum> plate_, foot_, unlit_;  // per pixel: surroundings, wick and wax, and both without the flame's light
  std::vector<float> over_;                // per pixel: stillness(), the opacity of wick and wax over the flame
};

}  // namespace wisp::cli
