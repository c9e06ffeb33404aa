#include "capture/vision/waist.hpp"

#include <algorithm>

namespace wisp {
namespace {

constexpr double kSlack = 0.12;   // of the thing's length: how far above its former end the waist may lie
constexpr double kNarrow = 0.65;  // a waist is at most this share of the width above it

bool along_rows(BaseSide side) { return side == BaseSide::kBottom || side == BaseSide::kTop; }

int towards_base(BaseSide side) { return side == BaseSide::kBottom || side == BaseSide::kRight ? 1 : -1; }

int width_at(const ImageView& image, int level, const Region& box, int edge, BaseSide side) {
  int width = 0;
  if (along_rows(side)) {
    const std::uint8_t* row = image.row(edge);
    for (int x = box.x; x < box.right(); ++x) width += row[x] > level;
  } else {
    for (int y = box.y; y < box.bottom(); ++y) width += image.at(edge, y) > level;
  }
  return width;
}

}  // namespace

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

std::optional<int> find_waist(const ImageView& image, int level, const Region& box, int expected, BaseSide side) {
  const int way = towards_base(side), end = base_edge(box, side);
  const int length = along_rows(side) ? box.height : box.width;
  const int begin = end - way * (length - 1);
  const int above = deeper(expected, begin, side);
  const int first = expected - way * static_cast<int>(kSlack * above);
  // What is above counts from the thing's middle down: a tip is narrow too.
  int widest = 0;
  for (int edge = begin + way * (above / 2); edge != first; edge += way) {
    widest = std::max(widest, width_at(image, level, box, edge, side));
  }
  int waist = first, narrowest = 1 << 30;
  for (int edge = first; edge != end; edge += way) {
    const int width = width_at(image, level, box, edge, side);
    if (width >= narrowest) continue;
    narrowest = width;
    waist = edge;
  }
  if (narrowest > kNarrow * widest) return std::nullopt;
  return waist;
}

}  // namespace wisp
