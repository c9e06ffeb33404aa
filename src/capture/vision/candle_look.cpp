#include "capture/vision/candle_look.hpp"

#include <algorithm>
#include <cstdint>
#include <vector>

#include "base/statistics.hpp"

namespace wisp {
namespace {

// Lengths are in flame heights.
constexpr double kReach = 2.5;                    // half width of the strip
constexpr double kBelow = 0.2, kDeep = 0.5;       // upper and lower end of the strip below the flame; nearer, wax glows
constexpr double kMinEdge = 14;                   // minimum excess of the candle over its surroundings, levels of 255
constexpr double kNarrowest = 0.15, kWidest = 4;  // range of a candle's width; anything wider is a table

// Returns the mean brightness of each column of a strip over all pictures, 0 to 255.
std::vector<double> profile(std::span<const Picture> pictures, PixelChannel channel, const Region& strip) {
  std::vector<double> sums(static_cast<std::size_t>(strip.width), 0.0);
  std::vector<std::uint8_t> pixels(sums.size() * static_cast<std::size_t>(strip.height));
  for (const Picture& picture : pictures) {
    extract_channel(picture, channel, strip, pixels.data());
    for (std::size_t k = 0; k < pixels.size(); ++k) sums[k % sums.size()] += brightness(picture, channel, pixels[k]);
  }
  for (double& sum : sums) sum /= static_cast<double>(pictures.size()) * strip.height;
  return sums;
}

}  // namespace

std::optional<CandleLook> look_of_candle(std::span<const Picture> pictures, const Region& flame) {
  if (pictures.empty() || !has_channel(pictures.front(), PixelChannel::kRed)) return std::nullopt;
  const double height = flame.height;
  const int middle = flame.x + flame.width / 2, reach = static_cast<int>(kReach * height);
  const int top = flame.bottom() + static_cast<int>(kBelow * height),
            deep = static_cast<int>((kDeep - kBelow) * height);
  const Region strip = intersection({middle - reach, top, 2 * reach + 1, deep}, pictures.front().frame());
  if (strip.height < 2 || strip.x >= middle || strip.right() <= middle + 1) return std::nullopt;
  const std::vector<double> levels = profile(pictures, PixelChannel::kLuma, strip);
  const auto at = static_cast<std::size_t>(middle - strip.x);
  const double seen = levels[at], ground = quantile(levels, 0.1);
  if (seen - ground < kMinEdge) return std::nullopt;
  std::size_t begin = at, end = at + 1;
  while (begin > 0 && levels[begin - 1] > (seen + ground) / 2) --begin;
  while (end < levels.size() && levels[end] > (seen + ground) / 2) ++end;
  CandleLook look{.width = static_cast<double>(end - begin) / height};
  const bool open = begin == 0 || end == levels.size();
  if (open || look.width < kNarrowest || look.width > kWidest) return std::nullopt;
  const std::size_t rim = (end - begin) / 4;
  const PixelChannel colours[] = {PixelChannel::kRed, PixelChannel::kGreen, PixelChannel::kBlue};
  for (std::size_t k = 0; k < 3; ++k) {
    const std::vector<double> sums = profile(pictures, colours[k], strip);
    look.rgb[k] = mean(std::span(sums).subspan(begin + rim, end - begin - 2 * rim));
  }
  return look;
}

}  // namespace wisp
