#pragma once
// Knots concentrated where outlines bend: placed once per model, from a few outlines, and kept only if they fit better.
//
// Knots divide a density into equal amounts: part uniform, part the outlines' mean bending (C. de Boor, A Practical
// Guide to Splines, chapter XII, similarly distributes knots by a power of a derivative). Several weights of bending
// and ends at the base are tried; the best is kept.

#include <span>
#include <vector>

#include "capture/vision/edge_cloud.hpp"

namespace wisp {

/// Shape of a curve: its knots, and its speed along the outline.
struct CurveShape {
  std::vector<double> knots;  ///< full clamped knot vector
  std::vector<double> pace;   ///< curve parameter at equally spaced positions of a cloud (EdgeCloudOptions::pace)
  double misfit = 0;          ///< area between outlines and curves, plus the area cut off at the base, divided by the
                      ///< outlines' area: about 1 − intersection over union; an outline whose curve intersects
                      ///< itself counts as missed entirely
  std::vector<double> misfits;  ///< misfit of each outline; `misfit` is their mean
};

/// The pace at which splines over these knots follow the outlines best, with its misfit.
///
/// Precondition: valid_knots(knots); clouds is not empty and was made with an even pace.
CurveShape fit_pace(std::span<const EdgeCloud> clouds, std::span<const double> knots);

/// The best knots found for `points` control points. Uniform knots unless others have a misfit lower by 2 % (and by 0.2
/// % of the area).
///
/// Precondition: points >= 4; clouds is not empty and was made with an even pace.
CurveShape choose_shape(std::span<const EdgeCloud> clouds, int points);

}  // namespace wisp
