#pragma once
// A clip's view of its flame: cut from its frames, and drawn in their look with another outline.

#include <filesystem>
#include <functional>
#include <map>
#include <span>
#include <vector>

#include "films/film_look.hpp"
#include "wisp/learn/validate.hpp"
#include "wisp/record/recording.hpp"

namespace wisp::cli {

/// An outline in the clip's pixels, or in model units: origin at the middle of its base, y up.
using Outline = std::vector<std::array<double, 2>>;

/// The clip that a recording was captured from; its frames from `first_frame` (0-based) on are the rows.
struct ClipFrames {
  std::filesystem::path path;  ///< empty: no clip, pictures are black
  double rate_hz = 0;          ///< frame rate of a folder of images; 0 for films
  std::size_t first_frame = 0;
};

/// The value of an attribute that is one number, such as the clip's width; 0 where it is not recorded.
int number_attribute(const Recording& recording, const char* name);

/// The clip's frame of the first row, 0-based.
std::size_t first_frame_of(const Recording& recording);

/// Visits the clip's frames that have a row in the recording, up to `last_row`.
/// Errors: the clip cannot be read; those of `visit`.
Result<void> for_each_row(const ClipFrames& clip, std::size_t last_row,
                          const std::function<Result<void>(std::size_t, const std::function<Image()>&)>& visit);

/// The outline in model units, of that many pixels.
Outline in_units(Outline outline, double pixels_per_unit);

/// Space that a view takes about the flame's base, in model units; less where the clip ends before, but not less than
/// the flame needs.
struct ViewSpace {
  double beside = 1.5, least_beside = 0.5;  ///< to each side
  double above = 2.1, least_above = 1.1;
  double below = 1.4;
};

class FilmedFlame {
 public:
  /// A view of `height` pixels on outlines captured from a clip of `width_of_clip` × `height_of_clip` pixels (0:
  /// unknown). It follows the base only where that moves, as with a camera in the hand.
  ///
  /// Precondition: height > 0, pixels_per_unit > 0.
  FilmedFlame(const OutlineRows& captured, double pixels_per_unit, std::array<int, 2> clip_size, const ViewSpace& space,
              int height);

  /// Learns the look from frames spread over the clip's first minute, and returns the views of the rows shown. A row
  /// whose frame was lost takes the next frame. Errors: the clip cannot be read.
  Result<std::map<std::size_t, Image>> watch(const ClipFrames& clip, const OutlineRows& captured,
                                             const std::vector<std::size_t>& shown = {});

  /// Whether watch() found frames with an outline.
  bool known() const { return look_.known(); }

  const FilmView& view() const { return view_; }

  /// Draws an outline, in model units, in the look of the clip, lit by `light` of its flame, 0 to 1.
  ///
  /// Precondition: known().
  Image draw(std::span<const Point> outline, float light = 1) const;

 private:
  std::array<double, 2> base_in(const Outline& outline) const;
  std::vector<Point> in_view(const Outline& outline) const;
  Image cut(const Outline& outline, const Image& frame) const;

  double unit_;
  std::array<double, 2> middle_{};  // the median base
  bool stands_ = true;
  double left_ = 0, right_ = 0, above_ = 0, below_ = 0;  // space of the view about the base, the clip's pixels
  FilmView view_;
  FilmLook look_;
};

/// The flame of the film that a recording names as its source, watched. Errors: the film cannot be read, or none of its
/// frames has an outline.
Result<FilmedFlame> filmed_flame(const Recording& recording, int height);

}  // namespace wisp::cli
