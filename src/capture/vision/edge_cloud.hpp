#pragma once
// Edge points: Sobel gradients along a region's boundary, located to a fraction of a pixel (section 3.1 of the paper;
// the direction from the picture itself, the place where brightness along it crosses the level, which a thresholded
// picture gives only to half a pixel). And the edge points of one outline in their order: from the base's left over the
// tip to the base's right, each with its place along the way.
//
// The base is where the outline is open. Its two corners are the boundary's outermost points towards lower left and
// lower right, seen along the axis of the thing's lower part: on a flat base its corners, on a round one two points
// beside the lowest, on a forked one the two feet. (The lowest pixel of a flame jumps about; these do not.) The curve
// runs from corner to corner, or, where the underside is worth following (a flame forked by its wick), on along the
// underside until both ends meet in its middle.
//
// The place s of an edge point is its share of the arc length, counted apart between landmarks (the base's corners, the
// tip), so that these have the same s in every frame and what slides along a growing flame is as little as can be.

#include <array>
#include <span>
#include <vector>

#include "capture/vision/region.hpp"
#include "wisp/capture/vision/image.hpp"

namespace wisp {

/// A point on the outline.
struct EdgePoint {
  double x = 0;  ///< pixels, pixel centres at whole numbers
  double y = 0;
  double normal_x = 0;  ///< unit, pointing out of the bright region
  double normal_y = 0;
};

/// Locates the edge at one boundary pixel.
///
/// Precondition: pixel lies inside the image and is brighter than `level`.
EdgePoint locate_edge(const ImageView& image, int level, PixelPosition pixel);

/// Steps of a pace that is fitted.
inline constexpr int kPaceSteps = 64;

/// How a boundary becomes a cloud.
struct EdgeCloudOptions {
  BaseSide base = BaseSide::kBottom;
  bool underside = false;  ///< follow the underside too
  int max_points = 320;    ///< edge points at most; a longer boundary is taken in even strides: 40 to a control point
                           ///< of 8 are far more than needed, and cost follows them
  /// Where along the cloud the landmarks lie: left corner, tip, right corner; ascending. The corners are 0 and 1 where
  /// the underside is not followed.
  std::array<double, 3> landmarks{0, 0.5, 1};
  /// The curve's parameter at evenly spread places of the cloud: ascending from 0 to 1, at least two values. A curve of
  /// few control points that turns a sharp corner must slow down there.
  std::vector<double> pace{0, 1};
};

/// The pace of a curve that is run through evenly.
std::vector<double> even_pace();

/// The parameter that a pace gives for a place of the cloud, 0 to 1.
double at_pace(std::span<const double> pace, double place);

/// An outline's edge points.
struct EdgeCloud {
  std::vector<EdgePoint> points;  ///< base's left, over the tip, to base's right; first and last are the base's ends
  std::vector<double> s;          ///< the curve's parameter where each point belongs, 0 to 1, ascending
  std::array<double, 3> shares{0, 0.5, 1};  ///< of the whole arc length up to each landmark
  double height = 0;                        ///< from the base's middle to the tip, pixels
  double base_x = 0;                        ///< the middle between the base's corners
  double base_y = 0;
  double area = 0;               ///< inside the edge points, closed by a straight line, square pixels
  std::vector<double> way;       ///< arc length up to each point, pixels
  std::size_t left_corner = 0;   ///< point at the base's left corner
  std::size_t right_corner = 0;  ///< … and at its right one
  double left_out = 0;           ///< area between that line and the underside; 0 where that is followed
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

/// Sets `s` anew for other landmarks or another pace; the cloud must have been made with the same `underside`.
void place_points(EdgeCloud& cloud, const EdgeCloudOptions& options);

}  // namespace wisp
