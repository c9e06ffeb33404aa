#include "capture/vision/region.hpp"

#include <algorithm>

namespace wisp {
namespace {

constexpr double kWiderBelow = 1.6;    // minimum ratio of a shoulder's width to the width above it
constexpr int kMinStep = 3;            // … and minimum difference in pixels
constexpr double kWithin = 0.05;       // share of the length above within which it widens
constexpr double kSlenderness = 0.7;   // minimum length / width of the part above, since a blunt tip widens too
constexpr std::size_t kMinLength = 4;  // rows

bool along_rows(BaseSide side) { return side == BaseSide::kBottom || side == BaseSide::kTop; }

int towards_base(BaseSide side) { return side == BaseSide::kBottom || side == BaseSide::kRight ? 1 : -1; }

}  // namespace

int depth_of(int edge, BaseSide side) { return towards_base(side) * edge; }

int base_edge(const Region& box, BaseSide side) {
  switch (side) {
    case BaseSide::kLeft:
      return box.x;
    case BaseSide::kTop:
      return box.y;
    case BaseSide::kRight:
      return box.right() - 1;
    case BaseSide::kBottom:
      break;
  }
  return box.bottom() - 1;
}

int deeper(int edge, int other, BaseSide side) { return (edge - other) * towards_base(side); }

Region above_edge(const Region& place, int edge, BaseSide side) {
  switch (side) {
    case BaseSide::kLeft:
      return {edge, place.y, place.right() - edge, place.height};
    case BaseSide::kTop:
      return {place.x, edge, place.width, place.bottom() - edge};
    case BaseSide::kRight:
      return {place.x, place.y, edge + 1 - place.x, place.height};
    case BaseSide::kBottom:
      break;
  }
  return {place.x, place.y, place.width, edge + 1 - place.y};
}

void measure_profile(std::span<const PixelPosition> boundary, BaseSide side, Profile& profile) {
  profile.rows.clear();
  if (boundary.empty()) return;
  const auto depth = [&](const PixelPosition& p) { return depth_of(along_rows(side) ? p.y : p.x, side); };
  const auto across = [&](const PixelPosition& p) { return along_rows(side) ? p.x : p.y; };
  int first = depth(boundary.front()), last = first;
  for (const PixelPosition& p : boundary) {
    first = std::min(first, depth(p));
    last = std::max(last, depth(p));
  }
  profile.first = first;
  profile.rows.assign(static_cast<std::size_t>(last - first) + 1, {1 << 30, -(1 << 30)});
  for (const PixelPosition& p : boundary) {
    ProfileRow& row = profile.rows[static_cast<std::size_t>(depth(p) - first)];
    row.low = std::min(row.low, across(p));
    row.high = std::max(row.high, across(p));
  }
}

std::optional<std::size_t> find_shoulder(const Profile& profile, std::size_t from) {
  const auto& rows = profile.rows;
  // Factor by which it widens shortly below row k; 0 where that is no shoulder.
  const auto step = [&](std::size_t k) {
    const std::size_t within = std::max<std::size_t>(2, static_cast<std::size_t>(kWithin * static_cast<double>(k)));
    int below = 0;
    for (std::size_t j = k + 1; j < std::min(rows.size(), k + 1 + within); ++j) {
      below = std::max(below, rows[j].width());
    }
    const int width = rows[k].width();
    return below < std::max<double>(kWiderBelow * width, width + kMinStep) ? 0 : static_cast<double>(below) / width;
  };
  std::optional<std::size_t> best;
  double sharpest = 0;
  int widest = 0;
  for (std::size_t k = 0; k + 1 < rows.size(); ++k) {
    widest = std::max(widest, rows[k].width());
    if (k < from || k + 1 < kMinLength || static_cast<double>(k + 1) < kSlenderness * widest) continue;
    if (step(k) <= sharpest) continue;
    sharpest = step(k);
    best = k;
  }
  // The shoulder begins at the first row that widens.
  while (best && *best > from && step(*best - 1) > 0) --*best;
  return best;
}

}  // namespace wisp
