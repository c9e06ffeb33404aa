#pragma once
// The cloud of edge points: Sobel gradients along a region's boundary, located to a fraction of a pixel.
//
// Source: section 3.1 of the paper (Sobel on the thresholded picture). Departure: the direction comes from Sobel on the
// picture itself, and the place is where brightness along that direction crosses the level, which a thresholded picture
// can only give to half a pixel.

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

}  // namespace wisp
