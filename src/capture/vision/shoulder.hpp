#pragma once
// Where a thing ends and what it stands on begins, when both have run together into one region.
//
// A flame touches lit wax, its pool or the wick's holder by a few bright pixels or by its whole base. Seen from the tip
// down, the region then suddenly becomes wide: that is the shoulder. A base that is slanted, hollow or pointed has
// none.

#include <optional>
#include <span>
#include <vector>

#include "capture/vision/edge_cloud.hpp"
#include "capture/vision/region.hpp"
#include "wisp/capture/vision/image.hpp"

namespace wisp {

/// One row of a profile, from its first to its last pixel.
struct ProfileRow {
  int low = 0;
  int high = 0;
  int width() const { return high - low + 1; }
};

/// How wide a region is in each row from its tip to its base; holes do not count. "Rows" are columns where the base is
/// on the left or on the right.
struct Profile {
  int first = 0;  ///< depth of the first row: the coordinate that grows towards the base
  std::vector<ProfileRow> rows;
};

/// The profile of what a boundary encloses, for a base on `side`; its memory is used again.
void measure_profile(std::span<const PixelPosition> boundary, BaseSide side, Profile& profile);

/// How deep the region reaches, in the profile's coordinate, at picture coordinate `edge`; its own inverse.
int depth_of(int edge, BaseSide side);

/// How far `box` reaches towards the base's side: the coordinate of its last row (or column) there.
int base_edge(const Region& box, BaseSide side);

/// How much deeper `edge` lies than `other`, in pixels; negative where it lies higher.
int deeper(int edge, int other, BaseSide side);

/// The part of `place` that lies on the thing's side of `edge`.
Region above_edge(const Region& place, int edge, BaseSide side);

/// The last row above the sharpest shoulder, an index of the profile's rows that is not before `from`; nothing where
/// no shoulder is sharp.
std::optional<std::size_t> find_shoulder(const Profile& profile, std::size_t from);

}  // namespace wisp
