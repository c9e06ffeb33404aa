#pragma once
// Boundary between an object and its stand, where both have merged into one region.
//
// A flame touches lit wax, its pool or the wick's holder by a few bright pixels or by its whole base. From the tip
// down, the region then widens abruptly: that is the shoulder. A slanted, hollow or pointed base has none.

#include <optional>
#include <span>
#include <vector>

#include "capture/vision/region.hpp"
#include "wisp/capture/vision/image.hpp"

namespace wisp {

/// One row of a profile, from its first to its last pixel.
struct ProfileRow {
  int low = 0;
  int high = 0;
  int width() const { return high - low + 1; }
};

/// Width of a region in each row from tip to base, including holes. "Rows" are columns where the base is on the left or
/// on the right.
struct Profile {
  int first = 0;  ///< depth of the first row: a coordinate that increases towards the base
  std::vector<ProfileRow> rows;
};

/// Computes the profile of a boundary's interior, for a base on `side`; reuses the profile's memory.
void measure_profile(std::span<const PixelPosition> boundary, BaseSide side, Profile& profile);

/// Converts a picture coordinate `edge` to depth; the function is its own inverse.
int depth_of(int edge, BaseSide side);

/// Coordinate of the last row (or column) of `box` towards the base.
int base_edge(const Region& box, BaseSide side);

/// Depth of `edge` below `other`, in pixels; negative if above.
int deeper(int edge, int other, BaseSide side);

/// Part of `place` on the object's side of `edge`.
Region above_edge(const Region& place, int edge, BaseSide side);

/// Index of the last row above the sharpest shoulder, at or after `from`; empty where no shoulder is sharp.
std::optional<std::size_t> find_shoulder(const Profile& profile, std::size_t from);

}  // namespace wisp
