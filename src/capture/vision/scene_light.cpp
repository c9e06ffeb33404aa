#include "capture/vision/scene_light.hpp"

#include <algorithm>

namespace wisp {
namespace {

constexpr int kMaxPoints = 96;              // points wide and high, at most
constexpr int kDark = 24;                   // levels: coding errors and a camera's noise lie below
constexpr double kMaxIsNew = 0.4;           // of the light above them: cuts 0.6 to 1, a snuffed candle 0.2
constexpr double kMinTotalLight = 3 * 255;  // of all points: less is a spark

}  // namespace

void SceneLight::sample(const Picture& picture) {
  const int step = std::max(1, (std::max(picture.width, picture.height) + kMaxPoints - 1) / kMaxPoints);
  const auto points = [step](int pixels) { return static_cast<std::size_t>((pixels + step - 1) / step); };
  now_.resize(points(picture.width) * points(picture.height));
  sample_channel(picture, PixelChannel::kLuma, picture.frame(), step, now_.data());
}

void SceneLight::remember(const Picture& picture) {
  sample(picture);
  if (brightest_.empty()) brightest_.assign(now_.size(), 0);
  std::transform(now_.begin(), now_.end(), brightest_.begin(), brightest_.begin(),
                 [](std::uint8_t a, std::uint8_t b) { return std::max(a, b); });
}

bool SceneLight::another(const Picture& picture) {
  if (brightest_.empty()) return false;
  sample(picture);
  double light = 0, fresh = 0;
  for (std::size_t k = 0; k < now_.size(); ++k) {
    light += std::max(0, now_[k] - kDark);
    fresh += std::max(0, now_[k] - std::max<int>(brightest_[k], kDark));
  }
  return light > kMinTotalLight && fresh > kMaxIsNew * light;
}

}  // namespace wisp
