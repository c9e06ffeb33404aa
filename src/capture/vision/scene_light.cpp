#include "capture/vision/scene_light.hpp"

#include <algorithm>

namespace wisp {
namespace {

constexpr int kGrid = 96;              // points wide and high, at most
constexpr int kDark = 24;              // levels: coding errors and a camera's noise lie below
constexpr double kMaxIsNew = 0.4;      // of the light above them: cuts 0.6 to 1, a snuffed candle 0.2
constexpr double kMinLight = 3 * 255;  // of all points: less is a spark

}  // namespace

void SceneLight::sample(const Picture& picture) {
  step_ = std::max(1, (std::max(picture.width, picture.height) + kGrid - 1) / kGrid);
  const auto points = [this](int pixels) { return (pixels + step_ - 1) / step_; };
  columns_ = points(picture.width);
  now_.resize(static_cast<std::size_t>(columns_) * points(picture.height));
  sample_channel(picture, PixelChannel::kLuma, picture.frame(), step_, now_.data());
}

void SceneLight::remember(const Picture& picture) {
  sample(picture);
  if (brightest_.empty()) brightest_.assign(now_.size(), 0);
  std::transform(now_.begin(), now_.end(), brightest_.begin(), brightest_.begin(),
                 [](std::uint8_t a, std::uint8_t b) { return std::max(a, b); });
}

SceneLight::Share SceneLight::share_in(const Region& box) const {
  Share share;
  for (int y = box.y / step_; y * step_ < box.bottom(); ++y) {
    for (int x = box.x / step_; x * step_ < box.right(); ++x) {
      const std::size_t at = static_cast<std::size_t>(y) * columns_ + x;
      share.light += std::max(0, now_[at] - kDark);
      share.fresh += std::max(0, now_[at] - std::max<int>(brightest_[at], kDark));
    }
  }
  return share;
}

bool SceneLight::another(const Picture& picture) {
  if (brightest_.empty()) return false;
  sample(picture);
  const Share share = share_in(picture.frame());
  return share.light > kMinLight && share.fresh > kMaxIsNew * share.light;
}

bool SceneLight::knows(const Picture& picture, const Region& box) {
  if (brightest_.empty()) return false;
  sample(picture);
  const Share share = share_in(box);
  return share.fresh <= kMaxIsNew * share.light;
}

}  // namespace wisp
