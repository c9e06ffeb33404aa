#pragma once
// The edge points of a made picture, as the capture would see them.

#include <vector>

#include "capture/support/synthetic.hpp"
#include "capture/vision/edge_cloud.hpp"
#include "capture/vision/region.hpp"

namespace wisp::support {

/// Edge points of the largest region above `level`.
inline EdgeCloud cloud_of(const Plane& plane, int level, const EdgeCloudOptions& options = {}) {
  RegionFinder finder;
  const auto regions = finder.find(plane.view(), level, 1);
  std::vector<PixelPosition> boundary;
  EdgeCloud cloud;
  if (regions.empty()) return cloud;
  follow_boundary(plane.view(), level, {regions[0].seed_x, regions[0].seed_y}, boundary);
  const Region whole{0, 0, plane.width, plane.height};
  if (!make_edge_cloud({plane.view(), whole, level}, boundary, options, cloud)) cloud.points.clear();
  return cloud;
}

}  // namespace wisp::support
