#include "gusts.hpp"

#include <algorithm>
#include <cmath>

namespace wisp::window {
namespace {

constexpr float kArrowWind = 0.75F;
constexpr float kArrowSeconds = 0.18F;  // time constant of a held arrow's wind
constexpr float kPuffRise = 0.10F;
constexpr float kPuffHold = 0.55F;
constexpr float kPuffFall = 0.25F;
constexpr float kWakeSeconds = 0.16F;  // time constant of the wake's decay

// Exponential approach of `from` to `to` after `seconds`, with time constant `within`.
float towards(float from, float to, float seconds, float within) {
  return to + (from - to) * std::exp(-seconds / within);
}

}  // namespace

void KeyWind::puff(float strength) {
  puff_peak_ = direction_ < 0 ? -strength : strength;
  puff_age_ = 0;
}

void KeyWind::advance(float seconds) {
  held_ = towards(held_, kArrowWind * static_cast<float>(direction_), seconds, kArrowSeconds);
  puff_age_ += seconds;
  const float rise = std::clamp(puff_age_ / kPuffRise, 0.0F, 1.0F);
  const float fall = std::clamp((kPuffRise + kPuffHold + kPuffFall - puff_age_) / kPuffFall, 0.0F, 1.0F);
  puff_ = puff_peak_ * std::min(rise, fall);
}

void KeyWind::calm() { *this = {}; }

void PointerWake::move(Point at) {
  if (last_) moved_ = {moved_.x + at.x - last_->x, moved_.y + at.y - last_->y};
  last_ = at;
  at_ = at;
}

void PointerWake::advance(float seconds) {
  if (seconds <= 0) return;
  const Point now{moved_.x / seconds, moved_.y / seconds};
  moved_ = {};
  // The wake follows the pointer at once and decays slowly.
  const auto drag = [&](float speed, float pulled) {
    const float resting = towards(speed, 0, seconds, kWakeSeconds);
    return std::abs(pulled) > std::abs(resting) ? towards(speed, pulled, seconds, 0.03F) : resting;
  };
  speed_ = {drag(speed_.x, now.x), drag(speed_.y, now.y)};
}

}  // namespace wisp::window
