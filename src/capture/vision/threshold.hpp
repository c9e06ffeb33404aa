#pragma once
// The brightness histogram and the level that parts its two clusters.
//
// Source: section 3.1 of the paper asks for a level that separates the histogram's two clusters, flame and background;
// taken here as N. Otsu, A Threshold Selection Method from Gray-Level Histograms, IEEE Trans. SMC 9(1), 1979: the level
// with the largest variance between the clusters, and that variance as a share of the whole as the measure of how well
// they are apart, by which the channel is chosen.

#include "wisp/capture/vision/image.hpp"

namespace wisp {

/// Counts every `step`-th pixel of every `step`-th row.
///
/// Precondition: step >= 1.
void add_to_histogram(Histogram& histogram, const ImageView& image, int step);

/// A histogram cut in two.
struct TwoClusters {
  int threshold = 0;        ///< brighter than this is the bright cluster; 0 to 254
  double separation = 0;    ///< variance between the clusters over the whole variance, 0 (one cluster) to 1
  double dark_mean = 0;     ///< mean brightness of the dark cluster
  double bright_mean = 0;   ///< mean brightness of the bright one
  double bright_share = 0;  ///< share of pixels in the bright cluster
};

/// Cuts the histogram where its clusters are farthest apart. Separation is 0 where there is only one brightness.
TwoClusters split_histogram(const Histogram& histogram);

}  // namespace wisp
