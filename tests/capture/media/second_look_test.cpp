// What would have made a refused film usable is said, and nothing where nothing would.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <string_view>

#include "capture/support/clip_files.hpp"
#include "capture/support/made_clip.hpp"
#include "wisp/capture/capture.hpp"

namespace wisp::second_look_test {
namespace {

using support::Plane;
using support::ScratchFolder;
using testing::HasSubstr;
using testing::Not;

std::string reason_of(int frames, const std::function<Plane(int)>& picture) {
  const ScratchFolder folder("second_look");
  for (int k = 0; k < frames; ++k) support::write_pgm(folder / (std::to_string(1000 + k) + ".pgm"), picture(k));
  FlameCapture options;
  options.rate_hz = 30;
  const auto captured = capture(folder.path(), options);
  if (!captured) return captured.error().message;
  return (captured->report.verdict->usable ? "usable: " : "") + captured->report.verdict->reason;
}

Plane upside_down(int k) {
  Plane plane = support::noisy_flame(k);
  std::reverse(plane.pixels.begin(), plane.pixels.end());
  return plane;
}

Plane turned(int k) {
  Plane upright = support::noisy_flame(k);
  Plane plane(upright.height, upright.width);
  for (int y = 0; y < upright.height; ++y) {
    for (int x = 0; x < upright.width; ++x) plane.at(upright.height - 1 - y, x) = upright.at(x, y);
  }
  return plane;
}

TEST(SecondLook, ATurnedFilmSaysHowToTurnIt) {
  EXPECT_THAT(reason_of(60, support::noisy_flame), HasSubstr("usable: "));
  EXPECT_THAT(reason_of(60, upside_down), HasSubstr("is upside down; rotate it by 180"));
  EXPECT_THAT(reason_of(60, turned), HasSubstr("lies on its side; rotate it by 90 degrees counter-clockwise"));
}

TEST(SecondLook, CanBeStopped) {
  const ScratchFolder folder("second_look");
  for (int k = 0; k < 60; ++k) support::write_pgm(folder / (std::to_string(1000 + k) + ".pgm"), upside_down(k));
  FlameCapture options;
  options.rate_hz = 30;
  int frames = 0;
  const auto captured = capture(folder.path(), options, [&](std::string_view, double) { return ++frames <= 60; });
  ASSERT_FALSE(captured);
  EXPECT_EQ(captured.error().message, kStopped);
}

TEST(SecondLook, AFilmInWhichNothingCanBeToldSaysWhy) {
  const auto dark = [](int k) {
    Plane plane = support::noisy_flame(k);
    for (std::uint8_t& pixel : plane.pixels) pixel = static_cast<std::uint8_t>(pixel / 12);
    return plane;
  };
  EXPECT_THAT(reason_of(60, dark), HasSubstr("too dark"));
  EXPECT_THAT(reason_of(12, support::noisy_flame), HasSubstr("12 frames only; give a longer clip"));
}

TEST(SecondLook, OfAFilmThatIsCutOneSceneIsNamed) {
  const auto cut = [](int k) {
    Plane plane = support::noisy_flame(k);
    if (k >= 60) plane = Plane(160, 180, 10), plane.fill({0, 40, 60, 140}, static_cast<std::uint8_t>(170 + k % 3));
    return plane;
  };
  EXPECT_THAT(reason_of(100, cut), HasSubstr("--frames 1:60"));
}

TEST(SecondLook, APartThatIsUsableIsNamed) {
  const auto hidden = [](int k) { return k >= 80 && k < 100 ? Plane(160, 180, 8) : support::noisy_flame(k); };
  EXPECT_THAT(reason_of(120, hidden), HasSubstr("a part of it is usable: --frames 1:80"));
}

TEST(SecondLook, AStillLampGetsNoAdvice) {
  const auto lamp = [](int k) {
    Plane plane = support::flame_picture(support::swaying(0));
    support::add_noise(plane, static_cast<unsigned>(k) + 1);
    return plane;
  };
  const std::string reason = reason_of(60, lamp);
  EXPECT_THAT(reason, HasSubstr("there is no flame"));
  EXPECT_THAT(reason, Not(HasSubstr("--f")));
}

}  // namespace
}  // namespace wisp::second_look_test
