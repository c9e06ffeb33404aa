#pragma once
// Edge points along a region's boundary with sub-pixel accuracy (section 3.1 of the paper): each lies where the
// brightness along the picture's Sobel gradient crosses the level. Thresholding alone would locate edges to half a
// pixel only. The edge points of an outline are ordered from the base's left over the tip to the base's right, each
// with its position along the path.
//
// The outline is open at the base. Its two corners are the boundary's extreme points towards lower left and lower
// right, relative to the axis of the object's lower part: the corners of a flat base, two points beside the lowest of a
// round base, the two feet of a forked one. (The lowest pixel of a flame jumps; these points do not.) The curve runs
// from corner to corner or, where the underside is followed (a flame forked by its wick), along the underside until
// both ends meet in its middle.
//
// The parameter s of an edge point is its share of the arc length, normalised separately between landmarks (base
// corners and tip). So landmarks have equal s in every frame, which minimises sliding along a growing flame.

#include <array>
#include <span>
#include <vector>

#include "capture/vision/region.hpp"
#include "wisp/capture/vision/image.hpp"

namespace wisp {

struct EdgePoint {
  double x = 0;  ///< pixels; pixel centres have integer coordinates
  double y = 0;
  double normal_x = 0;  ///< unit vector, pointing out of the bright region
  double normal_y = 0;
};

/// Locates the edge at one boundary pixel. Precondition: pixel lies inside the image and is brighter than `level`.
EdgePoint locate_edge(const ImageView& image, int level, PixelPosition pixel);

/// Number of intervals of a fitted pace.
inline constexpr int kPaceSteps = 64;

/// Options for converting a boundary to a cloud.
struct EdgeCloudOptions {
  BaseSide base = BaseSide::kBottom;
  bool underside = false;  ///< whether to follow the underside
  int max_points = 320;    ///< maximum number of edge points, to which cost is proportional; longer boundaries
                           ///< are subsampled evenly
  /// Positions of the landmarks in the cloud: left corner, tip, right corner; ascending. The corners are at 0 and 1
  /// where the underside is not followed.
  std::array<double, 3> landmarks{0, 0.5, 1};
  /// The curve's parameter at equally spaced positions of the cloud: ascending from 0 to 1, at least two values. A
  /// curve of few control points must slow down at sharp corners.
  std::vector<double> pace{0, 1};
};

/// Returns the pace of a curve with uniform speed.
std::vector<double> even_pace();

/// Returns the curve parameter at a position of the cloud, 0 to 1.
double at_pace(std::span<const double> pace, double place);

struct EdgeCloud {
  std::vector<EdgePoint> points;  ///< from the base's left over the tip to its right; first and last are its ends
  std::vector<double> s;          ///< curve parameter assigned to each point, 0 to 1, ascending
  std::array<double, 3> shares{0, 0.5, 1};  ///< share of the arc length at each landmark
  double height = 0;                        ///< distance from the base's middle to the tip, pixels
  double base_x = 0;                        ///< midpoint of the base's corners
  double base_y = 0;
  double area = 0;               ///< enclosed by the edge points and a straight line at the base, square pixels
  std::vector<double> way;       ///< arc length up to each point, pixels
  std::size_t left_corner = 0;   ///< index of the point at the base's left corner
  std::size_t right_corner = 0;  ///< index of the point at the base's right corner
  double left_out = 0;           ///< area between a straight base and the underside; 0 if the underside is followed
};

/// The part of a picture in which a boundary was followed.
struct BoundaryWindow {
  ImageView image;  ///< the window's pixels
  Region place;     ///< position of the window in the picture
  int level = 0;    ///< brightness threshold of the region
};

/// Converts a boundary, in the window's pixels and clockwise as from follow_boundary(), to a cloud in the picture's
/// pixels; reuses the cloud's memory. Returns false if the boundary is too short, encloses no area or has its tip at a
/// corner of its base. Precondition: every boundary pixel lies inside the window and is brighter than the level.
bool make_edge_cloud(const BoundaryWindow& window, std::span<const PixelPosition> boundary,
                     const EdgeCloudOptions& options, EdgeCloud& cloud);

/// Recomputes `s` for other landmarks or another pace; the cloud must have been made with the same `underside`.
void place_points(EdgeCloud& cloud, const EdgeCloudOptions& options);

/// Shape of a curve: its knots, and its speed along the outline. Knots are concentrated where outlines bend: they are
/// placed once per clip, from a few outlines, if they then fit better than uniform knots. Knots divide a density into
/// equal amounts: part uniform, part the outlines' mean bending (C. de Boor, A Practical Guide to Splines, chapter XII,
/// similarly distributes knots by a power of a derivative). Several powers of the bending and uniform shares are tried;
/// the best is kept.
struct CurveShape {
  std::vector<double> knots;  ///< full clamped knot vector
  std::vector<double> pace;   ///< curve parameter at equally spaced positions of a cloud (EdgeCloudOptions::pace)
  /// Area between outlines and curves, plus the area cut off at the base, divided by the outlines' area: about 1 −
  /// intersection over union. An outline whose curve intersects itself counts as missed entirely.
  double misfit = 0;
  std::vector<double> misfits;  ///< misfit of each outline; `misfit` is their mean
};

/// Returns the pace at which splines over these knots follow the outlines best, with its misfit. Precondition:
/// valid_knots(knots); clouds is not empty and was made with an even pace.
CurveShape fit_pace(std::span<const EdgeCloud> clouds, std::span<const double> knots);

/// Returns the best knots found for `points` control points: uniform ones unless others have a misfit lower by more
/// than 0.002 (0.2 % of the area). Precondition: points >= 4; clouds is not empty and was made with an even pace.
CurveShape choose_shape(std::span<const EdgeCloud> clouds, int points);

}  // namespace wisp
