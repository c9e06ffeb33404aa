#pragma once
// The edge points of one outline in their order: from the base's left over the tip to the base's right, each with its
// place along the way.
//
// The base is where the outline is open: a little above the lowest point, or the picture's edge where that cuts the
// thing off. The place s of an edge point is its share of the arc length, counted apart on the two sides of the tip, so
// that the tip has the same s in every frame and what slides along a growing flame is as little as can be.

#include <span>
#include <vector>

#include "wisp/capture/vision/edges.hpp"

namespace wisp {

/// The side on which an outline is open and held.
enum class BaseSide { kBottom, kLeft, kTop, kRight };

/// How a boundary becomes a cloud.
struct EdgeCloudOptions {
  BaseSide base = BaseSide::kBottom;
  double base_share = 0.03;  ///< the base lies this share of the height above the lowest point; 0 to 0.2: a round or
                             ///< ragged underside says little about the flame, and its lowest pixel jumps about
  int most_points = 320;     ///< edge points at most; a longer boundary is taken in even strides: 40 to a control point
                             ///< of 8 are far more than needed, and cost follows them
  double tip_s = 0.5;        ///< where along the curve the tip lies, 0.1 to 0.9
};

/// An outline's edge points.
struct EdgeCloud {
  std::vector<EdgePoint> points;  ///< base's left, over the tip, to base's right; first and last are the base's ends
  std::vector<double> s;          ///< of each point, 0 to 1, ascending
  double tip_share = 0.5;         ///< the left side's share of the whole arc length
  double height = 0;              ///< from the base's middle to the tip, pixels
  bool base_cut = false;          ///< the picture's edge cuts the base off

  double base_x() const { return 0.5 * (points.front().x + points.back().x); }
  double base_y() const { return 0.5 * (points.front().y + points.back().y); }
};

/// The part of a picture that a boundary was followed in.
struct BoundaryWindow {
  ImageView image;  ///< the window's pixels
  Region place;     ///< where the window lies in the picture
  Region area;      ///< all of the picture that may be looked at: beyond its border nothing can be seen
  int level = 0;    ///< brighter than this is inside
};

/// Makes the cloud of a boundary, clockwise as follow_boundary gives it and in the window's pixels, into `cloud`, in
/// the picture's pixels; the cloud's memory is used again. Returns whether it could: a boundary of a few pixels has no
/// sides.
///
/// Precondition: every boundary pixel lies inside the window and is brighter than the level.
bool make_edge_cloud(const BoundaryWindow& window, std::span<const PixelPosition> boundary,
                     const EdgeCloudOptions& options, EdgeCloud& cloud);

}  // namespace wisp
