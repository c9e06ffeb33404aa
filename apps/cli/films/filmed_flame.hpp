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
  int width = 0, height = 0;  ///< of a picture as recorded, pixels; 0: unknown
};

/// Returns the clip at `path` from which a recording was captured, as the recording describes it.
ClipFrames clip_of(const Recording& recording, std::filesystem::path path);

/// Visits the clip's frames from the first row to `last_row`; `visit` takes the row and a function that returns its
/// image. Errors: the clip cannot be read, or its pictures have another size than recorded; those of `visit`.
Result<void> for_each_row(const ClipFrames& clip, std::size_t last_row,
                          const std::function<Result<void>(std::size_t, const std::function<Image()>&)>& visit);

/// Converts an outline from the clip's pixels to model units, each `pixels_per_unit` long.
Outline in_units(Outline outline, double pixels_per_unit);

/// Space that a view takes about the flame's base, in model units; less where the clip's edge is nearer, but at least
/// `least_beside` and `least_above`.
struct ViewSpace {
  double beside = 1.5, least_beside = 0.5;  ///< to each side
  double above = 2.1, least_above = 1.1;
  double below = 1.4;
};

class FilmedFlame {
 public:
  /// Creates a view, `height` pixels high, on outlines captured from a clip of `clip_size` (width and height in pixels,
  /// 0: unknown). The view follows the flame's base only if the base moves, as with a hand-held camera. Precondition:
  /// height > 0, pixels_per_unit > 0.
  FilmedFlame(const OutlineRows& captured, double pixels_per_unit, std::array<int, 2> clip_size, const ViewSpace& space,
              int height);

  /// Learns the look from frames spread over 1800 rows from about the first outline on (from 24 if the base moves).
  /// Returns the views of the rows `shown` that have an outline; a lost frame is replaced by the next one. Errors: the
  /// clip cannot be read.
  Result<std::map<std::size_t, Image>> watch(const ClipFrames& clip, const OutlineRows& captured,
                                             const std::vector<std::size_t>& shown = {});

  /// Returns whether watch() found frames with an outline.
  bool known() const { return look_.known(); }

  const FilmView& view() const { return view_; }

  /// Draws an outline, in model units, in the look of the clip. `light`: as in FilmLook::draw(). Precondition: known().
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

/// Returns the flame of the film that a recording names as its source, after watch(), in a view of `height` pixels.
/// Errors: the recording names no film or has no outline; the film cannot be read; none of its frames has an outline.
Result<FilmedFlame> filmed_flame(const Recording& recording, int height);

}  // namespace wisp::cli
