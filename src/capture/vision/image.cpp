#include "wisp/capture/vision/image.hpp"

#include <algorithm>
#include <cassert>

namespace wisp {

Region intersection(const Region& a, const Region& b) {
  const int x = std::max(a.x, b.x), y = std::max(a.y, b.y);
  const int right = std::min(a.right(), b.right()), bottom = std::min(a.bottom(), b.bottom());
  if (right <= x || bottom <= y) return {};
  return {x, y, right - x, bottom - y};
}

Region enclosing(const Region& a, const Region& b) {
  if (a.empty()) return b;
  if (b.empty()) return a;
  const int x = std::min(a.x, b.x), y = std::min(a.y, b.y);
  return {x, y, std::max(a.right(), b.right()) - x, std::max(a.bottom(), b.bottom()) - y};
}

Region grown(const Region& region, int margin) {
  return {region.x - margin, region.y - margin, region.width + 2 * margin, region.height + 2 * margin};
}

ImageView crop(const ImageView& image, const Region& region) {
  assert(region.x >= 0 && region.y >= 0 && region.right() <= image.width && region.bottom() <= image.height);
  return {image.row(region.y) + region.x, region.width, region.height, image.stride};
}

namespace {
constexpr std::array<std::string_view, 4> kChannelNames{"luma", "red", "green", "blue"};
}  // namespace

std::string_view channel_name(PixelChannel channel) { return kChannelNames[static_cast<std::size_t>(channel)]; }

std::optional<PixelChannel> channel_from_name(std::string_view name) {
  const auto found = std::find(kChannelNames.begin(), kChannelNames.end(), name);
  if (found == kChannelNames.end()) return std::nullopt;
  return static_cast<PixelChannel>(found - kChannelNames.begin());
}

}  // namespace wisp
