#pragma once
// Where a thing ends and what it stands on begins, when both have run together into one region.
//
// A flame now and then touches its wick's holder or the lit rim of the wax by a thin bridge of bright pixels. The
// region then reaches suddenly deeper than before, and between the two there is a waist.

#include <optional>

#include "wisp/capture/vision/edge_cloud.hpp"
#include "wisp/capture/vision/image.hpp"

namespace wisp {

/// How far `box` reaches towards the base's side: the coordinate of its last row (or column) there.
int base_edge(const Region& box, BaseSide side);

/// How much deeper `edge` lies than `other`, in pixels; negative where it lies higher.
int deeper(int edge, int other, BaseSide side);

/// The part of `place` that lies on the thing's side of `edge`.
Region above_edge(const Region& place, int edge, BaseSide side);

/// The narrowest place of what is brighter than `level` inside `box`, between a little above `expected` (where the
/// thing ended before) and the box's own end; nothing where there is no clear waist.
///
/// Precondition: box lies inside the image, and `expected` inside the box.
std::optional<int> find_waist(const ImageView& image, int level, const Region& box, int expected, BaseSide side);

}  // namespace wisp
