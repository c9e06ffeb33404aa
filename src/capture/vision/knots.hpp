#pragma once
// Knots where outlines bend: placed once per model, from a few outlines, and kept only if they fit better.
//
// Knots are spread so that between any two there is the same amount of a density: part even, part the outlines' mean
// bending there (C. de Boor, A Practical Guide to Splines, chapter XII, spreads knots by a power of a derivative in the
// same way). How much bending counts, and how the outline ends at its base, is tried, and what wins is kept.

#include <span>
#include <vector>

#include "capture/vision/edge_cloud.hpp"

namespace wisp {

/// A curve's make: its knots, and how fast it is run through.
struct CurveShape {
  std::vector<double> knots;  ///< full, clamped
  std::vector<double> pace;   ///< the curve's parameter at evenly spread places of a cloud (EdgeCloudOptions::pace)
  double misfit = 0;          ///< area between outlines and curves, with what the line at the base leaves out, over the
                              ///< outlines' area: about what is missing from an intersection over union of 1;
                              ///< an outline whose curve crosses itself counts as missed altogether
  std::vector<double> misfits;  ///< of each outline; misfit is their mean
};

/// The pace at which splines over these knots follow the outlines best, and how well that is.
///
/// Precondition: valid_knots(knots); clouds is not empty and was made with an even pace.
CurveShape fit_pace(std::span<const EdgeCloud> clouds, std::span<const double> knots);

/// The best knots found for `points` control points; uniform ones where nothing beats them by a fiftieth (and a
/// fifth of a percent of the area), or where `place` is false.
///
/// Precondition: points >= 4; clouds is not empty and was made with an even pace.
CurveShape choose_shape(std::span<const EdgeCloud> clouds, int points, bool place);

}  // namespace wisp
